#include "services/models/vehicle/grade_profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace fogline::models {

GradeProfile::GradeProfile(std::vector<GradePoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const GradePoint& point = points[i];
    if (!std::isfinite(point.position_m) || !std::isfinite(point.grade)) {
      throw std::invalid_argument(fmt::format("/road/grade/{}: a number is not finite", i));
    }
    if (i > 0 && point.position_m <= points[i - 1].position_m) {
      throw std::invalid_argument(
          fmt::format("/road/grade/{}/position_m: {} m does not come after {} m, the place before "
                      "it; places must increase",
                      i, point.position_m, points[i - 1].position_m));
    }
  }
  if (points.empty()) return;
  points_ = std::make_shared<const std::vector<GradePoint>>(std::move(points));
}

double GradeProfile::GradeAt(double position_m) const {
  if (!points_) return 0.0;
  const std::vector<GradePoint>& points = *points_;
  const auto after = std::upper_bound(
      points.begin(), points.end(), position_m,
      [](double position, const GradePoint& point) { return position < point.position_m; });
  if (after == points.begin()) return points.front().grade;
  if (after == points.end()) return points.back().grade;
  const GradePoint& before = *(after - 1);
  const double share = (position_m - before.position_m) / (after->position_m - before.position_m);
  return before.grade + share * (after->grade - before.grade);
}

}  // namespace fogline::models
