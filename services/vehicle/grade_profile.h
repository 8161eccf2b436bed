// Hills: how steep the road is, along its length.
#pragma once

#include <memory>
#include <vector>

#include "scenario/vehicle.h"

namespace fogline {

/// The grade between points in proportion, before the first and after the last as there. No points
/// are a level road. Copies share the points: every car has the road, and none changes it.
class GradeProfile {
 public:
  GradeProfile() = default;

  /// @throw std::invalid_argument that names the point, as a field of the scenario, if positions do
  /// not increase or a number is not finite.
  explicit GradeProfile(std::vector<GradePoint> points);

  /// Rise per horizontal length: tan(theta).
  double GradeAt(double position_m) const;

 private:
  std::shared_ptr<const std::vector<GradePoint>> points_;  // none: a level road
};

}  // namespace fogline
