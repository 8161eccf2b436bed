// The times at which the roles of a run in real time compute, and the inputs that they use.
// Messages arrive without delay. Poll() gets the time as its argument. A period is so long that the
// duration of the test itself does not matter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "services/arbitrator/arbitrator.h"
#include "services/arbitrator/failsafe_arbitrator.h"
#include "services/fusion/fusion.h"
#include "services/recorder/recorder.h"
#include "services/runtime/process/step_node.h"
#include "services/world/failsafe_world.h"
#include "services/world/world.h"
#include "tests/support/command.h"
#include "tests/unit/services/runtime/realtime/run_times.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline {
namespace {

using test::Script;
using testing::ElementsAre;

class RealtimeRulesTest : public testing::Test {
 protected:
  explicit RealtimeRulesTest(const Scenario& scenario = {}) : script_(scenario) {
    // This handler is called just before the role's own handler of RUN, which begins the role's
    // run.
    script_.bus().Subscribe(ChannelOf<run_t>().name,
                            [this](runtime::Bytes) { run_at_ = Clock::now(); });
  }

  void Go() {
    script_.SayRun(run_t::GO, -1, kSlowSpeed);
    // The role takes the time of GO shortly after `run_at_`. The added 5 ms are longer than this
    // delay, so at the time At(n) tick n has come.
    go_ = run_at_ + milliseconds(5);
  }
  /// The time `periods` periods after GO.
  TimePoint At(double periods) const {
    return go_ + duration_cast<Duration>(periods * kSlowPeriod);
  }
  template <class... M>
  void Say(std::int64_t step) {
    (script_.Say(Script::Of<M>(step)), ...);
  }
  template <class M>
  static std::vector<std::int64_t> StepsOf(const std::vector<M>& messages) {
    std::vector<std::int64_t> steps;
    for (const M& message : messages) steps.push_back(message.header.step);
    return steps;
  }
  /// The role's STATUS one heartbeat later.
  const status_t& Status(runtime::Work& role) {
    later_ += milliseconds(201);
    script_.PollUpTo(role, Clock::now() + later_);
    return status_.back();
  }

  Script script_;
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  std::vector<resend_t>& requests_ = script_.Listen<resend_t>();
  TimePoint run_at_{};  // when the last RUN came
  TimePoint go_{};
  Duration later_{};
};

// ---- RealtimeRule: fusion needs all of its inputs ----------------------------------------------

class RealtimeRuleTest : public RealtimeRulesTest {
 protected:
  RealtimeRuleTest() { Go(); }
  std::vector<track_t>& tracks_ = script_.Listen<track_t>();
  runtime::StepNode<fusion::Fusion> node_{script_.bus(), Script::kRunId};
};

TEST_F(RealtimeRuleTest, LeavesOutAStepThatLacksAnInputAndAsksForNothing) {
  Say<ego_t, radar_t, lidar_t>(0);
  script_.PollUpTo(node_);
  Say<ego_t, lidar_t>(1);
  script_.PollUpTo(node_);
  Say<ego_t, radar_t, lidar_t>(2);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(tracks_), ElementsAre(0, 2));
  EXPECT_EQ(Status(node_).deadline_misses, 1);
  EXPECT_TRUE(std::ranges::none_of(requests_, [](const resend_t& request) {
    return request.channel == ChannelOf<radar_t>().name;
  }));
}

TEST_F(RealtimeRuleTest, ComputesInOrderEveryStepThatIsThereWhenItWasHeldUp) {
  script_.SayRun(run_t::GO, 3, kSlowSpeed);  // the run has reached step 3
  for (std::int64_t step = 0; step < 4; ++step) Say<ego_t, radar_t, lidar_t>(step);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(tracks_), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(Status(node_).deadline_misses, 0);
}

TEST_F(RealtimeRuleTest, CountsWhatComesTooLateAndNeverUsesIt) {
  Say<ego_t, radar_t, lidar_t>(0);
  Say<ego_t, lidar_t>(1);
  Say<ego_t, radar_t, lidar_t>(2);
  script_.PollUpTo(node_);
  Say<radar_t>(1);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(tracks_), ElementsAre(0, 2));
  const status_t& status = Status(node_);
  const auto radar = std::ranges::find(status.input, ChannelOf<radar_t>().name);
  ASSERT_NE(radar, status.input.end());
  EXPECT_EQ(status.input_late.at(static_cast<std::size_t>(radar - status.input.begin())), 1);
}

