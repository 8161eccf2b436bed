#include "tools/processes/child.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::ElementsAre;

/// All bytes that come out of a pipe until its other end is closed.
std::string ReadAll(int file) {
  std::string text;
  std::array<char, 256> buffer{};
  while (true) {
    const ssize_t size = read(file, buffer.data(), buffer.size());
    if (size <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(size));
  }
}

struct Ended {
  std::string out;
  std::string how;
};

/// Runs lines of sh as a child to their end. @param arguments are $1, $2 ... in the script
Ended RunScript(const std::string& script, const std::vector<std::string>& arguments = {}) {
  std::vector<std::string> words{"-c", script, "sh"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  processes::Pipe pipe;
  const pid_t pid = processes::StartChild("/bin/sh", words, pipe.write);
  close(std::exchange(pipe.write, -1));
  Ended ended{.out = ReadAll(pipe.read), .how = ""};
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  ended.how = processes::HowItEnded(status);
  return ended;
}

TEST(ChildTest, GetsItsArgumentsAsTheyAre) {
  EXPECT_EQ(RunScript(R"(printf '<%s>' "$@")", {"two words", "", "it's"}).out,
            "<two words><><it's>");
}

TEST(ChildTest, EndsWithACodeOrASignal) {
  EXPECT_EQ(RunScript("exit 3").how, "exited with code 3");
  EXPECT_EQ(RunScript("kill -TERM $$").how, "was killed by signal 15 (Terminated)");
}

TEST(ChildTest, ReportsItsEndAlsoToAParentThatIgnoredTheEndsOfChildren) {
  std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(RunScript("exit 4").how, "exited with code 4");
}

TEST(ChildTest, HasAnEmptyInputAndNoFileOfItsParent) {
  const int file = open("/dev/zero", O_RDONLY);  // without close-on-exec, like LCM's sockets
  ASSERT_GE(file, 3);
  const Ended ended =
      RunScript("readlink /proc/$$/fd/0; [ -e /proc/$$/fd/$1 ] && echo open || echo closed",
                {std::to_string(file)});
  close(file);
  EXPECT_EQ(ended.out, "/dev/null\nclosed\n");
}

TEST(ChildTest, ReadsItsInputWhereItIsTold) {
  processes::Pipe in;
  processes::Pipe out;
  const pid_t pid = processes::StartChild("/bin/cat", {}, out.write, STDERR_FILENO, in.read);
  close(std::exchange(out.write, -1));
  ASSERT_EQ(write(in.write, "in\n", 3), 3);
  close(std::exchange(in.write, -1));
  EXPECT_EQ(ReadAll(out.read), "in\n");
  EXPECT_EQ(waitpid(pid, nullptr, 0), pid);
}

TEST(ChildTest, WritesItsErrorsWhereItIsTold) {
  processes::Pipe out;
  processes::Pipe err;
  const pid_t pid =
      processes::StartChild("/bin/sh", {"-c", "echo out; echo err >&2"}, out.write, err.write);
  close(std::exchange(out.write, -1));
  close(std::exchange(err.write, -1));
  EXPECT_EQ(ReadAll(out.read), "out\n");
  EXPECT_EQ(ReadAll(err.read), "err\n");
  EXPECT_EQ(waitpid(pid, nullptr, 0), pid);
}

TEST(ChildTest, IsOutOfReachOfTheTerminalsSignals) {
  const processes::Pipe pipe;
  const pid_t pid = processes::StartChild("/bin/sleep", {"60"}, pipe.write);
  EXPECT_EQ(getpgid(pid), pid) << "Ctrl-C reaches the whole group of a terminal";
  kill(pid, SIGKILL);
  EXPECT_EQ(waitpid(pid, nullptr, 0), pid);
}

TEST(ChildTest, EndsWhenItIsAskedTo) {
  const processes::Pipe pipe;
  const pid_t pid = processes::StartChild("/bin/sleep", {"60"}, pipe.write);
  const TimePoint begin = Clock::now();
  processes::EndChild(pid, std::chrono::seconds(50));
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(40)) << "by SIGTERM, not by SIGKILL";
  EXPECT_EQ(waitpid(pid, nullptr, WNOHANG), -1) << "it has ended, and its status is read";
}

TEST(ChildTest, ThatIgnoresTheRequestToEndIsKilled) {
  processes::Pipe pipe;
  const pid_t pid = processes::StartChild(
      "/bin/sh", {"-c", "trap '' TERM; echo ready; while :; do sleep 1; done"}, pipe.write);
  ASSERT_EQ(processes::FirstLineOf(pipe.read, kPatience), "ready");
  const TimePoint begin = Clock::now();
  processes::EndChild(pid, milliseconds(100));
  EXPECT_GE(Clock::now() - begin, milliseconds(100));
  EXPECT_EQ(waitpid(pid, nullptr, WNOHANG), -1) << "it has ended, and its status is read";
}

