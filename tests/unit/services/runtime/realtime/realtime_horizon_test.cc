// The range of steps that a role accepts in real time. This range depends on the clock. The role is
// a fusion with a period of 10 ms. The test publishes the inputs of the current step again and
// again.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "services/fusion/fusion.h"
#include "services/recorder/recorder.h"
#include "services/runtime/process/step_node.h"
#include "tests/support/command.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline {
namespace {

using test::Script;

constexpr double kFastSpeed = 10;
constexpr Duration kFastPeriod = milliseconds(10);
// This time is much longer than any wait in these tests, even on a busy machine. The run is ten
// times as fast as the clock, so it advances by 30 s in this time.
constexpr Duration kPatience = milliseconds(3000);

class RealtimeHorizonTest : public testing::Test {
 protected:
  static Scenario Long() {
    Scenario scenario;
    scenario.steps = 100'000;
    return scenario;
  }
  void Join(std::int64_t progress) {
    script_.SayRun(run_t::GO, progress, kFastSpeed);
    began_ = Clock::now();
    first_ = progress + 1;
  }
  /// The current step of the run.
  std::int64_t Now() const { return first_ + (Clock::now() - began_) / kFastPeriod; }
  void Say(std::int64_t step) {
    script_.Say(Script::Of<ego_t>(step));
    script_.Say(Script::Of<radar_t>(step));
    script_.Say(Script::Of<lidar_t>(step));
    script_.Poll(node_);
  }
  /// Publishes the inputs of the current step until the fusion computes a step, or until kPatience.
  /// @return whether the fusion has computed a step
  bool IsComputed() {
    const TimePoint end = Clock::now() + kPatience;
    std::int64_t step = Now();
    const std::int64_t since = step;
    while (Clock::now() < end) {
      Say(step);
      if (!tracks_.empty() && tracks_.back().header.step >= since) return true;
      while (Now() == step) script_.Poll(node_);
      step = Now();
    }
    return false;
  }
  void Pass(int periods) {
    const TimePoint end = Clock::now() + periods * kFastPeriod;
    while (Clock::now() < end) script_.Poll(node_);
  }
  std::int64_t Refused() {
    later_ += milliseconds(300);
    script_.Poll(node_, Clock::now() + later_);
    return status_.back().out_of_window;
  }

  Script script_{Long()};
  std::vector<track_t>& tracks_ = script_.Listen<track_t>();
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  runtime::StepNode<fusion::Fusion> node_{script_.bus(), Script::kRunId};
  TimePoint began_{};
  std::int64_t first_ = 0;
  Duration later_{};
};

TEST_F(RealtimeHorizonTest, WhatWasSentAgainAfterABurstOfLossDoesNotHideWhatIsUnderWay) {
  Join(-1);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(IsComputed());
  Pass(30);
  Say(Now() - 20);
  EXPECT_TRUE(IsComputed());
}

TEST_F(RealtimeHorizonTest, AnOldMessageThatIsHeardFirstDoesNotEither) {
  Join(200);
  Pass(5);
  Say(150);
  EXPECT_TRUE(IsComputed());
}

TEST_F(RealtimeHorizonTest, AStepFarAheadIsRefusedAndChangesNothing) {
  Join(200);
  ASSERT_TRUE(IsComputed());
  const std::int64_t far = Now() + 1000;
  for (const std::int64_t step :
       {far, Long().steps, std::numeric_limits<std::int64_t>::max(),
        std::numeric_limits<std::int64_t>::max() - 1, std::numeric_limits<std::int64_t>::min()}) {
    Say(step);
  }
  EXPECT_EQ(Refused(), 15);
  EXPECT_TRUE(IsComputed());
}

TEST_F(RealtimeHorizonTest, NorIsItTakenByARoleThatHasHeardNothingForLong) {
  Join(200);
  ASSERT_TRUE(IsComputed());
  Pass(20);
  // This step is refused, because it is more than a second ahead of the progress that the runner
  // last reported.
  Say(Now() + 1000);
  EXPECT_EQ(Refused(), 3);
  EXPECT_TRUE(IsComputed());
}

TEST_F(RealtimeHorizonTest,
       ManyMessagesOfStepsThatAreJustPossibleHideForASecondAtMostWhatIsUnderWay) {
  Join(200);
  ASSERT_TRUE(IsComputed());
  // WHEN forged messages claim steps further and further ahead
  for (std::int64_t ahead = 1; ahead < 2000; ++ahead) Say(Now() + ahead);
  // THEN genuine steps are late at first, because the fusion has computed forged steps. The fusion
  // refuses steps that are more than about a second ahead. So after about a second, it goes on with
  // genuine steps
  const TimePoint end = Clock::now() + kPatience;
  bool computed = false;
  for (std::int64_t step = Now(); !computed && Clock::now() < end; step = Now()) {
    const std::size_t before = tracks_.size();
    Say(step);
    computed = tracks_.size() > before;
    while (Now() == step) script_.Poll(node_);
  }
  EXPECT_TRUE(computed);
}

TEST_F(RealtimeHorizonTest, ARunWhoseSpeedIsNoneIsRefused) {
  for (const double speed : {1e-300, 0.0005, 1e300}) script_.SayRun(run_t::GO, -1, speed);
  script_.Poll(node_);
  const auto parts = static_cast<std::int64_t>(runtime::SplitScenario(script_.text()).size());
  ASSERT_FALSE(status_.empty());
  EXPECT_EQ(status_.back().state, status_t::WAITING);
  later_ += milliseconds(300);
  script_.Poll(node_, Clock::now() + later_);
  EXPECT_EQ(status_.back().malformed, 3 * parts);
}

TEST_F(RealtimeHorizonTest, TheRecorderAsksForStepsOfWhichItHasHeardNothingButThatTheyAre) {
  const test::ScratchFolder folder;
  recorder::Recorder recorder(script_.bus(), Script::kRunId, folder.File("log"));
  std::vector<resend_t>& requests = script_.Listen<resend_t>();
  Join(-1);
  ForEachStepChannel([&]<class M>(std::size_t) { script_.Say(Script::Of<M>(0)); });
  Pass(20);
  // WHEN the runner reports that the run has reached step 10
  script_.SayRun(run_t::GO, 10, kFastSpeed);
  // THEN the recorder asks for all missing steps in one request
  const auto asked = [&] {
    return std::ranges::any_of(requests, [](const resend_t& request) {
      return request.channel == ChannelOf<truth_t>().name && request.header.step == 1 &&
             request.count == 10;
    });
  };
  for (const TimePoint end = Clock::now() + kPatience; !asked() && Clock::now() < end;) {
    script_.Poll(recorder);
  }
  EXPECT_TRUE(asked());
}

}  // namespace
}  // namespace fogline
