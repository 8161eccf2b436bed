#include "services/log/realtime_figures.h"

#include <gtest/gtest.h>

#include <limits>

#include "services/log/gaps/log_gaps.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline {
namespace {

using test::kStep_us;

status_t Said(const std::string& role, std::int64_t instance, std::int64_t sequence) {
  status_t status{};
  status.role = role;
  status.instance = instance;
  status.sequence = sequence;
  return status;
}

TEST(RealtimeFiguresTest, AddsUpTheLastStatusOfEachProcess) {
  log::RealtimeAccumulator figures(1, kStep_us, 1000);
  for (const std::int64_t sequence : {1, 3, 2}) {  // message 3 has overtaken message 2
    status_t world = Said("world", 1, sequence);
    world.ticks = 10 * sequence;
    figures.Add(world);
  }
  status_t second = Said("world", 2, 1);
  second.ticks = 7;
  figures.Add(second);
  EXPECT_EQ(figures.Result().ticks, 37);
}

/// A log of ten steps. Some of them lack messages that the radar or the world has published.
class UnloggedMessagesTest : public testing::Test {
 protected:
  void AddSteps(int steps, const runtime::ChannelSet& there) {
    for (int i = 0; i < steps; ++i) figures_.AddStep(there);
  }
  static runtime::ChannelSet AllBut(std::initializer_list<std::size_t> channels) {
    runtime::ChannelSet there;
    there.set();
    for (const std::size_t channel : channels) there.reset(channel);
    return there;
  }
  /// @param step the last step that the radar has completed; 9 is the last step of the log
  void AddRadar(std::int64_t instance, std::int64_t ticks, std::int64_t step = 9) {
    status_t radar = Said("radar", instance, ++sequence_);
    radar.ticks = ticks;
    radar.header.step = step;
    figures_.Add(radar);
  }
  std::string Channels(bool has_all) const {
    return log::NamesOfChannels(figures_.Result(has_all).unlogged_channels);
  }
  std::int64_t sequence_ = 0;
  log::RealtimeAccumulator figures_{1, kStep_us, 10};
};

TEST_F(UnloggedMessagesTest, AreThoseThatTheirProducerHasCountedAndTheLogHasNot) {
  AddSteps(6, AllBut({}));
  AddSteps(4, AllBut({IndexOf<radar_t>()}));
  AddRadar(1, 9);
  EXPECT_EQ(figures_.Result().missed_messages, 4);
  EXPECT_EQ(figures_.Result().unlogged_messages, 3) << "one was never published";
  EXPECT_EQ(log::NamesOfChannels(figures_.Result().unlogged_channels), "RADAR");
}

TEST_F(UnloggedMessagesTest, AreFoundAlthoughTheLastStatusIsOlderThanTheEnd) {
  for (const int steps_before_status : {0, 1, 3}) {
    figures_ = log::RealtimeAccumulator(1, kStep_us, 10);
    AddSteps(3, AllBut({}));
    AddSteps(2, AllBut({IndexOf<radar_t>()}));
    // The STATUS is of step 5, and stands before or after this step in the log.
    AddSteps(steps_before_status, AllBut({}));
    AddRadar(1, 6, 5);
    AddSteps(5 - steps_before_status, AllBut({}));
    EXPECT_EQ(figures_.Result().unlogged_messages, 2) << steps_before_status;
    EXPECT_EQ(Channels(/*has_all=*/true), "RADAR");
  }
}

TEST_F(UnloggedMessagesTest, MayBeMessagesAfterTheLastStatusIfTheLogHasNoSeal) {
  AddSteps(4, AllBut({}));
  AddRadar(1, 5, 5);  // the radar has skipped a step
  AddSteps(1, AllBut({IndexOf<radar_t>()}));
  AddSteps(1, AllBut({}));
  EXPECT_EQ(Channels(/*has_all=*/false), "");
  AddSteps(1, AllBut({IndexOf<radar_t>()}));
  EXPECT_EQ(figures_.Result(false).unlogged_messages, 0);
  EXPECT_EQ(Channels(/*has_all=*/false), "RADAR");
  EXPECT_EQ(Channels(/*has_all=*/true), "");
}

TEST_F(UnloggedMessagesTest, MayBeThoseOfARoleThatWasStartedAgainIfTheLogHasNoSeal) {
  AddSteps(5, AllBut({}));
  AddSteps(1, AllBut({IndexOf<radar_t>()}));
  AddRadar(1, 5, 4);
  AddRadar(2, 1, 5);
  EXPECT_EQ(Channels(/*has_all=*/false), "RADAR");
  EXPECT_EQ(Channels(/*has_all=*/true), "");
}

TEST_F(UnloggedMessagesTest, OfALogThatBeginsLateAreOfNoChannelIfTheyCameBeforeItsFirstTruth) {
  AddSteps(4, {});
  AddSteps(1, AllBut({IndexOf<truth_t>()}));
  AddSteps(5, AllBut({}));
  AddRadar(1, 10);
  const log::RealtimeFigures figures = figures_.Result();
  EXPECT_EQ(figures.unlogged_messages, 5 + 4 + 4) << "TRUTH, HOST_EGO and RADAR";
  EXPECT_EQ(figures.unlogged_channels, runtime::ChannelSet());
}

TEST(RealtimeFiguresTest, AreUnknownWithoutAStatusOfTheWorld) {
  log::RealtimeAccumulator figures(1, kStep_us, 1000);
  figures.Add(Said("radar", 1, 1));
  EXPECT_FALSE(IsKnown("ticks", figures.Result()));
  EXPECT_TRUE(IsKnown("missed_messages", figures.Result()));
  figures.Add(Said("world", 1, 1));
  EXPECT_TRUE(IsKnown("ticks", figures.Result()));
}

TEST_F(UnloggedMessagesTest, AreNotThoseThatCameWhenTheirStepWasWritten) {
  AddSteps(6, AllBut({}));
  AddSteps(4, AllBut({IndexOf<radar_t>()}));
  AddRadar(1, 9);
  status_t recorder = Said("recorder", 1, 1);
  recorder.num_inputs = 1;
  recorder.input = {"RADAR"};
  recorder.input_state = {status_t::INPUT_OK};
  recorder.input_age_us = {0};
  recorder.input_rate_hz = {0};
  recorder.input_late = {2};
  figures_.Add(recorder);
  EXPECT_EQ(figures_.Result().unlogged_messages, 1);
}

TEST_F(UnloggedMessagesTest, CannotBeCountedOfARoleThatWasStartedAgainUnlessItIsTheWorld) {
  AddSteps(6, AllBut({}));
  AddSteps(4, AllBut({IndexOf<radar_t>(), IndexOf<truth_t>()}));
  AddRadar(1, 9);
  AddRadar(2, 5);
  EXPECT_EQ(figures_.Result().unlogged_messages, 4) << "the world leaves no step out";
}

TEST(RealtimeFiguresTest, IgnoresNumbersThatNoProcessCanHaveCounted) {
  constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();
  log::RealtimeAccumulator figures(1, kStep_us, 1000);
  status_t world = Said("world", 1, 1);
  world.ticks = 5;
  world.deadline_misses = 2;
  figures.Add(world);
  for (std::int64_t instance = 2; instance < 5; ++instance) {
    status_t absurd = Said("world", instance, 1);
    absurd.deadline_misses = kHuge;
    figures.Add(absurd);
    absurd = Said("acc", instance, 1);
    absurd.num_inputs = 1;
    absurd.input = {"TRACK"};
    absurd.input_state = {status_t::INPUT_OK};
    absurd.input_age_us = {0};
    absurd.input_rate_hz = {0};
    absurd.input_late = {kHuge};
    figures.Add(absurd);
    absurd = Said("radar", instance, 1);
    absurd.ticks = std::numeric_limits<std::int64_t>::min();
    figures.Add(absurd);
  }
  EXPECT_EQ(figures.Result().ticks, 5);
  EXPECT_EQ(figures.Result().deadline_misses, 2);
  EXPECT_EQ(figures.Result().late_messages, 0);
}

}  // namespace
}  // namespace fogline
