#include "tools/processes/process_group.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/clock.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using processes::ProcessGroup;
using testing::ElementsAre;
using testing::IsEmpty;

/// Waits until `count` processes of a group have ended. @return these processes
std::vector<ProcessGroup::Exit> CollectUntil(ProcessGroup& group, std::size_t count) {
  std::vector<ProcessGroup::Exit> exits;
  const TimePoint end = Clock::now() + kPatience;
  while (exits.size() < count && Clock::now() < end) {
    for (ProcessGroup::Exit& exit : group.Collect()) exits.push_back(std::move(exit));
    std::this_thread::sleep_for(kLookEvery);
  }
  return exits;
}

pid_t StartScript(ProcessGroup& group, Role role, const std::string& script) {
  return group.Start(role, "/bin/sh", {"-c", script});
}

TEST(ProcessGroupTest, TellsHowAProcessEndedAndWhatItPrinted) {
  ProcessGroup group;
  const pid_t pid = StartScript(group, Role::kAcc, "echo one; echo two >&2; exit 3");
  const auto exits = CollectUntil(group, 1);
  ASSERT_EQ(exits.size(), 1U);
  EXPECT_EQ(exits[0].role, Role::kAcc);
  EXPECT_EQ(exits[0].pid, pid);
  EXPECT_EQ(exits[0].how, "exited with code 3");
  EXPECT_FALSE(exits[0].killed);
  EXPECT_THAT(exits[0].lines, ElementsAre("one", "two"));
  EXPECT_TRUE(group.empty());
  EXPECT_THAT(group.Collect(), IsEmpty()) << "an end is told once";
}

TEST(ProcessGroupTest, NamesTheProcessesThatStillRun) {
  ProcessGroup group;
  EXPECT_EQ(group.Describe(), "");
  const pid_t world = StartScript(group, Role::kWorld, "sleep 60");
  StartScript(group, Role::kRadar, "exit 0");
  const pid_t acc = StartScript(group, Role::kAcc, "sleep 60");
  ASSERT_EQ(CollectUntil(group, 1).size(), 1U);
  EXPECT_EQ(group.Describe(), "world " + std::to_string(world) + ", acc " + std::to_string(acc));
}

TEST(ProcessGroupTest, SendsASignalToAll) {
  ProcessGroup group;
  StartScript(group, Role::kWorld, "exec sleep 60");
  StartScript(group, Role::kRadar, "exec sleep 60");
  group.Signal(SIGTERM);
  const auto exits = CollectUntil(group, 2);
  ASSERT_EQ(exits.size(), 2U);
  for (const ProcessGroup::Exit& exit : exits) {
    EXPECT_TRUE(exit.killed);
    EXPECT_EQ(exit.how, "was killed by signal 15 (Terminated)");
  }
}

TEST(ProcessGroupTest, KillsOneOfItsProcesses) {
  ProcessGroup group;
  const pid_t killed = StartScript(group, Role::kAcc, "exec sleep 100");
  const pid_t other = StartScript(group, Role::kRadar, "exec sleep 100");
  group.Kill(killed);
  const auto exits = CollectUntil(group, 1);
  ASSERT_EQ(exits.size(), 1U);
  EXPECT_EQ(exits[0].pid, killed);
  EXPECT_TRUE(exits[0].killed);
  EXPECT_TRUE(IsAlive(other));
  group.Kill(getpid());  // this process is not in the group, so it goes on
}

/// The state of a process, such as 'T' for a stopped one. /proc/PID/stat is "4711 (name) S ...".
char StateOf(pid_t pid) {
  const std::string stat = Content("/proc/" + std::to_string(pid) + "/stat");
  return stat.at(stat.rfind(')') + 2);
}

TEST(ProcessGroupTest, HasActivityWhileAProcessComputesAndNoneWhileItIsStopped) {
  ProcessGroup group;
  const pid_t pid = StartScript(group, Role::kWorld, "while :; do :; done");
  const auto begin = group.ActivityOf(pid);
  ASSERT_TRUE(begin);
  // The process has far fewer context switches in the time of this test. So only its processor
  // time, in ns, makes the number grow by this much.
  constexpr std::int64_t kMuch = 10'000'000;
  const TimePoint end = Clock::now() + kPatience;
  while (*group.ActivityOf(pid) < *begin + kMuch && Clock::now() < end) {
    std::this_thread::sleep_for(kLookEvery);
  }
  EXPECT_GE(*group.ActivityOf(pid), *begin + kMuch);
  kill(pid, SIGSTOP);
  while (StateOf(pid) != 'T' && Clock::now() < end) std::this_thread::sleep_for(kLookEvery);
  const auto stopped = group.ActivityOf(pid);
  // The test is about this pause: a stopped process has no activity in it.
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(group.ActivityOf(pid), stopped);
  group.Kill(pid);
  CollectUntil(group, 1);
  EXPECT_FALSE(group.ActivityOf(pid));
}

TEST(ProcessGroupTest, EndsWithItsProcesses) {
  pid_t pid = 0;
  {
    ProcessGroup group;
    // If a shell ignores a signal, the program that replaces the shell ignores the signal, too.
    pid = StartScript(group, Role::kWorld, "trap '' TERM INT HUP; exec sleep 60");
    const TimePoint end = Clock::now() + kPatience;
    while (Content("/proc/" + std::to_string(pid) + "/comm") != "sleep\n" && Clock::now() < end) {
      std::this_thread::sleep_for(milliseconds(5));  // no event reports exec
    }
    ASSERT_TRUE(IsAlive(pid));
  }
  EXPECT_FALSE(IsAlive(pid));
}

TEST(ProcessGroupTest, ReadsOnWhileAProcessPrintsMoreThanAPipeHolds) {
  ProcessGroup group;
  StartScript(group, Role::kDriver,
              "i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i + 1)); done");
  const auto exits = CollectUntil(group, 1);
  ASSERT_EQ(exits.size(), 1U) << "the process waits for a reader";
  ASSERT_EQ(exits[0].lines.size(), processes::LastLines::kKept);
  EXPECT_EQ(exits[0].lines.back(), "line 19999");
}

TEST(ProcessGroupTest, HasNoProcessThatCannotBeStarted) {
  ProcessGroup group;
  EXPECT_THROW(group.Start(Role::kAcc, "/no/such/program", {}), std::runtime_error);
  EXPECT_TRUE(group.empty());
}

}  // namespace
}  // namespace fogline::test
