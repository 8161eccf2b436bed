// The processes that take part in a run.
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "services/runtime/coordination/run_coordinator.h"
#include "tests/unit/services/runtime/coordination/coordinator_fixture.h"

namespace fogline {
namespace {

using test::RunCoordinatorTest;
using test::Script;
using testing::HasSubstr;

TEST_F(RunCoordinatorTest, IgnoresADeadProcessThatItHadNeverHeardOf) {
  coordinator_.MarkDead(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  SayStatus(Role::kFusion);
  EXPECT_FALSE(coordinator_.member(Role::kFusion).status);
  // The next process of the role may have the same process id. The STATUS of this process counts.
  coordinator_.Launched(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  SayStatus(Role::kFusion);
  EXPECT_TRUE(coordinator_.member(Role::kFusion).status);
}

TEST_F(RunCoordinatorTest, RefusesARoleThatHasAnotherScenario) {
  role(Role::kRadar).scenario_hash = "of another scenario";
  role(Role::kRadar).state = status_t::WAITING;
  SayStatus(Role::kRadar);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kJoining) << "it has none yet";
  role(Role::kRadar).state = status_t::READY;
  SayStatus(Role::kRadar);
  EXPECT_THAT(coordinator_.error(), testing::MatchesRegex("radar .pid .* has another scenario"));
}

TEST_F(RunCoordinatorTest, RefusesARoleThatWasBuiltWithOtherMessageTypes) {
  ++role(Role::kRadar).type_fingerprint;
  SayStatus(Role::kRadar);
  EXPECT_THAT(coordinator_.error(),
              testing::MatchesRegex("radar .pid .* was built with other message types"));
}

TEST_F(RunCoordinatorTest, TellsProcessesOfTwoMachinesApartThatHaveOneId) {
  const std::int32_t pid = role(Role::kFusion).pid;
  coordinator_.MarkDead(Role::kFusion, pid, Clock::now(), "lab2");
  SayStatus(Role::kFusion);
  EXPECT_TRUE(coordinator_.member(Role::kFusion).status) << "it is a process of this machine";
  // WHEN the process on the other machine is the role's current process
  role(Role::kAcc).host = "lab2";
  SayStatus(Role::kAcc);
  coordinator_.MarkDead(Role::kAcc, role(Role::kAcc).pid, Clock::now());
  EXPECT_TRUE(coordinator_.member(Role::kAcc).status) << "the dead one was on this machine";
  coordinator_.MarkDead(Role::kAcc, role(Role::kAcc).pid, Clock::now(), "lab2");
  EXPECT_FALSE(coordinator_.member(Role::kAcc).status);
}

TEST_F(RunCoordinatorTest, AwaitsRolesFromElsewhereUntilTheyAreThereAndWhenTheyFallSilent) {
  using testing::ElementsAre;
  using testing::IsEmpty;
  runtime::RunCoordinator coordinator(script_.bus(), {.run_id = Script::kRunId,
                                                      .scenario_text = script_.text(),
                                                      .stall_limit = milliseconds(60'000),
                                                      .external = {Role::kDriver, Role::kAcc}});
  const TimePoint now = Clock::now();
  EXPECT_THAT(coordinator.Awaited(now), ElementsAre(Role::kAcc, Role::kDriver));
  SayStatus(Role::kAcc);
  role(Role::kDriver).state = status_t::WAITING;
  SayStatus(Role::kDriver);
  EXPECT_THAT(coordinator.Awaited(now), ElementsAre(Role::kDriver)) << "it has no scenario yet";
  BeAtStep(-1);
  EXPECT_THAT(coordinator.Awaited(now), IsEmpty());
  // WHEN no role sends a message for more than a second
  const TimePoint later = Clock::now() + milliseconds(1200);
  PollUntil(coordinator, later);
  EXPECT_THAT(coordinator.Awaited(later), ElementsAre(Role::kAcc, Role::kDriver));
}

TEST_F(RunCoordinatorTest, TakesARoleThatItHasStartedFromThisProcessAlone) {
  // GIVEN a process that claims a role before the runner's own process sends a message
  status_t& acc = role(Role::kAcc);
  coordinator_.Launched(Role::kAcc, acc.pid, Clock::now());
  status_t stray = acc;
  stray.pid += 1000;
  stray.instance += 1000;
  stray.sequence = 1;
  script_.Say(stray);
  EXPECT_FALSE(coordinator_.member(Role::kAcc).status);
  // WHEN both processes send messages, THEN the run goes on with the runner's process, and RUN
  // names this process
  BeAtStep(-1);
  ++stray.sequence;
  script_.Say(stray);
  BeAtStep(0);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning);
  EXPECT_EQ(coordinator_.member(Role::kAcc).status->instance, acc.instance);
  EXPECT_EQ(coordinator_.member(Role::kAcc).refused->pid, stray.pid);
  Poll(Clock::now() + milliseconds(300));
  EXPECT_EQ(said_.back().external, std::vector<std::string>{"acc"});
  EXPECT_EQ(said_.back().holder.at(0), acc.instance);
  EXPECT_EQ(said_.back().phase, run_t::GO);
  // AND a failure of the stray process does not end the run
  stray.state = status_t::FAILED;
  ++stray.sequence;
  script_.Say(stray);
  EXPECT_EQ(coordinator_.phase(), runtime::RunCoordinator::Phase::kRunning) << coordinator_.error();
}

/// A run whose driver is started elsewhere.
class ExternalDriverTest : public RunCoordinatorTest {
 protected:
  /// The instance that the run names as its driver.
  std::int64_t Holder() {
    PassTime(milliseconds(300));  // longer than the period of the runner's RUN messages
    script_.bus().Drain();
    EXPECT_EQ(said_.back().external, std::vector<std::string>{"driver"});
    return said_.back().holder.at(0);
  }
  /// Lets time pass for the runner.
  void PassTime(milliseconds time) {
    PollUntil(external_, Clock::now() + later_ + time);
    later_ += time;
  }
  status_t OtherDriver() {
    status_t other = role(Role::kDriver);
    other.instance += 1000;
    other.pid += 1000;
    other.state = status_t::READY;
    return other;
  }

  runtime::RunCoordinator external_{script_.bus(),
                                    {.run_id = Script::kRunId,
                                     .scenario_text = script_.text(),
                                     .stall_limit = milliseconds(60'000),
                                     .external = {Role::kDriver},
                                     .restarts = 10}};
  Duration later_{};
};

TEST_F(ExternalDriverTest, HasItsPlaceFromItsFirstWordUntilItIsSilent) {
  EXPECT_EQ(Holder(), 0);
  role(Role::kDriver).state = status_t::WAITING;
  SayStatus(Role::kDriver);
  EXPECT_EQ(Holder(), role(Role::kDriver).instance);
  PassTime(milliseconds(1100));
  EXPECT_EQ(Holder(), 0);
  EXPECT_EQ(said_.back().stall_ms, 60'000);
}

TEST_F(ExternalDriverTest, IsOneWhenTheOtherLeavesThatHearsSo) {
  BeAtStep(-1);
  status_t other = OtherDriver();
  script_.Say(other);
  EXPECT_EQ(Holder(), role(Role::kDriver).instance);
  EXPECT_EQ(said_.back().phase, run_t::PREPARE) << "two of them: the run does not begin";
  other.state = status_t::LEFT;
  ++other.sequence;
  script_.Say(other);
  EXPECT_EQ(Holder(), role(Role::kDriver).instance);
  EXPECT_EQ(said_.back().phase, run_t::GO);
  EXPECT_EQ(external_.member(Role::kDriver).replaced, 0);
}

TEST_F(ExternalDriverTest, IsFreeAtOnceWhenItLeaves) {
  BeAtStep(-1);
  role(Role::kDriver).state = status_t::LEFT;
  role(Role::kDriver).error = "went to run 8";
  SayStatus(Role::kDriver);
  EXPECT_EQ(Holder(), 0);
  script_.Say(OtherDriver());
  EXPECT_EQ(Holder(), OtherDriver().instance);
}

/// ExternalDriverTest with the real clock, because the coordinator takes the time of each message
/// from the clock.
class StrayWordTest : public ExternalDriverTest {
 protected:
  /// Publishes a STATUS of the process `who` every 100 ms, for the duration `time`. The process is
  /// the driver, or another process that takes the driver's role.
  void SpeakFor(milliseconds time, status_t& who) {
    for (const TimePoint end = Clock::now() + time; Clock::now() < end;) {
      Say(who);
      for (const TimePoint next = Clock::now() + milliseconds(100); Clock::now() < next;) {
        external_.Poll(Clock::now());
        script_.bus().Wait(milliseconds(10));
      }
    }
  }
  void Say(status_t& who) {
    ++who.sequence;
    script_.Say(who);
  }
};

TEST_F(StrayWordTest, OfARivalLongAfterAnotherIsNotTwoProcesses) {
  BeAtStep(-1);
  status_t& driver = role(Role::kDriver);
  status_t other = OtherDriver();
  Say(other);
  SpeakFor(milliseconds(1300), driver);
  Say(other);
  EXPECT_NE(external_.phase(), runtime::RunCoordinator::Phase::kFailed) << external_.error();
  EXPECT_FALSE(external_.member(Role::kDriver).refused);
  // If the other process continues to send, it is refused, and the run goes on.
  for (int i = 0; i < 12; ++i) {
    Say(other);
    SpeakFor(milliseconds(100), driver);
  }
  EXPECT_EQ(external_.phase(), runtime::RunCoordinator::Phase::kRunning) << external_.error();
  EXPECT_EQ(external_.member(Role::kDriver).status->instance, driver.instance);
  ASSERT_TRUE(external_.member(Role::kDriver).refused);
  EXPECT_EQ(external_.member(Role::kDriver).refused->pid, other.pid);
  // AND if the run fails for another reason, the error names both processes
  external_.Fail("step 5: DRIVER_COMMAND came twice with different contents");
  EXPECT_THAT(external_.error(), HasSubstr("\n  two processes have the role driver: pid 105 on "));
  EXPECT_THAT(external_.error(), HasSubstr(", and pid 1105 on "));
}

TEST_F(StrayWordTest, OfADeadProcessLongAfterAnotherIsNotEither) {
  BeAtStep(-1);
  status_t& dead = role(Role::kDriver);
  status_t other = OtherDriver();
  // GIVEN a driver that sent nothing for a second and was then replaced
  while (external_.member(Role::kDriver).replaced == 0) SpeakFor(milliseconds(100), other);
  SpeakFor(milliseconds(200), other);
  Say(dead);
  SpeakFor(milliseconds(1300), other);
  Say(dead);
  EXPECT_NE(external_.phase(), runtime::RunCoordinator::Phase::kFailed) << external_.error();
}

TEST_F(StrayWordTest, OfASuccessorCountsAsOftenAsTheRunAllowsRestarts) {
  const auto with_restarts = [this](int restarts) {
    return runtime::RunCoordinatorOptions{.run_id = Script::kRunId,
                                          .scenario_text = script_.text(),
                                          .stall_limit = milliseconds(60'000),
                                          .external = {Role::kDriver},
                                          .restarts = restarts};
  };
  runtime::RunCoordinator once(script_.bus(), with_restarts(1));
  runtime::RunCoordinator never(script_.bus(), with_restarts(0));
  BeAtStep(-1);
  // WHEN the driver sends nothing for a second, and another process takes its place
  status_t other = OtherDriver();
  while (external_.member(Role::kDriver).replaced == 0) SpeakFor(milliseconds(100), other);
  // If this process pauses, one coordinator may regard the driver as silent, and another may not.
  // So the successor goes on sending until `once` and `never` have noticed the silence, too.
  constexpr int kTries = 100;
  for (int i = 0; i < kTries && (once.member(Role::kDriver).replaced == 0 || never.error().empty());
       ++i) {
    SpeakFor(milliseconds(100), other);
  }
  SpeakFor(milliseconds(200), other);
  EXPECT_EQ(once.member(Role::kDriver).replaced, 1);
  EXPECT_NE(once.phase(), runtime::RunCoordinator::Phase::kFailed) << once.error();
  EXPECT_THAT(never.error(), HasSubstr("after 0 restarts (--restarts)"));
}

TEST_F(RunCoordinatorTest, RefusesARoleOfAnotherBuildIfThatIsWanted) {
  runtime::RoleBuilds builds;
  builds.fill(4711);
  for (const bool wanted : {false, true}) {
    runtime::RunCoordinator coordinator(script_.bus(), {.run_id = Script::kRunId,
                                                        .scenario_text = script_.text(),
                                                        .builds = builds,
                                                        .same_build = wanted});
    role(Role::kAcc).build_id = 4711;
    SayStatus(Role::kAcc);
    EXPECT_EQ(coordinator.phase(), runtime::RunCoordinator::Phase::kJoining) << coordinator.error();
    role(Role::kDriver).build_id = 17;
    SayStatus(Role::kDriver);
    EXPECT_EQ(coordinator.phase() == runtime::RunCoordinator::Phase::kFailed, wanted)
        << coordinator.error();
    if (!wanted) continue;
    EXPECT_THAT(coordinator.error(), HasSubstr("driver (pid "));
    EXPECT_THAT(coordinator.error(), HasSubstr(" is of build 0000000000000011, but the runner is "
                                               "of build 0000000000001267 (--same-build)"));
  }
}

TEST_F(RunCoordinatorTest, RefusesARoleThatDoesNotSayItsBuildIfTheSameIsWanted) {
  runtime::RoleBuilds builds;
  builds.fill(4711);
  runtime::RunCoordinator coordinator(script_.bus(), {.run_id = Script::kRunId,
                                                      .scenario_text = script_.text(),
                                                      .builds = builds,
                                                      .same_build = true});
  SayStatus(Role::kDriver);
  EXPECT_THAT(coordinator.error(), HasSubstr("does not report its build (--same-build)"));
}

}  // namespace
}  // namespace fogline