TEST_F(RealtimeRuleTest, BlamesTheWorldAloneForItsPause) {
  Say<ego_t, radar_t, lidar_t>(0);
  script_.PollUpTo(node_);
  script_.PollUpTo(node_, At(3));
  const status_t& status = status_.back();
  for (std::size_t i = 0; i < status.input.size(); ++i) {
    const bool from_world = status.input[i] == ChannelOf<ego_t>().name;
    EXPECT_EQ(status.input_state[i], from_world ? status_t::INPUT_LOST : status_t::INPUT_OK)
        << status.input[i];
  }
  EXPECT_EQ(status.waiting_for, ChannelOf<ego_t>().name);
}

TEST_F(RealtimeRuleTest, BlamesNoRoleForItsOwnPause) {
  Say<ego_t, radar_t, lidar_t>(0);
  script_.PollUpTo(node_);
  script_.Poll(node_, At(4));
  const status_t& status = Status(node_);
  for (std::size_t i = 0; i < status.input.size(); ++i) {
    EXPECT_EQ(status.input_state[i], status_t::INPUT_OK) << status.input[i];
  }
}

// ---- DeadlineRule: the arbitrator decides in every step ----------------------------------------

// With these limits, an input that never came is LOST before the run's clock stops. The clock stops
// 1.25 periods after the last tick.
Scenario Impatient() {
  Scenario scenario;
  scenario.health.stale_periods = 1.1;
  scenario.health.lost_periods = 1.15;
  return scenario;
}

class DeadlineRuleTest : public RealtimeRulesTest {
 protected:
  DeadlineRuleTest() : RealtimeRulesTest(Impatient()) {
    Go();
    // The deadline of a step counts from the step's tick. On a busy machine the tick may be far
    // behind GO. So At() counts from the last tick.
    script_.bus().Subscribe(ChannelOf<ego_t>().name,
                            [this](runtime::Bytes) { go_ = Clock::now(); });
  }
  std::vector<arbitration_t>& commands_ = script_.Listen<arbitration_t>();
  runtime::StepNode<arbitrator::Arbitrator, arbitrator::FailsafeArbitrator> node_{script_.bus(),
                                                                                  Script::kRunId};
};

TEST_F(DeadlineRuleTest, DecidesAtOnceWhenEverythingIsThere) {
  Say<ego_t, radar_t, lidar_t, track_t, accel_command_t, driver_command_t>(0);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(commands_), ElementsAre(0));
  EXPECT_EQ(Status(node_).deadline_misses, 0);
}

TEST_F(DeadlineRuleTest, WaitsUntilTheDeadlineForWhatIsMissingAndNoLonger) {
  Say<ego_t, radar_t, lidar_t, track_t, accel_command_t>(0);
  script_.PollUpTo(node_);
  script_.PollUpTo(node_, At(0.45));
  EXPECT_THAT(StepsOf(commands_), ElementsAre());
  script_.PollUpTo(node_, At(0.55));
  EXPECT_THAT(StepsOf(commands_), ElementsAre(0));
  EXPECT_EQ(Status(node_).deadline_misses, 1);
}

TEST_F(DeadlineRuleTest, DecidesNothingWithoutATick) {
  Say<radar_t, lidar_t, track_t, accel_command_t, driver_command_t>(0);
  script_.PollUpTo(node_, At(4));
  EXPECT_THAT(StepsOf(commands_), ElementsAre());
}

TEST_F(DeadlineRuleTest, DecidesAtOnceEveryStepWhoseSuccessorHasBegun) {
  Say<ego_t>(0);
  Say<ego_t>(1);
  Say<ego_t>(2);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(commands_), ElementsAre(0, 1));
  script_.PollUpTo(node_, At(0.55));
  EXPECT_THAT(StepsOf(commands_), ElementsAre(0, 1, 2));
}

