// How a run ends after one of its processes or its runner is killed, or after the user ends the
// run. (In crash_test.cc, runs may start roles again.)
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <thread>

#include "services/graph.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using SteadyClock = std::chrono::steady_clock;

// A run is well under way after this many steps, which take one second.
constexpr int kUnderWay = 10;

/// A run at real speed that is well under way. The run ends if one of its roles ends.
class PacedRun {
 public:
  PacedRun()
      : run_({Program("fogline"), "run", "scenario/paper.json", "--pace", "1", "--restarts", "0",
              "--log", folder_.File("run.lcm")}) {
    EXPECT_TRUE(run_.WaitForErr("processes: "));
    // The run is under way when kUnderWay steps are on disk. The runner reports no event at this
    // moment, so the test reads the log again and again.
    const auto end = SteadyClock::now() + kPatience;
    while (StepsOnDisk() < kUnderWay && SteadyClock::now() < end) {
      std::this_thread::sleep_for(kLookEvery);
    }
    EXPECT_GE(StepsOnDisk(), kUnderWay);
  }

  std::vector<pid_t> Pids() const {
    std::vector<pid_t> pids;
    for (const RoleInfo& info : kRoles) pids.push_back(Pid(std::string(info.name)));
    return pids;
  }
  pid_t Pid(const std::string& role) const { return PidOf(run_.Err(), role); }
  Background& run() { return run_; }

  /// The number of complete steps in the log at this moment.
  int StepsOnDisk() const {
    const Outcome digest =
        RunCommand({Program("fogline"), "digest", "--json", folder_.File("run.lcm")});
    const std::size_t at = digest.out.find("\"steps\": ");
    return at == std::string::npos ? 0 : std::atoi(digest.out.c_str() + at + 9);
  }

 private:
  ScratchFolder folder_;
  Background run_;
};

/// Kills a role of a run that is well under way. Expects that the run ends with code 3, names the
/// role, leaves no process, and leaves a readable log.
/// @return the time until the end
SteadyClock::duration ExpectAKillEndsTheRun(const std::string& role) {
  PacedRun paced;
  const std::vector<pid_t> pids = paced.Pids();
  for (const pid_t pid : pids) EXPECT_GT(pid, 0);
  kill(paced.Pid(role), SIGKILL);
  const auto killed = SteadyClock::now();
  EXPECT_EQ(paced.run().Wait(), 3);
  const auto took = SteadyClock::now() - killed;
  // One line names the process.
  const std::string err = paced.run().Err();
  EXPECT_NE(err.find("error: " + role + " (pid "), std::string::npos) << err;
  EXPECT_NE(err.find("was killed by signal 9"), std::string::npos) << err;
  // No process is left, and the log is readable.
  for (const pid_t pid : pids) EXPECT_FALSE(IsAlive(pid)) << pid;
  EXPECT_GE(paced.StepsOnDisk(), kUnderWay);
  return took;
}

class KilledRoleTest : public testing::TestWithParam<RoleInfo> {};

TEST_P(KilledRoleTest, EndsTheRunWithinFiveSecondsByNameAndLeavesAReadableLogAndNoProcess) {
  const std::string role(GetParam().name);
  constexpr std::chrono::seconds kLimit(5);
  // A busy machine may delay one run, but hardly three in a row.
  constexpr int kTries = 3;
  SteadyClock::duration took = ExpectAKillEndsTheRun(role);
  for (int i = 1; i < kTries && took >= kLimit; ++i) took = ExpectAKillEndsTheRun(role);
  EXPECT_LT(took, kLimit);
}

INSTANTIATE_TEST_SUITE_P(EveryRole, KilledRoleTest, testing::ValuesIn(kRoles),
                         [](const auto& role) { return std::string(role.param.name); });

/// The sockets that a process has, such as "socket:[4711]".
std::set<std::string> SocketsOf(pid_t pid) {
  std::set<std::string> sockets;
  for (const auto& file :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    const std::string what = std::filesystem::read_symlink(file).string();
    if (what.starts_with("socket:")) sockets.insert(what);
  }
  return sockets;
}

TEST(FaultTest, NoRoleHasASocketOfTheRunner) {
  PacedRun paced;
  const std::set<std::string> ours = SocketsOf(paced.run().pid());
  ASSERT_FALSE(ours.empty());
  for (const pid_t pid : paced.Pids()) {
    for (const std::string& socket : SocketsOf(pid)) EXPECT_FALSE(ours.contains(socket)) << pid;
  }
}

TEST(FaultTest, NamesAProcessThatHangs) {
  // The error must name the stopped role. If a busy machine gave another role no processor time for
  // 1 s at the end of the run, the error may name this other role. Then the test tries again.
  constexpr int kTries = 3;
  bool named = false;
  std::string err;
  for (int i = 0; i < kTries && !named; ++i) {
    PacedRun paced;
    const std::vector<pid_t> pids = paced.Pids();
    kill(paced.Pid("fusion"), SIGSTOP);
    EXPECT_EQ(paced.run().Wait(), 3);
    err = paced.run().Err();
    named = err.find("waits for TRACK from fusion (last heard: step ") != std::string::npos;
    for (const pid_t pid : pids) EXPECT_FALSE(IsAlive(pid)) << pid;
  }
  EXPECT_TRUE(named) << err;
}

TEST(FaultTest, EndsCleanlyOnCtrlCWithCode130) {
  PacedRun paced;
  const std::vector<pid_t> pids = paced.Pids();
  paced.run().Signal(SIGINT);
  EXPECT_EQ(paced.run().Wait(), 130);
  EXPECT_NE(paced.run().Err().find("interrupted at step "), std::string::npos);
  for (const pid_t pid : pids) EXPECT_FALSE(IsAlive(pid)) << pid;
  EXPECT_GE(paced.StepsOnDisk(), kUnderWay);
}

TEST(FaultTest, LeavesNoProcessWhenTheRunnerItselfIsKilled) {
  constexpr std::chrono::seconds kLimit(5);
  // A busy machine may delay one run, but hardly three in a row.
  constexpr int kTries = 3;
  SteadyClock::duration took = kLimit;
  for (int i = 0; i < kTries && took >= kLimit; ++i) {
    PacedRun paced;
    const std::vector<pid_t> pids = paced.Pids();
    const auto killed = SteadyClock::now();
    paced.run().Signal(SIGKILL);
    EXPECT_EQ(paced.run().Wait(), 128 + SIGKILL);
    // The roles are not children of this test, so the test cannot wait for their ends by waitpid().
    for (const pid_t pid : pids) {
      while (IsAlive(pid) && SteadyClock::now() < killed + kPatience) {
        std::this_thread::sleep_for(kLookEvery);
      }
      EXPECT_FALSE(IsAlive(pid)) << pid;
    }
    took = SteadyClock::now() - killed;
    EXPECT_GE(paced.StepsOnDisk(), kUnderWay);
  }
  EXPECT_LT(took, kLimit);
}

}  // namespace
}  // namespace fogline::test
