// Policy `availability`: the automation hands over only to a driver who can take over in time.
#pragma once

#include "services/decision/policies/isolation.h"

namespace fogline::policies {

/// Time in s until a follower has to brake harder than `limit_mps2` to avoid the host. Until then,
/// the follower keeps its speed, and the host brakes with b = `host_braking_mps2` >= 0. The result
/// is the first t at which DRAC, the deceleration rate to avoid a crash, reaches the limit:
///
///     DRAC(t) = (w + b t)^2 / (2 (s - w t - b t^2/2)) = limit
///
/// with s = `gap_m` and w = `closing_mps`. The time is 0 if DRAC is already at the limit or above
/// it, or if `gap_m` is not above 0. The time is infinite if DRAC never reaches the limit.
double TimeUntilHardBraking(double gap_m, double closing_mps, double host_braking_mps2,
                            double limit_mps2);

/// If the driver is available, the policy decides as the paper does: the human drives if the DoC is
/// at least the threshold. A driver who already drives is available. A driver in a host without a
/// follower is available, too. Any other driver is available if the take-over time is short enough.
/// It must be less than horizon_s, and less than the time until the follower has to brake harder
/// than comfort_mps2. The take-over time here is the 95th percentile of its distribution, plus
/// unready_s times (1 minus the driver's readiness). If the driver is not available, the automation
/// continues to drive. Marberger et al. 2018 define availability as the time budget minus the
/// required time.
///
/// The fusion never uses the sensor that is to blame, as in policy Isolate. The fusion excludes
/// this sensor in every step, because it does not know whether the driver is available. The fusion
/// also excludes this sensor while the driver drives, although the automation does not use the
/// track then. So when the automation drives again, it has a usable track from its first step on.
class Availability final : public EngagementPolicy {
 public:
  static constexpr bool kNeedsSurroundings = true;

  explicit Availability(const Scenario& scenario);

  SensorSelection SelectSensors(const FusionView& view) override {
    return isolation_.Judge(view.evidence);
  }
  EngagementRequest Decide(const ArbitratorView& view) override;

 private:
  bool DriverIsAvailable(const ArbitratorView& view) const;

  AvailabilitySection section_;
  double take_over_s_;  // 95th percentile of the take-over time
  Isolation isolation_;
};

}  // namespace fogline::policies
