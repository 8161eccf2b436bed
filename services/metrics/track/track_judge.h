// Judges the fused distance by an oracle that knows the true gap.
#pragma once

#include "scenario/sections/scenario.h"
#include "services/metrics/sample.h"

namespace fogline::metrics {

/// Error that the known offsets of both sensors cause in the fused distance in clear air, m:
///
///     e_0 = (b_r/s_r^2 + b_l/s_l^2) / (1/s_r^2 + 1/s_l^2)
///
/// b_r and b_l are the offsets (bias_m) of radar and LiDAR. s_r and s_l are the standard deviations
/// that the filter assumes for their ranges. A steady filter over both ranges has this error
/// exactly. Lateral offsets cause no error, because the filter knows them.
double ErrorOfOffsets(const Scenario& scenario);

/// In clear air, a steady filter measures the distance d + e_0 if the true gap is d. The values d
/// and d + e_0 are the ends of an interval. In a step the track is *wrong* if its fused distance
/// d_fused is outside of this interval by more than the tolerance:
///
///     d_fused - d < min(0, e_0) - tolerance   or   d_fused - d > max(0, e_0) + tolerance
///
/// So the true distance d and the distance d + e_0 of clear air always count as right. The cause of
/// an error does not matter. The cause may be a deceived LiDAR, a filter that has not settled, or a
/// policy that uses only the sensor with the larger offset. A step without a track is not wrong.
class TrackJudge {
 public:
  explicit TrackJudge(const Scenario& scenario);

  bool IsWrong(const Sample& sample) const;

 private:
  double least_error_m_;
  double most_error_m_;
};

}  // namespace fogline::metrics
