#include "services/runtime/conductor.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "services/runtime/digest.h"
#include "services/runtime/this_process.h"
#include "tests/unit/runtime/script.h"

namespace fogline {
namespace {

using test::Script;
using testing::HasSubstr;

class ConductorTest : public testing::Test {
 protected:
  ConductorTest() {
    for (const RoleInfo& info : kRoles) {
      status_t& status = roles_[static_cast<std::size_t>(info.role)];
      status = Script::Of<status_t>(-1);
      status.role = info.name;
      status.host = HostName();
      status.pid = 100 + static_cast<std::int32_t>(info.role);
      status.instance = status.pid;
      status.state = status_t::READY;
      status.scenario_hash = HashOf(script_.text());
      status.type_fingerprint = TypeFingerprint();
    }
  }

  status_t& role(Role role) { return roles_[static_cast<std::size_t>(role)]; }
  void SayStatus(Role who) {
    ++role(who).sequence;
    script_.Say(role(who));
  }
  /// Says something on behalf of everybody, so that the run is at a step.
  void BeAtStep(std::int64_t step) {
    for (const RoleInfo& info : kRoles) {
      role(info.role).header.step = step;
      role(info.role).state = step < 0 ? status_t::READY : status_t::RUNNING;
      SayStatus(info.role);
    }
    Poll(Clock::now());
  }
  void Poll(TimePoint now) {
    conductor_.Poll(now);
    script_.bus().Drain();
  }
  /// Looks at the clock until then as often as a runner does.
  static void PollUntil(Conductor& conductor, TimePoint end) {
    for (TimePoint now = Clock::now(); now < end; now += milliseconds(20)) conductor.Poll(now);
    conductor.Poll(end);
  }
  /// Another process takes the place of a role.
  void Replace(Role who) {
    role(who).pid += 1000;
    role(who).instance += 1000;
    role(who).sequence = 0;
    role(who).header.step = -1;
    role(who).state = status_t::READY;
  }

