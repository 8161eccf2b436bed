// Hills: how steep the road is, along its length.
#pragma once

#include <vector>

namespace fogline {

struct GradePoint {
  double position_m = 0;  // along the lane, as truth_t counts
  double grade = 0;       // rise per horizontal length, positive uphill: 0.05 is 5 %
};

/// The grade between points in proportion, before the first and after the last as there. No points
/// are a level road.
class GradeProfile {
 public:
  GradeProfile() = default;

  /// @throw std::invalid_argument if positions do not increase or a number is not finite.
  explicit GradeProfile(std::vector<GradePoint> points);

  /// Rise per horizontal length: tan(theta).
  double GradeAt(double position_m) const;

 private:
  std::vector<GradePoint> points_;
};

}  // namespace fogline
