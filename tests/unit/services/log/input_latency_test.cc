#include "services/log/input_latency.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

driver_input_t Input(std::int64_t time_us, std::int64_t latency_us, std::int64_t instance = 7) {
  driver_input_t input{};
  input.instance = instance;
  input.time_us = time_us;
  input.latency_us = latency_us;
  return input;
}

TEST(InputLatencyTest, HasTheQuantilesOfTheMeasurements) {
  log::InputLatencyAccumulator accumulator;
  for (std::int64_t k = 1; k <= 100; ++k) accumulator.Add(Input(1000 * k, k));
  const log::InputLatency latency = accumulator.Result();
  EXPECT_EQ(latency.inputs, 100);
  EXPECT_EQ(latency.p50_us, 50);
  EXPECT_EQ(latency.p95_us, 95);
  EXPECT_EQ(latency.max_us, 100);
}

TEST(InputLatencyTest, CountsARepeatedMeasurementOnce) {
  log::InputLatencyAccumulator accumulator;
  accumulator.Add(Input(1000, 20));
  for (int repeated = 0; repeated < 10; ++repeated) accumulator.Add(Input(1000, 90));
  accumulator.Add(Input(2000, 20));
  const log::InputLatency latency = accumulator.Result();
  EXPECT_EQ(latency.inputs, 3);
  EXPECT_EQ(latency.max_us, 90);
}

// The page reports the age of an input. The seat subtracts this age from the time at which the
// page's frame came. So if the page repeats an input, the times that the seat computes for it
// differ a little.
TEST(InputLatencyTest, CountsAMeasurementOnceAlthoughTheTimesOfAnInputJitter) {
  log::InputLatencyAccumulator accumulator;
  accumulator.Add(Input(1000, 20));
  for (const int jitter_us : {7, -3, 11, -9}) accumulator.Add(Input(1000 + jitter_us, -1));
  accumulator.Add(Input(2000, 30));
  const log::InputLatency latency = accumulator.Result();
  EXPECT_EQ(latency.inputs, 2);
  EXPECT_EQ(latency.p50_us, 20);
}

TEST(InputLatencyTest, LeavesOutInputsWithoutAMeasurement) {
  log::InputLatencyAccumulator accumulator;
  accumulator.Add(Input(1000, -1));
  EXPECT_EQ(accumulator.Result().inputs, 0);
  EXPECT_EQ(accumulator.Result().max_us, 0);
  accumulator.Add(Input(2000, 30));
  EXPECT_EQ(accumulator.Result().inputs, 1);
}

TEST(InputLatencyTest, TakesEqualTimesOfTwoSeatsForTwoInputs) {
  log::InputLatencyAccumulator accumulator;
  accumulator.Add(Input(1000, 20, 7));
  accumulator.Add(Input(1000, 30, 8));
  EXPECT_EQ(accumulator.Result().inputs, 2);
}

}  // namespace
}  // namespace fogline
