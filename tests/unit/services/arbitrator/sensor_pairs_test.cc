#include "services/arbitrator/sensor_pairs.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr HealthSection kSection{.stale_periods = 1.5, .lost_periods = 2.5, .recover_steps = 3};

radar_t Radar(std::int64_t step) {
  radar_t radar{};
  radar.header.step = step;
  radar.range_m = 100 + static_cast<double>(step);
  return radar;
}

lidar_t Lidar(std::int64_t step) {
  lidar_t lidar{};
  lidar.header.step = step;
  lidar.range_m = 200 + static_cast<double>(step);
  return lidar;
}

class SensorPairsTest : public testing::Test {
 protected:
  // Updates the pairs at `step`. The newest messages are of the steps `radar_step` and
  // `lidar_step`; -1 means that no message has come. @return the state of the pair
  InputState At(std::int64_t step, std::int64_t radar_step, std::int64_t lidar_step) {
    const radar_t radar = Radar(radar_step);
    const lidar_t lidar = Lidar(lidar_step);
    return pairs_.Update(step, radar_step < 0 ? nullptr : &radar,
                         lidar_step < 0 ? nullptr : &lidar);
  }
  void ExpectPair(std::int64_t step) {
    ASSERT_TRUE(pairs_.has_pair());
    EXPECT_EQ(pairs_.radar().header.step, step);
    EXPECT_EQ(pairs_.lidar().header.step, step);
    EXPECT_EQ(pairs_.radar().range_m, Radar(step).range_m);
    EXPECT_EQ(pairs_.lidar().range_m, Lidar(step).range_m);
  }

  arbitrator::SensorPairs pairs_{kSection};
};

TEST_F(SensorPairsTest, PairsTheMessagesOfTheStep) {
  for (std::int64_t k = 0; k < 10; ++k) {
    EXPECT_EQ(At(k, k, k), InputState::kOk);
    ExpectPair(k);
  }
}

TEST_F(SensorPairsTest, HoldsTheLastPairWhileOneIsMissing) {
  At(0, 0, 0);
  EXPECT_EQ(At(1, 1, 0), InputState::kOk);
  ExpectPair(0);
  EXPECT_EQ(At(2, 2, 0), InputState::kStale);
  ExpectPair(0);
}

TEST(SensorPairsLimitTest, APairOfExactlyTheStaleAgeIsInTime) {
  arbitrator::SensorPairs pairs({.stale_periods = 2, .lost_periods = 4, .recover_steps = 3});
  const radar_t radar = Radar(0);
  const lidar_t lidar = Lidar(0);
  EXPECT_EQ(pairs.Update(0, &radar, &lidar), InputState::kOk);
  EXPECT_EQ(pairs.Update(2, &radar, &lidar), InputState::kOk);
  EXPECT_EQ(pairs.Update(3, &radar, &lidar), InputState::kStale);
}

TEST_F(SensorPairsTest, PairsASensorThatIsAlwaysAStepBehindWithItsOwnStep) {
  At(0, 0, -1);
  for (std::int64_t k = 1; k < 10; ++k) {
    EXPECT_EQ(At(k, k, k - 1), InputState::kOk);
    ExpectPair(k - 1);
  }
}

TEST_F(SensorPairsTest, IsLostWhenTheSensorsAreTooFarApartAlthoughBothComeInTime) {
  for (std::int64_t k = 0; k < 3; ++k) At(k, k, k);
  for (std::int64_t k = 3; k < 5; ++k) At(k, k, 2);
  for (std::int64_t k = 5; k < 20; ++k) EXPECT_EQ(At(k, k, k - 4), InputState::kLost) << k;
}

TEST_F(SensorPairsTest, IsAwaitedAtFirstWhateverTheStepAndThenLost) {
  EXPECT_EQ(At(700, -1, 700), InputState::kAwaited);
  EXPECT_FALSE(pairs_.has_pair());
  EXPECT_EQ(At(701, -1, 701), InputState::kAwaited);
  EXPECT_EQ(At(702, -1, 702), InputState::kLost);
}

TEST_F(SensorPairsTest, IsOkAgainAfterStepsInTimeOneAfterTheOther) {
  At(0, 0, 0);
  EXPECT_EQ(At(9, 9, 8), InputState::kLost);
  EXPECT_EQ(At(10, 10, 10), InputState::kLost);
  EXPECT_EQ(At(11, 11, 11), InputState::kLost);
  EXPECT_EQ(At(12, 12, 12), InputState::kOk);
}

}  // namespace
}  // namespace fogline
