#include "services/runtime/realtime/realtime_statistics.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/graph.h"
#include "services/runtime/wire/wire.h"

namespace fogline {
namespace {

using std::chrono::microseconds;

constexpr TimePoint kDue{std::chrono::hours(1)};

TEST(RealtimeStatisticsTest, CountsTicksLaterThanFiveMilliseconds) {
  runtime::RealtimeStatistics statistics;
  statistics.Tick(kDue, kDue - milliseconds(20));
  statistics.Tick(kDue, kDue + milliseconds(5));
  EXPECT_EQ(statistics.ticks_late(), 0);
  statistics.Tick(kDue, kDue + milliseconds(5) + Duration(1));
  EXPECT_EQ(statistics.ticks(), 3);
  EXPECT_EQ(statistics.ticks_late(), 1);
}

TEST(RealtimeStatisticsTest, WritesWhatItHasCounted) {
  runtime::RealtimeStatistics statistics;
  for (int us = 1; us <= 100; ++us) {
    statistics.Tick(kDue, kDue + microseconds(us));
    statistics.Latency(microseconds(1000 + us));
  }
  statistics.Tick(kDue, kDue - microseconds(101));
  statistics.Miss();
  status_t status{};
  statistics.Write(status);
  EXPECT_EQ(status.ticks, 101);
  EXPECT_EQ(status.ticks_late, 0);
  EXPECT_EQ(status.deadline_misses, 1);
  EXPECT_EQ(status.jitter_p50_us, 51);
  EXPECT_EQ(status.jitter_p99_us, 100);
  EXPECT_EQ(status.jitter_max_us, 101);
  EXPECT_NEAR(static_cast<double>(status.latency_p50_us), 1050, 1050.0 / 64);
  EXPECT_NEAR(static_cast<double>(status.latency_p99_us), 1099, 1099.0 / 64);
  EXPECT_EQ(status.latency_max_us, 1100);
}

TEST(RealtimeStatisticsTest, ReplacesTheInputs) {
  runtime::InputHealth health(HealthSection(), milliseconds(100), kDue);
  for (int k = 0; k < 5; ++k) health.Arrived(k, kDue + k * milliseconds(100));
  health.Arrived(1, kDue + milliseconds(401));
  const TimePoint now = kDue + milliseconds(600);
  health.Update(now);
  status_t status{};
  for (int repeated = 0; repeated < 2; ++repeated) {
    runtime::ClearInputs(status);
    runtime::WriteInput("RADAR", health, now, status);
  }
  ASSERT_EQ(status.num_inputs, 1);
  EXPECT_EQ(status.input, std::vector<std::string>{"RADAR"});
  EXPECT_EQ(status.input_state, std::vector<std::int8_t>{status_t::INPUT_STALE});
  EXPECT_EQ(status.input_age_us, std::vector<std::int64_t>{200'000});
  EXPECT_NEAR(status.input_rate_hz.at(0), 5 / 0.6, 1e-9);
  EXPECT_EQ(status.input_late, std::vector<std::int64_t>{1});
}

// The recorder is the role with the most inputs, so its STATUS is the longest. In this test the
// texts of the STATUS have their greatest lengths.
TEST(RealtimeStatisticsTest, LeavesRoomInAStatusOfOneDatagram) {
  const runtime::InputHealth health(HealthSection(), milliseconds(100), kDue);
  status_t status{};
  status.role = "arbitrator";
  status.host = std::string(64, 'h');  // HOST_NAME_MAX
  status.scenario_hash = std::string(64, '0');
  status.version = "10.20.30-release-candidate";
  status.waiting_for = "FOLLOWER_COMMAND";
  status.fallback = "the automation drives alone: driver (DRIVER_COMMAND lost)";
  std::int32_t inputs = 0;
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    runtime::WriteInput(kChannels[channel].name, health, kDue, status);
    ++inputs;
  });
  EXPECT_EQ(status.num_inputs, inputs);
  std::vector<std::uint8_t> bytes;
  runtime::Encode(status, bytes);
  RecordProperty("bytes", static_cast<int>(bytes.size()));
  // 200 bytes remain for an error text.
  EXPECT_LE(bytes.size(), runtime::kMaxMessageBytes - 200);
}

}  // namespace
}  // namespace fogline
