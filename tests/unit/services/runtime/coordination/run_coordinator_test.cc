#include "services/runtime/coordination/run_coordinator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "tests/unit/services/runtime/coordination/coordinator_fixture.h"

namespace fogline {
namespace {

using test::RunCoordinatorTest;
using test::Script;
using testing::HasSubstr;

TEST_F(RunCoordinatorTest, SaysPrepareUntilEveryRoleIsReadyAndThenGo) {
  Poll(Clock::now());
  EXPECT_EQ(said_.back().phase, run_t::PREPARE);
  EXPECT_EQ(said_.back().progress, -1);
  BeAtStep(-1);
  EXPECT_EQ(said_.back().phase, run_t::GO);
}

TEST_F(RunCoordinatorTest, TellsARoleThatJoinsHowFarTheRunIs) {
  BeAtStep(-1);
  BeAtStep(40);
  role(Role::kRecorder).header.step = 48;
  SayStatus(Role::kRecorder);
  Poll(Clock::now() + milliseconds(300));
  EXPECT_EQ(said_.back().progress, 48);
  EXPECT_EQ(coordinator_.step(), 48);
}

TEST_F(RunCoordinatorTest, PreparesARoleThatIsStartedAgainAndSaysGoWhenItIsReady) {
  BeAtStep(-1);
  BeAtStep(40);
  // WHEN the process of the fusion has ended
  coordinator_.MarkDead(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Poll(Clock::now());
  EXPECT_EQ(said_.back().phase, run_t::PREPARE);
  EXPECT_EQ(said_.back().progress, 40);
  // AND the last STATUS of the ended process comes late, THEN this STATUS does not count
  SayStatus(Role::kFusion);
  Poll(Clock::now());
  EXPECT_FALSE(coordinator_.member(Role::kFusion).status);
  // WHEN the next process of the fusion has come
  Replace(Role::kFusion);
  SayStatus(Role::kFusion);
  Poll(Clock::now());
  EXPECT_EQ(said_.back().phase, run_t::GO);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning);
}

TEST_F(RunCoordinatorTest, SaysForWhichRolesItWaits) {
  for (const RoleInfo& info : kRoles) {
    role(info.role).state = info.role == Role::kFusion ? status_t::WAITING : status_t::READY;
    SayStatus(info.role);
  }
  Poll(Clock::now());
  EXPECT_EQ(coordinator_.WhereOrWaiting(), "while waiting for fusion");
  // The last role has come, but the coordinator has not begun the run yet.
  role(Role::kFusion).state = status_t::READY;
  SayStatus(Role::kFusion);
  script_.bus().Drain();
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kJoining);
  EXPECT_EQ(coordinator_.WhereOrWaiting(), "before step 0");
}

class JoinLimitTest : public RunCoordinatorTest {
 protected:
  using Phase = runtime::RunCoordinator::Phase;

  /// Publishes a STATUS with WAITING for one role, and with READY for all other roles.
  void AllAreReadyExcept(Role waiting) {
    role(waiting).state = status_t::WAITING;
    for (const RoleInfo& info : kRoles) SayStatus(info.role);
    limited_.Poll(began_);
    script_.bus().Drain();
  }

