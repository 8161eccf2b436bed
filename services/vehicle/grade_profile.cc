#include "services/vehicle/grade_profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace fogline {

GradeProfile::GradeProfile(std::vector<GradePoint> points) : points_(std::move(points)) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const GradePoint& point = points_[i];
    if (!std::isfinite(point.position_m) || !std::isfinite(point.grade)) {
      throw std::invalid_argument("grade profile: a point is not finite");
    }
    if (i > 0 && point.position_m <= points_[i - 1].position_m) {
      throw std::invalid_argument("grade profile: positions do not increase");
    }
  }
}

double GradeProfile::GradeAt(double position_m) const {
  if (points_.empty()) return 0.0;
  const auto after = std::upper_bound(
      points_.begin(), points_.end(), position_m,
      [](double position, const GradePoint& point) { return position < point.position_m; });
  if (after == points_.begin()) return points_.front().grade;
  if (after == points_.end()) return points_.back().grade;
  const GradePoint& before = *(after - 1);
  const double share = (position_m - before.position_m) / (after->position_m - before.position_m);
  return before.grade + share * (after->grade - before.grade);
}

}  // namespace fogline
