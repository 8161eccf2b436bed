#include "services/runtime/lockstep/step_gate.h"

#include <gtest/gtest.h>

#include "tests/unit/services/runtime/script.h"

namespace fogline {
namespace {

using test::Script;

class StepGateTest : public testing::Test {
 protected:
  StepGateTest() { gate_.Configure(Scenario{}, Script::kRunId); }

  void Go(double pace, std::int64_t progress) {
    run_t run{};
    run.pace = pace;
    run.progress = progress;
    gate_.OnGo(run, now_);
  }
  void Recorded(std::int64_t step, std::int8_t state = status_t::RUNNING) {
    auto status = Script::Of<status_t>(step);
    status.role = "recorder";
    status.state = state;
    script_.Say(status);
  }

  const TimePoint now_ = Clock::now();
  Script script_;
  status_t own_{};
  runtime::StepGate gate_{script_.bus(), own_};
};

TEST_F(StepGateTest, IsClosedUntilTheRunnerSaysGo) {
  EXPECT_FALSE(gate_.Open(0, now_));
  Go(0, -1);
  EXPECT_TRUE(gate_.Open(0, now_));
}

TEST_F(StepGateTest, LetsTheWorldRunOnlySoFarAheadOfWhatIsOnDisk) {
  Go(0, -1);
  EXPECT_TRUE(gate_.Open(runtime::kMaxAhead - 1, now_));
  EXPECT_FALSE(gate_.Open(runtime::kMaxAhead, now_));
  own_.header.step = runtime::kMaxAhead - 1;
  Recorded(10);
  EXPECT_TRUE(gate_.Open(runtime::kMaxAhead + 10, now_));
  EXPECT_FALSE(gate_.Open(runtime::kMaxAhead + 11, now_));
}

TEST_F(StepGateTest, DoesNotBelieveThatAStepIsOnDiskBeforeItHasBegun) {
  Go(0, -1);
  own_.header.step = 5;
  Recorded(6);
  EXPECT_FALSE(gate_.Open(runtime::kMaxAhead, now_));
  EXPECT_EQ(own_.out_of_window, 1);
  // The gate accepts the recorder's report of step 6 if the runner says that the run has reached
  // step 6. An earlier process of the world has then begun this step.
  Go(0, 6);
  Recorded(6);
  EXPECT_TRUE(gate_.Open(runtime::kMaxAhead + 6, now_));
}

TEST_F(StepGateTest, OpensForNoStepAfterTheFinalOne) {
  Go(0, -1);
  gate_.SetFinal(5);
  EXPECT_TRUE(gate_.Open(5, now_));
  EXPECT_FALSE(gate_.Open(6, now_));
  EXPECT_FALSE(gate_.Finished(6)) << "it is not on disk yet";
  own_.header.step = 5;
  Recorded(5);
  EXPECT_TRUE(gate_.Finished(6));
  EXPECT_FALSE(gate_.Open(6, now_));
}

TEST_F(StepGateTest, AsksForTheRecordersStepAtIntervalsThatDoubleUpToHalfASecond) {
  Go(0, -1);
  std::vector<std::int64_t> asked_ms;
  for (std::int64_t ms = 0; ms <= 2200; ++ms) {
    const auto step = gate_.WantsRecorded(runtime::kMaxAhead + 3, now_ + milliseconds(ms));
    if (!step) continue;
    EXPECT_EQ(*step, 3);
    asked_ms.push_back(ms);
  }
  EXPECT_EQ(asked_ms, (std::vector<std::int64_t>{20, 60, 140, 300, 620, 1120, 1620, 2120}));
}

TEST_F(StepGateTest, DoesNotTakeTheWordOfARecorderThatHasFailed) {
  Go(0, -1);
  Recorded(10, status_t::FAILED);
  EXPECT_FALSE(gate_.Open(runtime::kMaxAhead, now_));
}

TEST_F(StepGateTest, CountsWhatIsNoStatusOfItsRun) {
  auto status = Script::Of<status_t>(1000);
  status.role = "recorder";
  status.header.run_id = Script::kRunId + 1;
  script_.Say(status);
  script_.bus().Publish("STATUS", std::vector<std::uint8_t>(100));
  script_.bus().Drain();
  EXPECT_EQ(own_.foreign, 1);
  EXPECT_EQ(own_.wrong_type, 1);
  Go(0, -1);
  EXPECT_FALSE(gate_.Open(runtime::kMaxAhead, now_));
}

TEST_F(StepGateTest, HoldsTheWorldToThePace) {
  Go(1, -1);
  EXPECT_TRUE(gate_.Open(0, now_));
  EXPECT_FALSE(gate_.Open(10, now_));
  EXPECT_TRUE(gate_.Open(10, now_ + milliseconds(1000)));
}

TEST_F(StepGateTest, LetsAWorldThatJoinsLateCatchUpAtOnceAndHoldsItToThePaceFromThere) {
  Go(1, 100);
  Recorded(100);
  EXPECT_TRUE(gate_.Open(100, now_));
  EXPECT_FALSE(gate_.Open(110, now_));
  EXPECT_TRUE(gate_.Open(110, now_ + milliseconds(1000)));
}

}  // namespace
}  // namespace fogline