TEST_F(DeadlineRuleTest, WaitsNotForWhatIsLostButForWhatComesAgain) {
  // GIVEN a driver whose input is LOST
  Say<ego_t, radar_t, lidar_t, track_t, accel_command_t>(0);
  script_.PollUpTo(node_, At(1.22));
  // THEN the arbitrator decides the next step without waiting for the driver
  Say<ego_t, radar_t, lidar_t, track_t, accel_command_t>(1);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(commands_), ElementsAre(0, 1));
  // WHEN the driver sends again, too late for step 1
  Say<driver_command_t>(1);
  // THEN the arbitrator waits for the driver in step 2
  Say<ego_t, radar_t, lidar_t, track_t, accel_command_t>(2);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(commands_), ElementsAre(0, 1));
  Say<driver_command_t>(2);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(commands_), ElementsAre(0, 1, 2));
}

TEST_F(DeadlineRuleTest, StopsTheHostIfNoOtherInputEverComes) {
  // All other inputs are LOST before a message of them has come.
  for (std::int64_t step = 0; step < 3; ++step) {
    Say<ego_t>(step);
    script_.PollUpTo(node_, At(1.22));
  }
  ASSERT_FALSE(commands_.empty());
  EXPECT_EQ(commands_.back().mode, arbitration_t::MINIMAL_RISK);
}

// ---- TickRule: the world begins the steps ------------------------------------------------------

class TickRuleTest : public RealtimeRulesTest {
 protected:
  std::vector<truth_t>& truths_ = script_.Listen<truth_t>();
  runtime::StepNode<world::World, world::FailsafeWorld> node_{script_.bus(), Script::kRunId};
};

TEST_F(TickRuleTest, BeginsAStepAtEachTickOfTheClockWithoutWaiting) {
  script_.SayRun(run_t::PREPARE, -1, kSlowSpeed);
  script_.PollUpTo(node_);
  EXPECT_THAT(StepsOf(truths_), ElementsAre());
  Go();
  script_.PollUpTo(node_, At(0));
  script_.PollUpTo(node_, At(0.9));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0));
  script_.PollUpTo(node_, At(1));
  script_.PollUpTo(node_, At(2.01));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1, 2));
  EXPECT_EQ(Status(node_).deadline_misses, 2) << "no command came";
}

TEST_F(TickRuleTest, MakesUpForNoTickOfAPauseAndLeavesNoneOutThatIsHardlyOver) {
  Go();
  script_.PollUpTo(node_, At(0));
  Say<arbitration_t, follower_command_t>(0);
  // GIVEN a world that wakes a little after tick 3
  script_.Poll(node_, At(3.05));
  script_.PollUpTo(node_, At(3.06));
  // THEN ticks 1 and 2 are missed, and the world begins the next step immediately
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1));
  EXPECT_EQ(Status(node_).ticks_missed, 2);
  // AND the times of the ticks have not changed
  script_.PollUpTo(node_, At(3.95));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1));
  script_.PollUpTo(node_, At(4.01));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1, 2));
}

TEST_F(TickRuleTest, LetsTheOthersFinishTheStepInWhichTheMachineStoodStill) {
  Go();
  script_.PollUpTo(node_, At(0));
  // GIVEN a world that wakes just before tick 3, when no role has answered yet
  script_.Poll(node_, At(2.98));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0));
  // WHEN the other roles answer THEN step 1 begins immediately. Tick 3 begins no step, because it
  // comes too soon after the beginning of step 1.
  Say<arbitration_t, follower_command_t>(0);
  script_.PollUpTo(node_, At(2.99));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1));
  script_.PollUpTo(node_, At(3.5));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1));
  script_.PollUpTo(node_, At(4.01));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1, 2));
  EXPECT_EQ(Status(node_).ticks_missed, 2) << "tick 1, in the pause, and tick 3";
}

TEST_F(TickRuleTest, WaitsForNoRoleForLong) {
  Go();
  script_.PollUpTo(node_, At(0));
  script_.Poll(node_, At(1.5));
  script_.PollUpTo(node_, At(1.51));
  EXPECT_THAT(StepsOf(truths_), ElementsAre(0, 1));
}

TEST_F(TickRuleTest, StopsTheCarsIfTheirCommandsNeverCome) {
  Go();
  for (int tick = 0; tick <= 6; ++tick) script_.PollUpTo(node_, At(tick + 0.01));
  EXPECT_LT(truths_.back().host_acceleration_mps2, 0);
  EXPECT_LT(truths_.back().follower_acceleration_mps2.at(0), 0);
  EXPECT_EQ(Status(node_).minimal_risk, status_t::HOST | status_t::FOLLOWER);
}

