#include "services/models/follower/safe_distance.h"

#include <algorithm>
#include <cmath>

namespace fogline::models {
namespace {

double Square(double x) { return x * x; }

// Degree of danger of a distance: 0 from `safe_m` on, 1 below `unsafe_m`, linear between them.
double Membership(double distance_m, double safe_m, double unsafe_m) {
  if (distance_m >= safe_m) return 0.0;
  if (distance_m < unsafe_m) return 1.0;
  return (safe_m - distance_m) / (safe_m - unsafe_m);
}

}  // namespace

double RssSafeDistance(const RssParameters& rss, double speed_mps, double lead_speed_mps) {
  const double rho = rss.response_s;
  const double faster_mps = speed_mps + rho * rss.acceleration_mps2;
  return std::max(0.0, speed_mps * rho + 0.5 * rss.acceleration_mps2 * rho * rho +
                           Square(faster_mps) / (2.0 * rss.least_braking_mps2) -
                           Square(lead_speed_mps) / (2.0 * rss.most_braking_mps2));
}

double ProactiveFuzzy(const FuzzyParameters& fuzzy, const Situation& seen) {
  if (!seen.ahead) return 0.0;
  const double v = seen.speed_mps;
  const double common_m =
      v * fuzzy.response_s - Square(seen.ahead->speed_mps) / (2.0 * fuzzy.lead_braking_mps2);
  const double safe_m =
      common_m + Square(v) / (2.0 * fuzzy.comfortable_braking_mps2) + fuzzy.safe_margin_m;
  const double unsafe_m = common_m + Square(v) / (2.0 * fuzzy.hard_braking_mps2);
  return Membership(seen.ahead->gap_m - fuzzy.standstill_m, safe_m, unsafe_m);
}

double CriticalFuzzy(const FuzzyParameters& fuzzy, const Situation& seen) {
  if (!seen.ahead) return 0.0;
  const double closing_mps = seen.speed_mps - seen.ahead->speed_mps;
  if (closing_mps <= 0.0) return 0.0;
  const double gap_m = seen.ahead->gap_m;
  const double rho = fuzzy.response_s;
  const double a = std::max(seen.acceleration_mps2, -fuzzy.comfortable_braking_mps2);
  const double later_mps = closing_mps + a * rho;
  if (later_mps < 0.0) {
    return gap_m < Square(closing_mps) / (2.0 * std::abs(seen.acceleration_mps2)) ? 1.0 : 0.0;
  }
  const double meanwhile_m = (closing_mps + 0.5 * a * rho) * rho;
  return Membership(gap_m, meanwhile_m + Square(later_mps) / (2.0 * fuzzy.comfortable_braking_mps2),
                    meanwhile_m + Square(later_mps) / (2.0 * fuzzy.hard_braking_mps2));
}

double FuzzyDeceleration(const FuzzyParameters& fuzzy, const Situation& seen) {
  const double critical = CriticalFuzzy(fuzzy, seen);
  const double comfortable = fuzzy.comfortable_braking_mps2;
  if (critical > 0.0) return comfortable + critical * (fuzzy.hard_braking_mps2 - comfortable);
  return comfortable * ProactiveFuzzy(fuzzy, seen);
}

}  // namespace fogline::models