/// A pipe that contains a text. The write end stays open, as if a child still had it.
struct FullPipe : processes::Pipe {
  explicit FullPipe(const std::string& text) { Add(text); }
  void Add(const std::string& text) const {
    EXPECT_EQ(::write(write, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
};

TEST(LinesOfTest, AreThereAlsoIfTheLimitIsShorterThanAMillisecond) {
  for (const Duration limit : {Duration(milliseconds(1)), Duration(1), Duration::zero()}) {
    const FullPipe pipe("one\ntwo\nthree\n");
    EXPECT_THAT(processes::LinesOf(pipe.read, 2, limit), ElementsAre("one", "two"));
  }
}

TEST(LinesOfTest, AreFewerIfTheChildIsTooSlowOrEnds) {
  FullPipe pipe("one\ntw");
  const TimePoint begin = Clock::now();
  EXPECT_THAT(processes::LinesOf(pipe.read, 2, milliseconds(50)), ElementsAre("one"));
  EXPECT_GE(Clock::now() - begin, milliseconds(50));
  pipe.Add("one\n");
  close(std::exchange(pipe.write, -1));
  EXPECT_THAT(processes::LinesOf(pipe.read, 2, kPatience), ElementsAre("one"));
}

TEST(LineReaderTest, ACallInVainLosesNothing) {
  FullPipe pipe("one\ntw");
  processes::LineReader reader(pipe.read);
  EXPECT_FALSE(reader.Has(2, milliseconds(1)));
  EXPECT_FALSE(reader.ended());
  pipe.Add("o\n");
  EXPECT_TRUE(reader.Has(2, milliseconds(1)));
  EXPECT_THAT(reader.lines(), ElementsAre("one", "two"));
  close(std::exchange(pipe.write, -1));
  EXPECT_FALSE(reader.Has(3, kPatience));
  EXPECT_TRUE(reader.ended());
}

TEST(ChildTest, DiesWithItsParent) {
  // GIVEN a process that starts a child, writes the child's process id, and ends
  processes::Pipe pipe;
  const pid_t parent = fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    const pid_t child = processes::StartChild("/bin/sleep", {"60"}, STDERR_FILENO);
    const ssize_t written = write(pipe.write, &child, sizeof(child));
    _exit(written == sizeof(child) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(parent, &status, 0), parent);
  ASSERT_EQ(status, 0);
  pid_t child = 0;
  ASSERT_EQ(read(pipe.read, &child, sizeof(child)), static_cast<ssize_t>(sizeof(child)));
  // THEN the child also ends
  const TimePoint end = Clock::now() + kPatience;
  while (IsAlive(child) && Clock::now() < end) std::this_thread::sleep_for(kLookEvery);
  EXPECT_FALSE(IsAlive(child));
  kill(child, SIGKILL);
}

TEST(ChildTest, ThatCannotBeStartedIsAnErrorWithItsReason) {
  const processes::Pipe pipe;
  const auto error = [&](const char* program) -> std::string {
    try {
      processes::StartChild(program, {}, pipe.write);
    } catch (const std::runtime_error& failure) {
      return failure.what();
    }
    return "none";
  };
  EXPECT_EQ(error("/no/such/program"), "cannot start /no/such/program: No such file or directory");
  EXPECT_EQ(error("/dev/null"), "cannot start /dev/null: Permission denied");
}

TEST(PipeTest, ClosesItsEndsAndLeavesNoneToAChild) {
  int read_end = -1;
  int write_end = -1;
  {
    const processes::Pipe pipe;
    read_end = pipe.read;
    write_end = pipe.write;
    for (const int end : {read_end, write_end}) EXPECT_EQ(fcntl(end, F_GETFD), FD_CLOEXEC);
  }
  for (const int end : {read_end, write_end}) EXPECT_EQ(fcntl(end, F_GETFD), -1);
}

TEST(ProgramBesideTest, IsInTheFolderOfThisProgram) {
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe").parent_path();
  EXPECT_EQ(processes::ProgramOf(Role::kArbitrator), folder / "fogline-arbitrator");
  EXPECT_EQ(processes::ProgramBeside("other"), folder / "other");
  EXPECT_EQ(processes::BuiltProgramBeside("fogline"), folder / "fogline");
  try {
    processes::BuiltProgramBeside("other");
    FAIL() << "there is no such program";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "cannot start " + (folder / "other").string() +
                                ": No such file or directory" + processes::HowToBuild("other"));
  }
}

class HowToBuildTest : public testing::Test {
 protected:
  HowToBuildTest() : before_(std::filesystem::current_path()) {}
  ~HowToBuildTest() override { std::filesystem::current_path(before_); }

  /// The text for a program if `folder` is the working folder.
  static std::string From(const std::filesystem::path& folder) {
    std::filesystem::current_path(folder);
    return processes::HowToBuild("other");
  }

  const std::filesystem::path build_ =
      std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path();

 private:
  const std::filesystem::path before_;
};

TEST_F(HowToBuildTest, NamesTheBuildFolderAsSeenFromTheWorkingFolder) {
  EXPECT_EQ(From(build_.parent_path()),
            "; it is built by: ninja -C " + build_.filename().string() + " other");
  EXPECT_EQ(From(build_), "; it is built by: ninja -C . other");
  EXPECT_EQ(From("/proc"), "; it is built by: ninja -C " + build_.string() + " other");
}

TEST_F(HowToBuildTest, NeedsNoWorkingFolder) {
  const test::ScratchFolder folder;
  const std::filesystem::path deleted = folder.path() / "deleted";
  std::filesystem::create_directory(deleted);
  std::filesystem::current_path(deleted);
  std::filesystem::remove(deleted);
  EXPECT_EQ(processes::HowToBuild("other"),
            "; it is built by: ninja -C " + build_.string() + " other");
}

}  // namespace
}  // namespace fogline::test