  const TimePoint began_ = Clock::now();
  runtime::RunCoordinator limited_{script_.bus(),
                                   {.run_id = Script::kRunId,
                                    .scenario_text = script_.text(),
                                    .join_limit = milliseconds(10'000),
                                    .prepare_limit = milliseconds(60'000)}};
};

TEST_F(JoinLimitTest, EndsTheRunIfARoleIsNeverHeard) {
  PollUntil(limited_, began_ + milliseconds(9'500));
  EXPECT_EQ(limited_.phase(), Phase::kJoining);
  PollUntil(limited_, began_ + milliseconds(11'000));
  EXPECT_EQ(limited_.phase(), Phase::kFailed);
  EXPECT_THAT(limited_.error(), HasSubstr("not ready after 10.0 s: world (never heard), radar"));
}

TEST_F(JoinLimitTest, CountsFromTheMomentAtWhichNoExternalRoleIsAwaited) {
  runtime::RunCoordinator with_external(script_.bus(), {.run_id = Script::kRunId,
                                                        .scenario_text = script_.text(),
                                                        .join_limit = milliseconds(10'000),
                                                        .prepare_limit = milliseconds(10'000),
                                                        .external = {Role::kDriver}});
  PollUntil(with_external, began_ + milliseconds(30'000));
  EXPECT_EQ(with_external.phase(), Phase::kJoining) << with_external.error();
  role(Role::kDriver).state = status_t::READY;
  SayStatus(Role::kDriver);
  script_.bus().Drain();
  PollUntil(with_external, began_ + milliseconds(39'000));
  EXPECT_EQ(with_external.phase(), Phase::kJoining) << with_external.error();
  PollUntil(with_external, began_ + milliseconds(42'000));
  EXPECT_EQ(with_external.phase(), Phase::kFailed);
  EXPECT_THAT(with_external.error(), HasSubstr("world (never heard)"));
}

TEST_F(JoinLimitTest, IsLongerForARoleThatHasWaitedAndThenPreparesInSilence) {
  AllAreReadyExcept(Role::kWorld);
  PollUntil(limited_, began_ + milliseconds(59'000));
  EXPECT_EQ(limited_.phase(), Phase::kJoining) << limited_.error();
  PollUntil(limited_, began_ + milliseconds(62'000));
  EXPECT_EQ(limited_.phase(), Phase::kFailed);
  EXPECT_THAT(limited_.error(), testing::EndsWith(" s: world"));
}

TEST_F(JoinLimitTest, CountsForARoleThatHasJustSaidThatItWaits) {
  runtime::RunCoordinator short_of_time(script_.bus(), {.run_id = Script::kRunId,
                                                        .scenario_text = script_.text(),
                                                        .join_limit = milliseconds(300),
                                                        .prepare_limit = milliseconds(60'000)});
  AllAreReadyExcept(Role::kWorld);
  PollUntil(short_of_time, began_ + milliseconds(600));
  EXPECT_EQ(short_of_time.phase(), Phase::kFailed);
  EXPECT_THAT(short_of_time.error(), testing::EndsWith(" s: world"));
}

TEST_F(RunCoordinatorTest, AddsUpTheCountersOfTheDeadAndTheLiving) {
  role(Role::kFusion).repairs_asked = 3;
  BeAtStep(-1);
  coordinator_.MarkDead(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Replace(Role::kFusion);
  role(Role::kFusion).repairs_asked = 4;
  SayStatus(Role::kFusion);
  EXPECT_EQ(coordinator_.Total(&status_t::repairs_asked), 7);
}

TEST_F(RunCoordinatorTest, CountsTheProgressOfARoleThatCatchesUp) {
  BeAtStep(-1);
  BeAtStep(40);
  PollUntil(coordinator_, Clock::now() + milliseconds(3900));
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning);
  coordinator_.MarkDead(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Replace(Role::kFusion);
  for (const std::int64_t step : {-1, 10, 20}) {
    role(Role::kFusion).header.step = step;
    SayStatus(Role::kFusion);
  }
  PollUntil(coordinator_, Clock::now() + milliseconds(3900));
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning);
  EXPECT_EQ(coordinator_.step(), 40) << "the step of the run, not of the role that catches up";
  PollUntil(coordinator_, Clock::now() + milliseconds(4100));
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kFailed);
}

TEST_F(RunCoordinatorTest, TakesNoStatusThatALaterOneHasOvertaken) {
  BeAtStep(-1);
  BeAtStep(40);
  status_t overtaken = role(Role::kFusion);
  --overtaken.sequence;
  overtaken.header.step = 30;
  script_.Say(overtaken);
  EXPECT_EQ(coordinator_.member(Role::kFusion).status->header.step, 40);
}

TEST_F(RunCoordinatorTest, BlamesNoRoleForSilenceWhileItWasHeldUpItself) {
  BeAtStep(-1);
  BeAtStep(40);
  const TimePoint again = Clock::now() + milliseconds(5000);
  Poll(again);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning) << coordinator_.error();
  EXPECT_GE(coordinator_.TakeLongestPause(), milliseconds(4900));
  EXPECT_EQ(coordinator_.TakeLongestPause(), Duration::zero());
  // The roles are silent after the runner's pause, too. This silence counts, and the time limit is
  // 4 s. The test itself may have stood still before the first Poll(). A standstill of less than
  // 500 ms is not a pause and counts as silence. So the run may fail up to 500 ms earlier.
  TimePoint now = again;
  for (; now < again + milliseconds(3400); now += milliseconds(20)) coordinator_.Poll(now);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning) << coordinator_.error();
  for (; now < again + milliseconds(4020); now += milliseconds(20)) coordinator_.Poll(now);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kFailed);
}

TEST_F(RunCoordinatorTest, FindsAStallHoweverOftenItIsHeldUpItself) {
  BeAtStep(-1);
  BeAtStep(40);
  // GIVEN a runner that again and again runs for a second and is then held up for 0.6 s
  const TimePoint began = Clock::now();
  TimePoint now = began;
  Duration looked{};
  while (coordinator_.phase() == runtime::RunCoordinator::Phase::kRunning &&
         now < began + milliseconds(20'000)) {
    const Duration away =
        looked % milliseconds(1000) == Duration::zero() ? milliseconds(600) : milliseconds(20);
    now += away;
    looked += milliseconds(20);
    coordinator_.Poll(now);
  }
  // THEN the run stalls after four seconds in which the runner was not held up
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kFailed);
  EXPECT_NEAR(std::chrono::duration<double>(now - began).count(), 4 + 4 * 0.6, 0.7);
}

TEST_F(RunCoordinatorTest, BlamesForAStallTheRoleAtTheEndOfTheChain) {
  runtime::RunCoordinator hasty(script_.bus(), {.run_id = Script::kRunId,
                                                .scenario_text = script_.text(),
                                                .stall_limit = milliseconds(100)});
  BeAtStep(-1);
  hasty.Poll(Clock::now());
  // GIVEN roles that wait for one another
  const auto wait = [this](Role who, std::int64_t next, const char* channel, std::int64_t heard) {
    role(who).header.step = next - 1;
    role(who).waiting_for = channel;
    role(who).last_heard_step = heard;
    SayStatus(who);
  };
  wait(Role::kWorld, 8, "HOST_COMMAND", 6);
  wait(Role::kArbitrator, 7, "DRIVER_COMMAND", 6);
  // WHEN the driver lacks a message that the arbitrator has already sent
  wait(Role::kDriver, 7, "HOST_COMMAND", 5);
  hasty.Poll(Clock::now() + milliseconds(150));
  EXPECT_THAT(
      hasty.error(),
      HasSubstr("step 7: driver waits for HOST_COMMAND from arbitrator (last heard: step 5"));
}

TEST_F(RunCoordinatorTest, RefusesInRealTimeAStepThatTheClockCannotHaveReached) {
  runtime::RunCoordinator coordinator(script_.bus(), InRealtime(500, std::chrono::hours(1)));
  const auto say = [&](std::int64_t step) {
    role(Role::kRadar).header.step = step;
    SayStatus(Role::kRadar);
    coordinator.Poll(Clock::now());
  };
  BeAtStep(-1);
  say(400);
  EXPECT_EQ(coordinator.step(), -1);
  say(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(coordinator.step(), -1);
  say(1);
  EXPECT_EQ(coordinator.step(), 1);
}

TEST_F(RunCoordinatorTest, AllowsAWorldThatIsStartedAgainOneStepMore) {
  runtime::RunCoordinator coordinator(script_.bus(), InRealtime(500, std::chrono::hours(1)));
  BeAtStep(-1);
  coordinator.Poll(Clock::now());
  BeAtStep(2);
  EXPECT_EQ(coordinator.step(), 2);
  BeAtStep(3);
  EXPECT_EQ(coordinator.step(), 2);
  for (const std::int64_t step : {3, 4}) {
    coordinator.MarkDead(Role::kWorld, role(Role::kWorld).pid, Clock::now());
    Replace(Role::kWorld);
    BeAtStep(step);
    EXPECT_EQ(coordinator.step(), step);
  }
}

TEST_F(RunCoordinatorTest, FollowsAWorldWhoseClockIsALittleFast) {
  constexpr Duration kFastPeriod = std::chrono::microseconds(100);
  runtime::RunCoordinator coordinator(script_.bus(), InRealtime(1'000'000, kFastPeriod));
  BeAtStep(-1);
  coordinator.Poll(Clock::now());
  const TimePoint begin = Clock::now();
  // After this time a clock that is 1200 ppm fast is 12 periods ahead.
  constexpr Duration kLong = milliseconds(1000);
  while (Clock::now() < begin + kLong) {
    const double periods = Seconds(Clock::now() - begin) / Seconds(kFastPeriod);
    const auto step = static_cast<std::int64_t>(periods * (1 + 1200e-6));
    role(Role::kWorld).header.step = step;
    role(Role::kWorld).state = status_t::RUNNING;
    SayStatus(Role::kWorld);
    ASSERT_EQ(coordinator.step(), step);
  }
}

TEST_F(RunCoordinatorTest, SaysWithTheCulpritWhyItCannotBeStartedAgain) {
  runtime::RunCoordinator hasty(script_.bus(), {.run_id = Script::kRunId,
                                                .scenario_text = script_.text(),
                                                .stall_limit = milliseconds(100)});
  BeAtStep(-1);
  hasty.Poll(Clock::now());
  hasty.MarkDead(Role::kWorld, role(Role::kWorld).pid, Clock::now());
  hasty.Hinder(Role::kWorld, "cannot start fogline-world: Resource temporarily unavailable");
  hasty.Poll(Clock::now() + milliseconds(150));
  EXPECT_THAT(hasty.error(), HasSubstr("world is silent"));
  EXPECT_THAT(hasty.error(),
              HasSubstr("; cannot start fogline-world: Resource temporarily unavailable"));
}

TEST_F(RunCoordinatorTest, TellsWhatRolesCouldNotSendTheDeadIncluded) {
  role(Role::kFusion).sends_failed = 3;
  role(Role::kFusion).send_error = "Operation not permitted";
  BeAtStep(-1);
  coordinator_.MarkDead(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Replace(Role::kFusion);
  role(Role::kFusion).sends_failed = 4;
  role(Role::kFusion).send_error = "Network is unreachable";
  SayStatus(Role::kFusion);
  const std::vector<runtime::SendTrouble> troubles = coordinator_.SendTroubles();
  ASSERT_EQ(troubles.size(), 1U);
  EXPECT_EQ(troubles[0].role, "fusion");
  EXPECT_EQ(troubles[0].count, 7);
  EXPECT_EQ(troubles[0].error, "Network is unreachable");
  coordinator_.Fail("the error");
  EXPECT_EQ(coordinator_.error(),
            "the error\n  messages that could not be sent: fusion 7 (Network is unreachable)");
}

TEST_F(RunCoordinatorTest, CountsWhatItRefusesItself) {
  auto foreign = role(Role::kRadar);
  foreign.header.run_id = Script::kRunId + 1;
  script_.Say(foreign);
  auto unknown_role = role(Role::kRadar);
  unknown_role.role = "pilot";
  script_.Say(unknown_role);
  script_.bus().Publish("STATUS", std::vector<std::uint8_t>(100));
  script_.bus().Publish("RESEND", std::vector<std::uint8_t>(100));
  script_.bus().Publish("RESEND", std::vector<std::uint8_t>(3));
  auto resend = Script::Of<resend_t>(0);
  resend.header.run_id = Script::kRunId + 1;
  script_.Say(resend);
  const auto count = [refused = coordinator_.Refused()](std::int64_t status_t::*counter) {
    const auto* kind =
        std::ranges::find(runtime::kRefusals, counter, &runtime::RefusalKind::counter);
    return refused[static_cast<std::size_t>(kind - runtime::kRefusals.begin())];
  };
  EXPECT_EQ(count(&status_t::foreign), 2);
  EXPECT_EQ(count(&status_t::malformed), 2);
  EXPECT_EQ(count(&status_t::wrong_type), 2);
}

TEST_F(RunCoordinatorTest, SaysWithItsErrorWhatIsWrongWithTheKeys) {
  BeAtStep(-1);
  EXPECT_EQ(coordinator_.KeyTrouble(), "");
  role(Role::kFusion).badly_signed = 4211;
  SayStatus(Role::kFusion);
  coordinator_.Fail("the error");
  EXPECT_EQ(coordinator_.error(),
            "the error\n  4211 messages with a wrong signature were refused: do all processes have "
            "the same key?");
}

TEST_F(RunCoordinatorTest, EndsOnlyWhenTheRecorderHasToldWhatItHasWrittenOfTheLastStep) {
  std::vector<resend_t>& requests = script_.Listen<resend_t>();
  BeAtStep(-1);
  BeAtStep(40);
  role(Role::kWorld).header.step = 48;
  role(Role::kWorld).state = status_t::DONE;
  SayStatus(Role::kWorld);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning);
  // WHEN the recorder's STATUS of the last step was lost, THEN the runner requests this STATUS
  PollUntil(coordinator_, Clock::now() + milliseconds(40));
  script_.bus().Drain();
  ASSERT_FALSE(requests.empty());
  EXPECT_EQ(requests.front().channel, "STATUS");
  EXPECT_EQ(requests.front().header.step, 48);
  role(Role::kRecorder).header.step = 48;
  role(Role::kRecorder).log_bytes = 4711;
  SayStatus(Role::kRecorder);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kDone);
  // AND the report that the recorder sends when it leaves counts, too
  role(Role::kRecorder).log_bytes = 4712;
  SayStatus(Role::kRecorder);
  EXPECT_EQ(coordinator_.member(Role::kRecorder).status->log_bytes, 4712);
}

}  // namespace
}  // namespace fogline