TEST_F(TickRuleTest, CountsTheLatencyAlsoOfACommandThatComesTooLate) {
  Go();
  script_.PollUpTo(node_, At(0));
  script_.PollUpTo(node_, At(1));
  Say<arbitration_t>(0);
  const status_t& status = Status(node_);
  EXPECT_GT(status.latency_max_us, 0);
  const auto host = std::ranges::find(status.input, ChannelOf<arbitration_t>().name);
  ASSERT_NE(host, status.input.end());
  EXPECT_EQ(status.input_late.at(static_cast<std::size_t>(host - status.input.begin())), 1);
}

// ---- RecordRule --------------------------------------------------------------------------------

class RecordRuleTest : public RealtimeRulesTest {
 protected:
  std::ptrdiff_t AskedFor(std::string_view channel) const {
    return std::ranges::count(requests_, channel, &resend_t::channel);
  }
  test::ScratchFolder folder_;
  recorder::Recorder recorder_{script_.bus(), Script::kRunId, folder_.File("log")};
};

TEST_F(RecordRuleTest, AsksForWhatIsMissingWhileThereIsHopeAndThenGoesOnWithoutIt) {
  Go();
  // GIVEN a step that has only TRUTH, and a complete step
  Say<truth_t>(0);
  ForEachStepChannel([&]<class M>(std::size_t) { Say<M>(1); });
  script_.PollUpTo(recorder_, At(1.4));
  EXPECT_EQ(AskedFor(ChannelOf<radar_t>().name), 0) << "it may be on its way";
  for (int k = 0; k < 20; ++k) {
    script_.PollUpTo(recorder_, At(1.6) + k * milliseconds(21));
  }
  EXPECT_EQ(AskedFor(ChannelOf<radar_t>().name), 4);
  EXPECT_EQ(AskedFor(ChannelOf<truth_t>().name), 0) << "it is there";
  EXPECT_EQ(Status(recorder_).header.step, 1);
}

TEST_F(RecordRuleTest, CountsAsLateOnlyWhatItHasNotWrittenAndThatOnce) {
  Go();
  const auto late = [this] {
    const status_t& status = Status(recorder_);
    const auto radar = std::ranges::find(status.input, ChannelOf<radar_t>().name);
    return status.input_late.at(static_cast<std::size_t>(radar - status.input.begin()));
  };
  // GIVEN a RADAR message of step 0 that comes only after all messages of step 1
  const auto say_all_but_radar = [this](std::int64_t step) {
    ForEachStepChannel([&]<class M>(std::size_t) {
      if constexpr (!std::is_same_v<M, radar_t>) Say<M>(step);
    });
  };
  say_all_but_radar(0);
  say_all_but_radar(1);
  Say<radar_t>(1);
  script_.PollUpTo(recorder_);
  Say<radar_t>(0);
  script_.PollUpTo(recorder_);
  EXPECT_EQ(late(), 0) << "it is in the log";
  // WHEN the RADAR message of step 0 comes again, with other contents
  auto other = Script::Of<radar_t>(0);
  other.range_m = 17;
  script_.Say(other);
  EXPECT_EQ(late(), 0) << "the one of the log is there";
  // WHEN the recorder no longer waits for the RADAR message of step 2, and this message then comes
  // twice
  say_all_but_radar(2);
  say_all_but_radar(3);
  Say<radar_t>(3);
  for (int k = 0; k < 20; ++k) script_.PollUpTo(recorder_, At(1.6) + k * milliseconds(21));
  Say<radar_t>(2);
  Say<radar_t>(2);
  EXPECT_EQ(late(), 1);
}

TEST_F(RecordRuleTest, WritesAtOnceWhatIsComplete) {
  Go();
  for (std::int64_t step = 0; step < 3; ++step) {
    ForEachStepChannel([&]<class M>(std::size_t) { Say<M>(step); });
  }
  script_.PollUpTo(recorder_);
  EXPECT_EQ(Status(recorder_).header.step, 2);
  EXPECT_EQ(AskedFor(ChannelOf<radar_t>().name), 0);
}

}  // namespace
}  // namespace fogline
