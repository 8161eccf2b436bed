// Evidence for the tests of conflict measures.
#pragma once

#include "common/random.h"
#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/disagreement.h"

namespace fogline {

// The standard deviations of the radar and the LiDAR, if a test does not choose others.
inline constexpr double kRadarStd_m = 0.4;
inline constexpr double kLidarStd_m = 0.05;

inline conflict::Disagreement Differing(double difference_m, double radar_std_m = kRadarStd_m,
                                        double lidar_std_m = kLidarStd_m) {
  return {difference_m, radar_std_m, lidar_std_m};
}

// The LiDAR's range is too short by `short_m`. The radar and the prediction are at 0 m, so the
// difference radar - LiDAR is exactly `short_m`, without rounding.
inline conflict::Evidence LidarShortBy(double short_m, double radar_std_m = kRadarStd_m,
                                       double lidar_std_m = kLidarStd_m) {
  return {.radar = {true, 0, radar_std_m},
          .lidar = {true, -short_m, lidar_std_m},
          .prediction = {true, 0, 0.1}};
}

// The radar's range is too long by `long_m`; LiDAR and prediction are at 0 m.
inline conflict::Evidence RadarLongBy(double long_m) {
  return {.radar = {true, long_m, kRadarStd_m},
          .lidar = {true, 0, kLidarStd_m},
          .prediction = {true, 0, 0.1}};
}

inline conflict::Evidence WithoutLidar(conflict::Evidence evidence) {
  evidence.lidar = {};
  return evidence;
}

inline conflict::Evidence WithoutRadar(conflict::Evidence evidence) {
  evidence.radar = {};
  return evidence;
}

// Evidence in which the difference radar - LiDAR, in m, is standard normal plus a shift. The
// variances of both sensors add up to 1 m2.
inline conflict::Evidence UnitNoise(const Random& random, std::int64_t step, double shift_m = 0) {
  return LidarShortBy(random.Normal2(step, 0)[0] + shift_m, 0.6, 0.8);
}

// Arbitrary evidence of sensors. Each value is sometimes missing. Ranges are up to 250 m and may be
// equal; standard deviations may be 0.
inline conflict::Evidence Anything(const Random& random, std::int64_t step) {
  const auto [where, near] = random.Uniform2(step, 0);
  const auto range = [&, place = where * 250, close = near < 0.7](std::uint32_t index) {
    const auto [there, deviation] = random.Uniform2(step, index);
    const auto [error, elsewhere] = random.Uniform2(step, index + 1);
    const double std_m = deviation < 0.05 ? 0 : 3 * deviation * deviation;
    const double range_m = close ? place + 4 * std_m * (error - 0.5) : 250 * elsewhere;
    return conflict::StatedRange{there > 0.1, range_m, std_m};
  };
  return {.radar = range(1), .lidar = range(3), .prediction = range(5)};
}

}  // namespace fogline
