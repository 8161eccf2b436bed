// Tests of programs that cannot write to stderr, or whose stderr no process reads. Tests of signals
// that end a program.
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/clock.h"
#include "services/graph.h"
#include "tests/support/children.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

/// A shell that executes `before`, such as "exec 2>/dev/full", and then the command.
Words Shell(const std::string& before, Words command) {
  command.insert(command.begin(), {"sh", "-c", before + "; exec \"$@\"", "sh"});
  return command;
}

Words ShortRun(const std::string& log) {
  return {Program("fogline"), "run", "scenario/paper.json", "--set", "/steps=20", "--log", log};
}

/// A named pipe that is full and that no process reads.
class FullPipe {
 public:
  explicit FullPipe(const std::string& name) : name_(name) {
    mkfifo(name.c_str(), 0600);
    fd_ = open(name.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    const std::array<char, 4096> zeros{};
    while (write(fd_, zeros.data(), zeros.size()) > 0) ++pages_;
  }
  ~FullPipe() { close(fd_); }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;
  bool WasFilled() const { return pages_ > 0; }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  int fd_;
  int pages_ = 0;
};

/// Waits for the process of a role that a run has started. @return 0 if no such process starts
pid_t WaitForRole(pid_t run, const std::string& program) {
  const TimePoint end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    for (const pid_t child : ChildrenOf(run)) {
      if (Content("/proc/" + std::to_string(child) + "/comm").starts_with(program)) return child;
    }
    std::this_thread::sleep_for(kLookEvery);  // no event shows that a process was started
  }
  return 0;
}

TEST(ConsoleTest, NoProgramAbortsWhereStderrIsAFullDisk) {
  const ScratchFolder folder;
  const std::string none = folder.File("none.lcm");
  const std::string fogline = Program("fogline");
  std::vector<Words> refused{{fogline, "levitate"},
                             {fogline, "run", "none.json"},
                             {fogline, "check", "none.json"},
                             {fogline, "table", "none.json"},
                             {fogline, "sweep", "none.json"},
                             {fogline, "digest", none},
                             {fogline, "metrics", none},
                             {fogline, "events", none},
                             {fogline, "report", none},
                             {fogline, "diff", none, none},
                             {fogline, "replay", none, "--all"},
                             {fogline, "export", none, "--out", folder.File("out")},
                             {fogline, "compare", none, none},
                             {fogline, "keygen", "/proc/none.key"},
                             {fogline, "calibrate", "none.json", "--free", "/fog/bias_m=0:1"},
                             {fogline, "study", "none"},
                             {Program("fogline-relay"), "--bogus"}};
  for (const RoleInfo& role : kRoles) {
    refused.push_back({Program("fogline-" + std::string(role.name)), "--bogus"});
  }
  for (const Words& command : refused) {
    EXPECT_EQ(RunCommand(Shell("exec 2>/dev/full", command)).code, 2)
        << command.front() << " " << command[1];
  }
  const std::string cut = folder.File("cut.lcm");
  Words run = ShortRun(cut);
  run.insert(run.end(), {"--transport", "direct"});
  ASSERT_EQ(RunCommand(run).code, 0);
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
  EXPECT_EQ(RunCommand(Shell("exec 2>/dev/full", {fogline, "digest", cut})).code, 1);
}

TEST(ConsoleTest, NoProgramAbortsWhereStderrIsClosedOrItsReaderIsGone) {
  const ScratchFolder folder;
  const std::string pipe = folder.File("pipe");
  mkfifo(pipe.c_str(), 0600);
  for (const std::string& before :
       {std::string("exec 2>&-"), "exec 3<>'" + pipe + "' 2>'" + pipe + "' 3<&-"}) {
    EXPECT_EQ(RunCommand(Shell(before, {Program("fogline"), "levitate"})).code, 2) << before;
    EXPECT_EQ(RunCommand(Shell(before, ShortRun(folder.File("run.lcm")))).code, 0) << before;
    std::filesystem::remove(folder.File("run.lcm"));
  }
}

TEST(ConsoleTest, ARunGoesOnWhereStderrIsAPipeThatIsFullAndNeverRead) {
  const ScratchFolder folder;
  const FullPipe pipe(folder.File("pipe"));
  ASSERT_TRUE(pipe.WasFilled());
  for (const std::string transport : {"udpm", "tcpq", "memq", "direct"}) {
    Words run = ShortRun(folder.File(transport + ".lcm"));
    run.insert(run.end(), {"--transport", transport});
    EXPECT_EQ(RunCommand(Shell("exec 2>'" + pipe.name() + "'", run), kPatience).code, 0)
        << transport;
  }
}

TEST(ConsoleTest, AnErrorIsNotWaitedForWithoutEnd) {
  const ScratchFolder folder;
  const FullPipe pipe(folder.File("pipe"));
  ASSERT_TRUE(pipe.WasFilled());
  EXPECT_EQ(
      RunCommand(Shell("exec 2>'" + pipe.name() + "'", {Program("fogline"), "levitate"}), kPatience)
          .code,
      2);
}

