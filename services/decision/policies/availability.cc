#include "services/decision/policies/availability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/host_modes.h"
#include "services/models/driver/take_over_time.h"

namespace fogline::policies {
namespace {

constexpr double kPercentile = 0.95;  // percentile of take-over times, after Marberger et al. 2018

}  // namespace

// c is the limit of the deceleration; availability.h explains the other symbols. The equation
//
//     (w + b t)^2 = 2 c (s - w t - b t^2/2)
//
// has the form A t^2 + B t + C = 0. The code below computes A, B and C. The discriminant
//
//     B^2 - 4 A C = 4 c (b + c)(w^2 + 2 b s)
//
// is above 0 if the gap s and the host's braking b are above 0. So the time is always finite if the
// host brakes. The result is the larger root. If the host is faster (w < 0), the follower does not
// have to brake before the speeds are equal. The larger root comes after this moment.
double TimeUntilHardBraking(double gap_m, double closing_mps, double host_braking_mps2,
                            double limit_mps2) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double now = closing_mps * closing_mps - 2 * limit_mps2 * gap_m;  // C
  if (gap_m <= 0 || (closing_mps > 0 && now >= 0)) return 0;
  const double growth = 2 * closing_mps * (host_braking_mps2 + limit_mps2);       // B
  const double curvature = host_braking_mps2 * (host_braking_mps2 + limit_mps2);  // A
  if (curvature == 0) return closing_mps > 0 ? -now / growth : kNever;
  const double discriminant = 4 * limit_mps2 * (host_braking_mps2 + limit_mps2) *
                              (closing_mps * closing_mps + 2 * host_braking_mps2 * gap_m);
  return std::max(0.0, (std::sqrt(discriminant) - growth) / (2 * curvature));
}

Availability::Availability(const Scenario& scenario)
    : section_(scenario.arbitrator.availability),
      take_over_s_(models::TakeOverTime(scenario.arbitrator.take_over.time,
                                        scenario.arbitrator.take_over.lead_s)
                       .Quantile(kPercentile)),
      isolation_(scenario.arbitrator) {}

EngagementRequest Availability::Decide(const ArbitratorView& view) {
  if (DriverIsAvailable(view)) return Compare(view.doc, view.threshold);
  return {.lambda_human = 0, .threshold = 1, .firm = true};
}

bool Availability::DriverIsAvailable(const ArbitratorView& view) const {
  if (view.lambda_human >= kMainAuthority || !view.surroundings.followed) return true;
  const double time_s = TimeUntilHardBraking(
      view.surroundings.follower_gap_m, view.surroundings.follower_speed_mps - view.ego.speed_mps,
      std::max(0.0, -view.ego.acceleration_mps2), section_.comfort_mps2);
  const double required_s = take_over_s_ + section_.unready_s * (1 - view.driver.readiness);
  return std::min(time_s, section_.horizon_s) > required_s;
}

}  // namespace fogline::policies
