#include "tools/runner/supervisor.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/children.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

using runner::Supervisor;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Phase = runtime::RunCoordinator::Phase;

constexpr std::int64_t kRunId = 4711;
constexpr std::int64_t kManySteps = 100'000;

/// The real programs of a run, a coordinator, and the supervisor between them.
class SupervisorTest : public testing::Test {
 protected:
  void Begin(std::int64_t steps, Supervisor::Options options) {
    coordinator_.emplace(
        bus_, runtime::RunCoordinatorOptions{.run_id = kRunId,
                                             .scenario_text = PrintScenario(Paper(steps)),
                                             .steps = steps,
                                             .stall_limit = std::chrono::seconds(20),
                                             .external = options.external,
                                             .restarts = options.restarts});
    options.url = bus_.url();
    options.run_id = kRunId;
    options.log = log_;
    if (options.silence == Duration::zero()) options.silence = std::chrono::seconds(20);
    options.say = [this](const std::string& line) { said_.push_back(line); };
    supervisor_.emplace(bus_, *coordinator_, std::move(options));
  }
  /// Does the work of a runner until the condition holds, for at most 40 s. @return whether the
  /// condition holds
  template <class Condition>
  bool PlayUntil(const Condition& condition) {
    const TimePoint end = Clock::now() + std::chrono::seconds(40);
    while (!condition() && Clock::now() < end) {
      const TimePoint now = Clock::now();
      const TimePoint next = std::min(coordinator_->Poll(now), now + milliseconds(20));
      if (bus_.Wait(next - now)) bus_.Drain();
      supervisor_->Look(Clock::now());
    }
    return condition();
  }
  bool PlayUntilStep(std::int64_t step) {
    return PlayUntil([&] { return coordinator_->step() >= step; });
  }
  bool PlayUntilPhase(Phase phase) {
    return PlayUntil([&] { return coordinator_->phase() == phase; });
  }
  pid_t PidOfRole(Role role) const {
    const std::string group = supervisor_->Describe();
    return PidOf("processes: " + group, std::string(NameOf(role)));
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  runtime::Bus bus_{runtime::FreshMulticastUrl()};
  std::optional<runtime::RunCoordinator> coordinator_;
  std::optional<Supervisor> supervisor_;
  std::vector<std::string> said_;
};

TEST_F(SupervisorTest, StartsEveryRoleAndEndsThemAfterTheRun) {
  Begin(40, {});
  std::vector<pid_t> pids;
  for (const RoleInfo& info : kRoles) pids.push_back(PidOfRole(info.role));
  EXPECT_THAT(pids, testing::Not(testing::Contains(0)));
  ASSERT_TRUE(PlayUntilPhase(Phase::kDone)) << coordinator_->error();
  const TimePoint end = Clock::now() + kPatience;
  do {  // End() waits for 1.5 s, and kills no role
    supervisor_->End();
  } while (!supervisor_->Describe().empty() && Clock::now() < end);
  EXPECT_EQ(supervisor_->Describe(), "");
  for (const pid_t pid : pids) EXPECT_FALSE(IsAlive(pid));
  EXPECT_THAT(supervisor_->restarts(), IsEmpty());
  EXPECT_THAT(said_, IsEmpty());
  EXPECT_EQ(ReadToTheEnd(log_).steps, 40);
}

TEST_F(SupervisorTest, StartsNoRoleThatIsStartedElsewhere) {
  Begin(40, {.external = {Role::kDriver}});
  EXPECT_EQ(PidOfRole(Role::kDriver), 0);
  EXPECT_NE(PidOfRole(Role::kAcc), 0);
}

TEST_F(SupervisorTest, StartsAKilledRoleAgainAndSaysSo) {
  Begin(kManySteps, {.restarts = 1});
  ASSERT_TRUE(PlayUntilStep(20)) << coordinator_->error();
  const pid_t first = PidOfRole(Role::kFusion);
  SignalOne(first, SIGKILL);
  ASSERT_TRUE(PlayUntil([&] { return !said_.empty(); }));
  EXPECT_THAT(said_.front(), testing::MatchesRegex(
                                 "fusion \\(pid " + std::to_string(first) +
                                 "\\) was killed by signal 9 \\(Killed\\) at step [0-9]+; started "
                                 "again as pid [0-9]+ \\(1 of 1\\)"));
  const std::int64_t then = coordinator_->step();
  ASSERT_TRUE(PlayUntilStep(then + 100)) << "the run does not go on: " << coordinator_->error();
  const auto restarts = supervisor_->restarts();
  ASSERT_THAT(restarts, SizeIs(1));
  EXPECT_EQ(restarts[0].role, "fusion");
  EXPECT_EQ(restarts[0].count, 1);
  EXPECT_THAT(restarts[0].last, HasSubstr("was killed by signal 9 (Killed) at step "));

  // WHEN the fusion has no restarts left, THEN the run ends
  SignalOne(PidOfRole(Role::kFusion), SIGKILL);
  ASSERT_TRUE(PlayUntilPhase(Phase::kFailed));
  EXPECT_THAT(coordinator_->error(), HasSubstr(", after 1 restarts (--restarts)"));
}

TEST_F(SupervisorTest, EndsTheRunAtAnyDeathIfNothingMayBeStartedAgain) {
  Begin(kManySteps, {.restarts = 0});
  ASSERT_TRUE(PlayUntilStep(20)) << coordinator_->error();
  const pid_t pid = PidOfRole(Role::kAcc);
  SignalOne(pid, SIGKILL);
  ASSERT_TRUE(PlayUntilPhase(Phase::kFailed));
  EXPECT_THAT(coordinator_->error(),
              ContainsRegex("^acc \\(pid " + std::to_string(pid) +
                            "\\) was killed by signal 9 \\(Killed\\) at step [0-9]+$"));
}

TEST_F(SupervisorTest, StartsNoProcessAgainThatExitsByItself) {
  Begin(kManySteps, {.traffic = {.faults = "no such fault"}, .restarts = 5});
  ASSERT_TRUE(PlayUntilPhase(Phase::kFailed));
  EXPECT_THAT(coordinator_->error(), HasSubstr(") exited with code 2 before step 0\n"));
  EXPECT_THAT(coordinator_->error(), HasSubstr(": error: ")) << "what it has printed";
  EXPECT_THAT(supervisor_->restarts(), IsEmpty());
}

// A role that is started again may end at once, for example while the network is down. In this test
// it ends because the file of its key is missing.
TEST_F(SupervisorTest, TriesAgainIfAProcessThatIsStartedAgainEndsAtOnce) {
  Begin(kManySteps, {.restarts = 1});
  ASSERT_TRUE(PlayUntilStep(20)) << coordinator_->error();
  setenv("FOGLINE_KEY", "/nowhere/key", 1);
  SignalOne(PidOfRole(Role::kFusion), SIGKILL);
  const bool has_ended = PlayUntil([&] {
    return testing::Value(
        said_,
        testing::Contains(ContainsRegex("^fusion \\(pid [0-9]+\\) exited with code 2 at step ")));
  });
  unsetenv("FOGLINE_KEY");
  ASSERT_TRUE(has_ended) << testing::PrintToString(said_) << coordinator_->error();
  const std::int64_t then = coordinator_->step();
  ASSERT_TRUE(PlayUntilStep(then + 100)) << coordinator_->error();
  EXPECT_EQ(supervisor_->restarts().at(0).count, 1);
}

TEST_F(SupervisorTest, EndsTheRunIfEveryProcessThatIsStartedAgainEndsAtOnce) {
  Begin(kManySteps, {.restarts = 1});
  ASSERT_TRUE(PlayUntilStep(20)) << coordinator_->error();
  setenv("FOGLINE_KEY", "/nowhere/key", 1);
  SignalOne(PidOfRole(Role::kFusion), SIGKILL);
  EXPECT_TRUE(PlayUntilPhase(Phase::kFailed));
  unsetenv("FOGLINE_KEY");
  EXPECT_THAT(coordinator_->error(), HasSubstr("/nowhere/key"));
  EXPECT_THAT(said_, SizeIs(2)) << testing::PrintToString(said_);
}

TEST_F(SupervisorTest, KillsAProcessThatHangsAndStartsItAgain) {
  // On a busy machine other processes may also be silent for 2 s, so the run allows 100 restarts.
  Begin(kManySteps, {.restarts = 100, .silence = milliseconds(2000)});
  ASSERT_TRUE(PlayUntilStep(20)) << coordinator_->error();
  const pid_t pid = PidOfRole(Role::kLidar);
  SignalOne(pid, SIGSTOP);
  const auto expected = testing::Contains(
      ContainsRegex("^lidar \\(pid " + std::to_string(pid) +
                    "\\) was silent for [0-9.]+ s and was killed at step [0-9]+; started again as "
                    "pid "));
  EXPECT_TRUE(PlayUntil([&] { return testing::Value(said_, expected); }))
      << testing::PrintToString(said_) << coordinator_->error();
  const std::int64_t then = coordinator_->step();
  EXPECT_TRUE(PlayUntilStep(then + 100)) << coordinator_->error();
}

}  // namespace
}  // namespace fogline::test