TEST(ConsoleTest, DoesNotChangeHowOtherProcessesWriteToTheSamePipe) {
  // The shell writes to the same pipe as the run. After the run, the pipe must not have the flag
  // O_NONBLOCK. With this flag, a write of the shell would not wait for room in a full pipe, but
  // fail.
  const ScratchFolder folder;
  const Outcome outcome =
      RunCommand({"bash", "-c",
                  "{ " + Program("fogline") + " run scenario/paper.json --set /steps=20 --log '" +
                      folder.File("run.lcm") +
                      "' >/dev/null; grep flags: /proc/self/fdinfo/2 >&2; } 2>&1 | cat"});
  const std::size_t flags = outcome.out.find("flags:");
  ASSERT_NE(flags, std::string::npos) << outcome.out;
  EXPECT_EQ(std::stoul(outcome.out.substr(flags + 6), nullptr, 8) & O_NONBLOCK, 0U) << outcome.out;
}

TEST(ConsoleTest, ARoleIsRepairedWhereStderrIsAFullDisk) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  // GIVEN a run with a stderr that accepts nothing
  Background run(Shell("exec 2>/dev/full",
                       {Program("fogline"), "run", "scenario/paper.json", "--set", "/steps=60",
                        "--pace", "1", "--stall-timeout", "30", "--log", log}));
  ASSERT_TRUE(GrowsTo(1, log));
  // WHEN a role is killed THEN the run starts it again, although the run cannot report the restart
  const pid_t radar = WaitForRole(run.pid(), "fogline-radar");
  ASSERT_GT(radar, 0);
  kill(radar, SIGKILL);
  EXPECT_EQ(run.Wait(), 0);
  EXPECT_THAT(run.Out(), HasSubstr("radar was started again once"));
}

TEST(ConsoleTest, ARunGoesOnWhenItsTerminalIsGone) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(grantpt(terminal) + unlockpt(terminal), 0);
  // GIVEN a run that reports its progress on a terminal
  Background run(Shell("exec 2>" + std::string(ptsname(terminal)),
                       {Program("fogline"), "run", "scenario/paper.json", "--set", "/steps=60",
                        "--pace", "1", "--stall-timeout", "30", "--log", log}));
  ASSERT_TRUE(GrowsTo(1, log));
  const pid_t radar = WaitForRole(run.pid(), "fogline-radar");
  ASSERT_GT(radar, 0);
  // WHEN the terminal's window is closed and a role is killed, so the run has to report a restart
  close(terminal);
  kill(radar, SIGKILL);
  // THEN the run continues
  EXPECT_EQ(run.Wait(), 0);
}

TEST(ConsoleTest, WritesNothingIntoAFileThatHasTheNumberOfAClosedStderr) {
  const ScratchFolder folder;
  const std::string file = folder.File("sweep.csv");
  const Words sweep{Program("fogline"),
                    "sweep",
                    "scenario/paper.json",
                    "--set",
                    "/steps=20",
                    "--seeds",
                    "1:4",
                    "--out",
                    file};
  ASSERT_EQ(RunCommand(sweep).code, 0);
  const std::string whole = Content(file);
  std::filesystem::resize_file(file, whole.rfind('\n', whole.size() - 2) + 1);
  // stderr is closed, so the file of the sweep can get descriptor 2, the number of stderr. The
  // sweep reports on stderr how many rows the file already has. This text must not get into the
  // file.
  EXPECT_EQ(RunCommand(Shell("exec 2>&-", sweep)).code, 0);
  EXPECT_EQ(Content(file), whole);
}

TEST(InterruptTest, SignalsThatWereIgnoredAtTheStartStayIgnoredInEveryProgram) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  // GIVEN a run that ignores SIGHUP and SIGINT, as under nohup or in the background of a script
  Background run(Shell("trap '' HUP INT", {Program("fogline"), "run", "scenario/paper.json",
                                           "--set", "/steps=40", "--pace", "1", "--log", log}));
  ASSERT_TRUE(GrowsTo(1, log));
  const pid_t radar = WaitForRole(run.pid(), "fogline-radar");
  ASSERT_GT(radar, 0);
  // WHEN the terminal is closed, or a person presses Ctrl-C in the terminal
  for (const int signal : {SIGHUP, SIGINT}) {
    run.Signal(signal);
    kill(radar, signal);
  }
  // THEN the run continues to its end with the same processes
  EXPECT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_THAT(run.Out(), HasSubstr("40 steps"));
  EXPECT_EQ(run.Out().find("started again"), std::string::npos) << run.Out();
}

TEST(InterruptTest, TheRelayEndsInOrderWhenItsTerminalIsGoneUnlessThatIsIgnored) {
  const Words relay{Program("fogline-relay"), "--listen", "127.0.0.1:0"};
  Background obeys(relay);
  ASSERT_TRUE(obeys.WaitForOut("\n")) << obeys.Err();
  obeys.Signal(SIGHUP);
  EXPECT_EQ(obeys.Wait(), 0);
  Background stays(Shell("trap '' HUP INT TERM", relay));
  ASSERT_TRUE(stays.WaitForOut("\n")) << stays.Err();
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) stays.Signal(signal);
  // The relay still answers.
  const std::string url = stays.Out().substr(0, stays.Out().find('\n'));
  EXPECT_THAT(RunCommand({Program("fogline"), "doctor", "--lcm-url", url}).out,
              HasSubstr("the relay " + url + " answers\n"));
}

}  // namespace
}  // namespace fogline::test