  Script script_;
  std::vector<run_t>& said_ = script_.Listen<run_t>();
  Conductor conductor_{script_.bus(), {.run_id = Script::kRunId, .scenario_text = script_.text()}};
  std::array<status_t, kRoles.size()> roles_{};
};

TEST_F(ConductorTest, SaysPrepareUntilEveryRoleIsReadyAndThenGo) {
  Poll(Clock::now());
  EXPECT_EQ(said_.back().phase, run_t::PREPARE);
  EXPECT_EQ(said_.back().progress, -1);
  BeAtStep(-1);
  EXPECT_EQ(said_.back().phase, run_t::GO);
}

TEST_F(ConductorTest, TellsWhoJoinsHowFarTheRunIs) {
  BeAtStep(-1);
  BeAtStep(40);
  role(Role::kRecorder).header.step = 48;
  SayStatus(Role::kRecorder);
  Poll(Clock::now() + milliseconds(300));
  EXPECT_EQ(said_.back().progress, 48);
  EXPECT_EQ(conductor_.step(), 48);
}

TEST_F(ConductorTest, PreparesARoleThatIsStartedAgainAndSaysGoWhenItIsReady) {
  BeAtStep(-1);
  BeAtStep(40);
  // WHEN the fusion has died
  conductor_.Bury(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Poll(Clock::now());
  EXPECT_EQ(said_.back().phase, run_t::PREPARE);
  EXPECT_EQ(said_.back().progress, 40);
  // AND a last word of it comes, THEN that does not count
  SayStatus(Role::kFusion);
  Poll(Clock::now());
  EXPECT_FALSE(conductor_.member(Role::kFusion).status);
  // WHEN the next one is there
  Replace(Role::kFusion);
  SayStatus(Role::kFusion);
  Poll(Clock::now());
  EXPECT_EQ(said_.back().phase, run_t::GO);
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kRunning);
}

TEST_F(ConductorTest, IgnoresADeadProcessThatItHadNeverHeardOf) {
  conductor_.Bury(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  SayStatus(Role::kFusion);
  EXPECT_FALSE(conductor_.member(Role::kFusion).status);
  // Unless the system has given its number to the next one.
  conductor_.Launched(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  SayStatus(Role::kFusion);
  EXPECT_TRUE(conductor_.member(Role::kFusion).status);
}

TEST_F(ConductorTest, AddsUpTheCountersOfTheDeadAndTheLiving) {
  role(Role::kFusion).repairs_asked = 3;
  BeAtStep(-1);
  conductor_.Bury(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Replace(Role::kFusion);
  role(Role::kFusion).repairs_asked = 4;
  SayStatus(Role::kFusion);
  EXPECT_EQ(conductor_.Total(&status_t::repairs_asked), 7);
}

TEST_F(ConductorTest, AwaitsRolesFromElsewhereUntilTheyAreThereAndWhenTheyFallSilent) {
  using testing::ElementsAre;
  using testing::IsEmpty;
  Conductor conductor(script_.bus(), {.run_id = Script::kRunId,
                                      .scenario_text = script_.text(),
                                      .stall_limit = milliseconds(60'000),
                                      .external = {Role::kDriver, Role::kAcc}});
  const TimePoint now = Clock::now();
  EXPECT_THAT(conductor.Awaited(now), ElementsAre(Role::kAcc, Role::kDriver));
  SayStatus(Role::kAcc);
  role(Role::kDriver).state = status_t::WAITING;
  SayStatus(Role::kDriver);
  EXPECT_THAT(conductor.Awaited(now), ElementsAre(Role::kDriver)) << "it has no scenario yet";
  BeAtStep(-1);
  EXPECT_THAT(conductor.Awaited(now), IsEmpty());
  // WHEN none of them is heard for more than a second of the run
  const TimePoint later = Clock::now() + milliseconds(1200);
  PollUntil(conductor, later);
  EXPECT_THAT(conductor.Awaited(later), ElementsAre(Role::kAcc, Role::kDriver));
}

TEST_F(ConductorTest, EndsTheRunWhenTwoLivingProcessesAreOneRole) {
  BeAtStep(-1);
  const status_t first = role(Role::kAcc);
  Replace(Role::kAcc);
  SayStatus(Role::kAcc);
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kRunning) << "the first may be dead";
  // WHEN the first speaks long after the second has come
  const TimePoint end = Clock::now() + milliseconds(120);
  while (Clock::now() < end) Poll(Clock::now());
  role(Role::kAcc) = first;
  SayStatus(Role::kAcc);
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kFailed);
  EXPECT_THAT(conductor_.error(), HasSubstr("two processes are the acc: pid 104 on "));
  EXPECT_THAT(conductor_.error(), HasSubstr(" and pid 1104 on "));
}

TEST_F(ConductorTest, CountsTheProgressOfARoleThatCatchesUp) {
  BeAtStep(-1);
  BeAtStep(40);
  PollUntil(conductor_, Clock::now() + milliseconds(3900));
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kRunning);
  conductor_.Bury(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Replace(Role::kFusion);
  for (const std::int64_t step : {-1, 10, 20}) {
    role(Role::kFusion).header.step = step;
    SayStatus(Role::kFusion);
  }
  PollUntil(conductor_, Clock::now() + milliseconds(3900));
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kRunning);
  EXPECT_EQ(conductor_.step(), 40) << "of the run, not of who catches up";
  PollUntil(conductor_, Clock::now() + milliseconds(4100));
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kFailed);
}

TEST_F(ConductorTest, HoldsAgainstNobodyWhatItHasNotHeardWhileItWasHeldUp) {
  BeAtStep(-1);
  BeAtStep(40);
  const TimePoint again = Clock::now() + milliseconds(5000);
  Poll(again);
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kRunning) << conductor_.error();
  EXPECT_GE(conductor_.TakeAway(), milliseconds(4900));
  EXPECT_EQ(conductor_.TakeAway(), Duration::zero());
  // What is not heard from then on counts.
  for (TimePoint now = again; now < again + milliseconds(3990); now += milliseconds(20)) {
    conductor_.Poll(now);
  }
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kRunning) << conductor_.error();
  conductor_.Poll(again + milliseconds(4010));
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kFailed);
}

TEST_F(ConductorTest, FindsAStallHoweverOftenItIsHeldUpItself) {
  BeAtStep(-1);
  BeAtStep(40);
  // GIVEN a runner that looks for a second, and is held up for 0.6 s, again and again
  const TimePoint began = Clock::now();
  TimePoint now = began;
  Duration looked{};
  while (conductor_.phase() == Conductor::Phase::kRunning && now < began + milliseconds(20'000)) {
    const Duration away =
        looked % milliseconds(1000) == Duration::zero() ? milliseconds(600) : milliseconds(20);
    now += away;
    looked += milliseconds(20);
    conductor_.Poll(now);
  }
  // THEN the four seconds in which it looked count
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kFailed);
  EXPECT_NEAR(std::chrono::duration<double>(now - began).count(), 4 + 4 * 0.6, 0.7);
}

