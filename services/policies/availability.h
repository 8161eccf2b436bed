// Policy `availability`: no hand-over to a driver who would come too late.
#pragma once

#include "services/policies/isolation.h"

namespace fogline {

/// Time in s until a follower has to brake harder than `limit_mps2` to avoid the host, while it
/// keeps its speed and the host brakes with `host_braking_mps2` >= 0:
///
///     DRAC(t) = (w + b t)^2 / (2 (s - w t - b t^2/2)) = limit
///
/// with gap s and closing speed w. 0 if it has to already; infinite if it never has to.
double TimeUntilHardBraking(double gap_m, double closing_mps, double host_braking_mps2,
                            double limit_mps2);

/// As the paper's rule, for a driver who is available: whose take-over time (95th percentile of its
/// distribution, and unready_s (1 - A) more) is less than the time until the follower has to brake
/// harder than comfort_mps2, or who is driving already. Otherwise the automation stays, degraded.
/// Marberger et al. 2018: availability is the time budget less the time required.
///
/// The fusion goes on without the sensor that is to blame at all times, as with Isolate: also while
/// the driver is available. It cannot know that, and need not: while he drives nobody uses the
/// track, and when he does not the automation has one that it can go by, from the first step on.
class Availability final : public EngagementPolicy {
 public:
  static constexpr bool kNeedsSurroundings = true;

  explicit Availability(const Scenario& scenario);

  Trust TrustIn(const FusionView& view) override { return isolation_.Judge(view.evidence); }
  Wish Decide(const ArbitratorView& view) override;

 private:
  bool DriverIsAvailable(const ArbitratorView& view) const;

  AvailabilitySection section_;
  double take_over_s_;  // 95th percentile
  Isolation isolation_;
};

}  // namespace fogline
