// Hills: the grade of the road along its length.
#pragma once

#include <memory>
#include <vector>

#include "scenario/sections/vehicle.h"

namespace fogline::models {

/// The grade of the road at each position. Between points the grade is interpolated linearly.
/// Before the first point and after the last point, the grade is constant. Without points the road
/// is level. Copies share the points, which never change.
class GradeProfile {
 public:
  GradeProfile() = default;

  /// @throw std::invalid_argument if positions do not increase or a number is not finite; the error
  ///     text names the point as a field of the scenario
  explicit GradeProfile(std::vector<GradePoint> points);

  /// Rise per horizontal length: tan(theta).
  double GradeAt(double position_m) const;

 private:
  std::shared_ptr<const std::vector<GradePoint>> points_;  // null for a level road
};

}  // namespace fogline::models
