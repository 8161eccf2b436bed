// The messages that the fusion reads, and its track, for tests.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include "services/fusion/fusion.h"

namespace fogline::test {

// The messages for a host of constant speed in one step, without noise.
struct Messages {
  ego_t ego{};
  radar_t radar{};
  lidar_t lidar{};
};

inline Messages At(std::int64_t step, double distance_m = 30, double relative_speed_mps = 0) {
  Messages m;
  m.ego.header = {.run_id = 7, .step = step, .utime = step * 100'000};
  m.radar.valid = 1;
  m.radar.range_m = distance_m;
  m.radar.range_rate_mps = relative_speed_mps;
  m.lidar.valid = 1;
  m.lidar.range_m = distance_m;
  return m;
}

inline const track_t& Step(fusion::Fusion& fusion, const Messages& m) {
  return fusion.Step(m.ego, m.radar, m.lidar);
}

// Expects that two tracks have exactly the same state and the same covariance.
inline void ExpectSameEstimate(const track_t& a, const track_t& b) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(a.state[i], b.state[i]) << i;
    for (int j = 0; j < 3; ++j) EXPECT_EQ(a.covariance[i][j], b.covariance[i][j]) << i << j;
  }
}

}  // namespace fogline::test
