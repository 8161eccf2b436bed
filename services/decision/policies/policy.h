// Interface of the policies of engagement: their inputs and decisions. A policy decides in two
// processes. In the fusion, the policy decides which sensors are used. In the arbitrator, the
// policy decides which side should drive. Each process has its own instance. The two instances
// exchange only the messages of the run. The arbitrator decides how authority then changes
// (services/arbitrator/README.md).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "scenario/sections/scenario.h"
#include "services/decision/conflict/conflict_measure.h"
#include "services/graph.h"

namespace fogline::policies {

/// The sensors that the fusion uses in this step. If a sensor is not selected, the fusion compares
/// its values with the prediction, but these values do not correct the filter.
struct SensorSelection {
  bool radar = true;
  bool lidar = true;

  friend bool operator==(const SensorSelection&, const SensorSelection&) = default;
};

/// Inputs of a policy in the fusion, before the filter uses the values of the step.
struct FusionView {
  const conflict::Evidence& evidence;
  /// True gap between the host and the preceding car; only for policies with kNeedsTrueGap.
  std::optional<double> true_gap_m;
};

/// Values of a perfect rear sensor and a visibility meter, for policies with kNeedsSurroundings.
struct Surroundings {
  bool followed = false;
  double follower_gap_m = 0;      // from the follower's front bumper to the host
  double follower_speed_mps = 0;  // speed of the follower
  double visibility_m = std::numeric_limits<double>::infinity();  // meteorological optical range

  /// 1/TTC of the follower in 1/s; 0 without a follower, or if its gap does not close.
  double ClosingRate(double host_speed_mps) const {
    // A gap below kTouching_m counts as kTouching_m, because the quotient must stay finite. At this
    // gap, the bumpers nearly touch.
    constexpr double kTouching_m = 0.1;
    if (!followed) return 0;
    return std::max(0.0, follower_speed_mps - host_speed_mps) /
           std::max(follower_gap_m, kTouching_m);
  }
};

/// Inputs of a policy in the arbitrator.
struct ArbitratorView {
  double doc;           // Degree of Conflict in this step, in [0, 1]
  double threshold;     // DoC_th of the scenario
  double lambda_human;  // the human's authority in the previous step
  const ego_t& ego;
  const track_t& track;
  const accel_command_t& automation;
  const driver_command_t& driver;
  const Surroundings& surroundings;
};

/// A policy's decision in the arbitrator.
struct EngagementRequest {
  double lambda_human = 0;  // wanted authority of the human, in [0, 1]
  double threshold = 1;     // the human is wanted while DoC >= threshold
  /// If true, the request passes without delay. If false, the request is the result of the
  /// comparison of DoC and threshold, and a hysteresis may delay the request.
  bool firm = true;
};

/// The request of the paper's rule with this threshold: the automation drives only if
/// DoC < threshold. So the human drives if the DoC is NaN.
inline EngagementRequest Compare(double doc, double threshold) {
  return {.lambda_human = doc < threshold ? 0.0 : 1.0, .threshold = threshold, .firm = false};
}

/// The request that the automation drives, whatever the conflict is.
inline EngagementRequest StayAutomated(double threshold) {
  return {.lambda_human = 0, .threshold = threshold, .firm = true};
}

/// The rule that a policy's Decide() follows. kNever (policy `none`, for example) and kThreshold
/// (policy `traded`, for example) are simple rules: the arbitrator applies them without calling
/// Decide(). This saves 6 ns of the 400 ns of a step (AMD EPYC, GCC 12).
enum class Rule : std::uint8_t {
  kOwn,        // a rule of the policy itself: Decide() is called
  kNever,      // StayAutomated() with the scenario's threshold
  kThreshold,  // Compare() with the scenario's threshold
};

/// A policy, made from a scenario and called in every step, in the order of steps. A policy reads
/// no clock, shares no state, and allocates memory only in its constructor.
class EngagementPolicy {
 public:
  /// Whether the policy needs FusionView::true_gap_m or ArbitratorView::surroundings in addition to
  /// the regular inputs. A policy that needs such an input redefines its constant.
  static constexpr bool kNeedsTrueGap = false;
  static constexpr bool kNeedsSurroundings = false;
  /// Whether the policy shares authority: its requests can lie between 0 and 1. If the driver must
  /// be asked, any share above 0 causes a request to take over. After the take-over, the driver has
  /// the share that the policy requests.
  static constexpr bool kShares = false;
  /// Whether the policy's decisions depend on the scenario's threshold. A policy redefines this
  /// constant if its rule is kOwn and does not use the threshold.
  static constexpr bool kUsesThreshold = true;
  /// The rule of Decide(). A policy with a simple rule redefines this constant.
  static constexpr Rule kRule = Rule::kOwn;

  virtual ~EngagementPolicy() = default;

  /// The sensors that the fusion uses in this step. The fusion calls this function once per step,
  /// but only if the policy overrides it. If there is a track, the call comes after the filter's
  /// prediction.
  virtual SensorSelection SelectSensors(const FusionView& /*view*/) { return {}; }

  /// The policy's decision in the arbitrator. The arbitrator calls this function once per decision,
  /// and only with Rule::kOwn.
  virtual EngagementRequest Decide(const ArbitratorView& view) = 0;
};

}  // namespace fogline::policies