TEST_F(ConductorTest, BlamesForAStallTheFirstWhoDoesNotWaitForSomethingElse) {
  Conductor hasty(script_.bus(), {.run_id = Script::kRunId,
                                  .scenario_text = script_.text(),
                                  .stall_limit = milliseconds(100)});
  BeAtStep(-1);
  hasty.Poll(Clock::now());
  // GIVEN that everybody waits for somebody
  const auto wait = [this](Role who, std::int64_t next, const char* channel, std::int64_t heard) {
    role(who).header.step = next - 1;
    role(who).waiting_for = channel;
    role(who).last_heard_step = heard;
    SayStatus(who);
  };
  wait(Role::kWorld, 8, "HOST_COMMAND", 6);
  wait(Role::kArbitrator, 7, "DRIVER_COMMAND", 6);
  // WHEN it is the driver who lacks what the arbitrator has said before
  wait(Role::kDriver, 7, "HOST_COMMAND", 5);
  hasty.Poll(Clock::now() + milliseconds(150));
  EXPECT_THAT(
      hasty.error(),
      HasSubstr("step 7: driver waits for HOST_COMMAND from arbitrator (last heard: step 5"));
}

TEST_F(ConductorTest, RefusesInRealTimeAStepThatTheClockCannotHaveReached) {
  Conductor conductor(script_.bus(), {.run_id = Script::kRunId,
                                      .scenario_text = script_.text(),
                                      .steps = 500,
                                      .pace = 1,
                                      .realtime = true,
                                      .period = std::chrono::hours(1)});
  const auto say = [&](std::int64_t step) {
    role(Role::kRadar).header.step = step;
    SayStatus(Role::kRadar);
    conductor.Poll(Clock::now());
  };
  BeAtStep(-1);
  say(400);
  EXPECT_EQ(conductor.step(), -1);
  say(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(conductor.step(), -1);
  say(1);
  EXPECT_EQ(conductor.step(), 1);
}

/// A run whose driver is started elsewhere.
class ExternalDriverTest : public ConductorTest {
 protected:
  /// What the run says of who is its driver.
  std::int64_t Holder() {
    PassTime(milliseconds(300));  // it repeats itself in less
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

  Conductor external_{script_.bus(),
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

TEST_F(ConductorTest, SaysWithTheCulpritWhyItCannotBeStartedAgain) {
  Conductor hasty(script_.bus(), {.run_id = Script::kRunId,
                                  .scenario_text = script_.text(),
                                  .stall_limit = milliseconds(100)});
  BeAtStep(-1);
  hasty.Poll(Clock::now());
  hasty.Bury(Role::kWorld, role(Role::kWorld).pid, Clock::now());
  hasty.Hinder(Role::kWorld, "cannot start fogline-world: Resource temporarily unavailable");
  hasty.Poll(Clock::now() + milliseconds(150));
  EXPECT_THAT(hasty.error(), HasSubstr("world is silent"));
  EXPECT_THAT(hasty.error(),
              HasSubstr("; cannot start fogline-world: Resource temporarily unavailable"));
}

TEST_F(ConductorTest, TellsWhatRolesCouldNotSendTheDeadIncluded) {
  role(Role::kFusion).sends_failed = 3;
  role(Role::kFusion).send_error = "Operation not permitted";
  BeAtStep(-1);
  conductor_.Bury(Role::kFusion, role(Role::kFusion).pid, Clock::now());
  Replace(Role::kFusion);
  role(Role::kFusion).sends_failed = 4;
  role(Role::kFusion).send_error = "Network is unreachable";
  SayStatus(Role::kFusion);
  const std::vector<SendTrouble> troubles = conductor_.SendTroubles();
  ASSERT_EQ(troubles.size(), 1U);
  EXPECT_EQ(troubles[0].role, "fusion");
  EXPECT_EQ(troubles[0].count, 7);
  EXPECT_EQ(troubles[0].error, "Network is unreachable");
  conductor_.Fail("the error");
  EXPECT_EQ(conductor_.error(),
            "the error\n  messages that could not be sent: fusion 7 (Network is unreachable)");
}

TEST_F(ConductorTest, CountsWhatItRefusesItself) {
  auto foreign = role(Role::kRadar);
  foreign.header.run_id = Script::kRunId + 1;
  script_.Say(foreign);
  auto nobody = role(Role::kRadar);
  nobody.role = "nobody";
  script_.Say(nobody);
  script_.bus().Publish("STATUS", std::vector<std::uint8_t>(100));
  script_.bus().Publish("RESEND", std::vector<std::uint8_t>(100));
  script_.bus().Publish("RESEND", std::vector<std::uint8_t>(3));
  auto resend = Script::Of<resend_t>(0);
  resend.header.run_id = Script::kRunId + 1;
  script_.Say(resend);
  const auto count = [refused = conductor_.Refused()](std::int64_t status_t::*counter) {
    const auto* kind = std::ranges::find(kRefusals, counter, &RefusalKind::counter);
    return refused[static_cast<std::size_t>(kind - kRefusals.begin())];
  };
  EXPECT_EQ(count(&status_t::foreign), 2);
  EXPECT_EQ(count(&status_t::malformed), 2);
  EXPECT_EQ(count(&status_t::wrong_type), 2);
}

TEST_F(ConductorTest, SaysWithItsErrorWhatIsWrongWithTheKeys) {
  BeAtStep(-1);
  EXPECT_EQ(conductor_.KeyTrouble(), "");
  role(Role::kFusion).badly_signed = 4211;
  SayStatus(Role::kFusion);
  conductor_.Fail("the error");
  EXPECT_EQ(conductor_.error(),
            "the error\n  4211 messages with a wrong signature were refused: do all processes have "
            "the same key?");
}

TEST_F(ConductorTest, EndsOnlyWhenTheRecorderHasToldWhatItHasWrittenOfTheLastStep) {
  std::vector<resend_t>& requests = script_.Listen<resend_t>();
  BeAtStep(-1);
  BeAtStep(40);
  role(Role::kWorld).header.step = 48;
  role(Role::kWorld).state = status_t::DONE;
  SayStatus(Role::kWorld);
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kRunning);
  // WHEN the word of the recorder was lost, THEN it is asked for
  PollUntil(conductor_, Clock::now() + milliseconds(40));
  script_.bus().Drain();
  ASSERT_FALSE(requests.empty());
  EXPECT_EQ(requests.front().channel, "STATUS");
  EXPECT_EQ(requests.front().header.step, 48);
  role(Role::kRecorder).header.step = 48;
  role(Role::kRecorder).log_bytes = 4711;
  SayStatus(Role::kRecorder);
  EXPECT_EQ(conductor_.phase(), Conductor::Phase::kDone);
  // AND what it says when it leaves counts
  role(Role::kRecorder).log_bytes = 4712;
  SayStatus(Role::kRecorder);
  EXPECT_EQ(conductor_.member(Role::kRecorder).status->log_bytes, 4712);
}

TEST_F(ConductorTest, RefusesARoleOfAnotherBuildIfThatIsWanted) {
  RoleBuilds builds;
  builds.fill(4711);
  for (const bool wanted : {false, true}) {
    Conductor conductor(script_.bus(), {.run_id = Script::kRunId,
                                        .scenario_text = script_.text(),
                                        .builds = builds,
                                        .same_build = wanted});
    role(Role::kAcc).build_id = 4711;
    SayStatus(Role::kAcc);
    EXPECT_EQ(conductor.phase(), Conductor::Phase::kJoining) << conductor.error();
    role(Role::kDriver).build_id = 17;
    SayStatus(Role::kDriver);
    EXPECT_EQ(conductor.phase() == Conductor::Phase::kFailed, wanted) << conductor.error();
    if (!wanted) continue;
    EXPECT_THAT(conductor.error(), HasSubstr("driver (pid "));
    EXPECT_THAT(conductor.error(), HasSubstr(" is of build 0000000000000011, that of the runner is "
                                             "0000000000001267 (--same-build)"));
  }
}

TEST_F(ConductorTest, RefusesARoleThatDoesNotSayItsBuildIfTheSameIsWanted) {
  RoleBuilds builds;
  builds.fill(4711);
  Conductor conductor(script_.bus(), {.run_id = Script::kRunId,
                                      .scenario_text = script_.text(),
                                      .builds = builds,
                                      .same_build = true});
  SayStatus(Role::kDriver);
  EXPECT_THAT(conductor.error(), HasSubstr("does not say of which build it is (--same-build)"));
}

}  // namespace
}  // namespace fogline
