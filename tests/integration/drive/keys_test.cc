// `fogline drive --keys` in a real terminal (a pseudo-terminal whose other end is this test).
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <string>
#include <vector>

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include "common/clock.h"
#include "common/process/poll.h"
#include "services/log/driver_inputs.h"
#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "tests/integration/drive/driven_run.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

/// A program in the foreground of a terminal of its own.
class InTerminal {
 public:
  explicit InTerminal(const Words& command) {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const std::string folder = SourceDirectory().string();
    pid_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ == 0) {
      if (chdir(folder.c_str()) == 0) execv(argv[0], argv.data());
      _exit(127);
    }
    tcgetattr(terminal_, &before_);
  }
  ~InTerminal() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(terminal_);
  }
  InTerminal(const InTerminal&) = delete;
  InTerminal& operator=(const InTerminal&) = delete;

  void Type(const std::string& characters) {
    ASSERT_EQ(write(terminal_, characters.data(), characters.size()),
              static_cast<ssize_t>(characters.size()));
  }
  /// Whether the terminal gives single keys and does not show them.
  bool IsRaw() const {
    termios now{};
    tcgetattr(terminal_, &now);
    return (now.c_lflag & (ICANON | ECHO)) == 0;
  }
  bool IsAsBefore() const {
    termios now{};
    tcgetattr(terminal_, &now);
    return now.c_lflag == before_.c_lflag && now.c_iflag == before_.c_iflag &&
           now.c_oflag == before_.c_oflag &&
           std::equal(std::begin(now.c_cc), std::end(now.c_cc), std::begin(before_.c_cc));
  }
  /// Reads what the program prints until a condition holds. @return false after the time limit
  template <class Condition>
  bool WaitUntil(const Condition& holds) {
    const TimePoint end = Clock::now() + kPatience;
    while (!holds()) {
      if (Clock::now() > end) return false;
      Read(milliseconds(20));
    }
    return true;
  }
  /// @return the exit code; -1 after the time limit
  int Wait() {
    const TimePoint end = Clock::now() + kPatience;
    int status = 0;
    while (waitpid(pid_, &status, WNOHANG) == 0) {
      if (Clock::now() > end) return -1;
      Read(milliseconds(20));
    }
    pid_ = -1;
    Read(milliseconds(20));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  pid_t pid() const { return pid_; }
  const std::string& text() const { return text_; }

 private:
  void Read(Duration limit) {
    std::array<char, 4096> buffer{};
    if (PollFor(terminal_, POLLIN, limit) <= 0) return;
    const ssize_t size = read(terminal_, buffer.data(), buffer.size());
    if (size > 0) text_.append(buffer.data(), static_cast<std::size_t>(size));
  }

  int terminal_ = -1;
  pid_t pid_ = -1;
  termios before_{};
  std::string text_;
};

class KeysInRealtimeTest : public testing::Test {
 protected:
  Words Drive(int steps) const {
    Words command{Program("fogline"),
                  "drive",
                  kDriveScenario,
                  "--keys",
                  "--log",
                  log_,
                  "--lcm-url",
                  url_,
                  "--set",
                  "/steps=" + std::to_string(steps)};
    for (const std::string& setting : AlwaysAsked()) {
      command.insert(command.end(), {"--set", setting});
    }
    return command;
  }
  std::vector<driver_input_t> Inputs() const {
    log::RunLogReader reader(log_);
    while (reader.Next() != nullptr) {
    }
    return log::ReadDriverInputs(log_, reader.run().run_id);
  }
  std::string Answered() const { return RunCommand({Program("fogline"), "events", log_}).out; }

  ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string url_ = runtime::FreshMulticastUrl();
};

TEST_F(KeysInRealtimeTest, DriveTheHostAndTheTerminalIsRestoredAtTheEnd) {
  InTerminal program(Drive(250));
  Commands commands(url_);
  ASSERT_TRUE(program.WaitUntil([&] { return program.IsRaw(); })) << program.text();
  ASSERT_GE(commands.WaitFor([&] { return commands.driver.input_instance != 0; }), 0);
  // WHEN the person takes over with the space bar
  program.Type(" ");
  ASSERT_GE(commands.WaitFor([&] { return commands.host.mode == arbitration_t::RECOVERING; }), 0);
  // THEN the arrow up accelerates the host more than released pedals, and the arrow down brakes it
  program.Type("\x1b[A");
  EXPECT_GE(commands.WaitFor([&] { return commands.host.acceleration_mps2 > -0.3; }), 0);
  program.Type("\x1b[B");
  EXPECT_GE(commands.WaitFor([&] { return commands.host.acceleration_mps2 < -0.8; }), 0);
  EXPECT_EQ(program.Wait(), 0) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
  const auto inputs = Inputs();
  ASSERT_FALSE(inputs.empty());
  EXPECT_EQ(inputs.front().device, "terminal");
  EXPECT_EQ(inputs.front().device_kind, driver_input_t::KEYBOARD);
  EXPECT_THAT(Answered(), HasSubstr("acknowledgement by the person"));
  EXPECT_EQ(RunCommand({Program("fogline"), "replay", log_, "--role", "driver"}).code, 0);
}

TEST_F(KeysInRealtimeTest, TheTerminalIsRestoredAfterCtrlC) {
  InTerminal program(Drive(4000));
  Commands commands(url_);
  ASSERT_TRUE(program.WaitUntil([&] { return program.IsRaw(); })) << program.text();
  ASSERT_GE(commands.WaitFor([&] { return commands.host.header.step > 10; }), 0);
  program.Type("\x03");
  EXPECT_EQ(program.Wait(), 130) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
}

TEST_F(KeysInRealtimeTest, TheTerminalIsRestoredAfterSigterm) {
  InTerminal program(Drive(4000));
  ASSERT_TRUE(program.WaitUntil([&] { return program.IsRaw(); })) << program.text();
  kill(program.pid(), SIGTERM);
  EXPECT_EQ(program.Wait(), 130) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
}

// The log is refused after the terminal was opened.
TEST_F(KeysInRealtimeTest, TheTerminalIsRestoredAfterAnError) {
  Words command = Drive(100);
  *(std::ranges::find(command, "--log") + 1) = "/nowhere/run.lcm";
  InTerminal program(command);
  EXPECT_EQ(program.Wait(), 2) << program.text();
  EXPECT_TRUE(program.IsAsBefore());
}

TEST_F(KeysInRealtimeTest, AreRefusedWithoutATerminal) {
  const Outcome outcome = RunCommand(Drive(100));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("error: --keys: standard input is no terminal"));
}

TEST_F(KeysInRealtimeTest, AnInputDeviceMustBeOne) {
  Words command = Drive(100);
  std::erase(command, "--keys");
  command.push_back("--evdev");
  command.push_back("/dev/null");
  const Outcome no_device = RunCommand(command);
  EXPECT_EQ(no_device.code, 2);
  EXPECT_THAT(no_device.err, HasSubstr("error: --evdev /dev/null: no input device"));
}

}  // namespace
}  // namespace fogline::test
