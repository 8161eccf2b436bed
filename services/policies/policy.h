// What a policy of engagement sees, and what it says. It has a say in two processes: in the fusion,
// which sensors are used; in the arbitrator, who is to drive. Each process has an instance of its
// own, and nothing passes between the two but the messages. How authority then changes hands is not
// the policy's affair (services/arbitrator/README.md).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "scenario/scenario.h"
#include "services/conflict/conflict_measure.h"
#include "services/graph.h"
#include "services/minimal_risk/modes.h"

namespace fogline {

/// Which sensors the fusion uses in this step. One that is not trusted is compared with the
/// prediction, but corrects nothing.
struct Trust {
  bool radar = true;
  bool lidar = true;

  friend bool operator==(const Trust&, const Trust&) = default;
};

/// What there is to see in the fusion, before the filter uses the values of the step.
struct FusionView {
  const Evidence& evidence;
  /// From the host's front bumper to the preceding car, for policies with kNeedsTrueGap.
  std::optional<double> true_gap_m;
};

/// What a perfect rear sensor and a visibility meter tell, for policies with kNeedsSurroundings.
struct Surroundings {
  bool followed = false;
  double follower_gap_m = 0;      // from the follower's front bumper to the host
  double follower_speed_mps = 0;  // its own
  double visibility_m = std::numeric_limits<double>::infinity();  // meteorological optical range

  /// 1/TTC of the follower in 1/s; 0 without one, or if it does not close in.
  double ClosingRate(double host_speed_mps) const {
    // Bumpers that nearly touch: what is closer is not told apart.
    constexpr double kTouching_m = 0.1;
    if (!followed) return 0;
    return std::max(0.0, follower_speed_mps - host_speed_mps) /
           std::max(follower_gap_m, kTouching_m);
  }
};

/// What there is to see in the arbitrator.
struct ArbitratorView {
  double doc;           // Degree of Conflict in this step, in [0, 1]
  double threshold;     // DoC_th of the scenario
  double lambda_human;  // authority in the step before
  const ego_t& ego;
  const track_t& track;
  const accel_command_t& automation;
  const driver_command_t& driver;
  const Surroundings& surroundings;
};

/// Who is to drive.
struct Wish {
  double lambda_human = 0;  // wanted, in [0, 1]
  double threshold = 1;     // in force: the DoC from which on the human is wanted
  /// Firm: as it is. Otherwise it is the comparison of DoC and threshold, and a hysteresis may put
  /// that off.
  bool firm = true;
};

/// The paper's rule with whatever threshold: the human drives unless 0 <= DoC < threshold.
inline Wish Compare(double doc, double threshold) {
  return {.lambda_human = doc < threshold ? 0.0 : 1.0, .threshold = threshold, .firm = false};
}

/// The automation drives, whatever the conflict.
inline Wish StayAutomated(double threshold) {
  return {.lambda_human = 0, .threshold = threshold, .firm = true};
}

/// What a policy's Decide() comes to. The arbitrator follows the simple rules, among them those of
/// both runs of a pair, without a call: that is 6 ns of a step's 400 (AMD EPYC, GCC 12).
enum class Rule : std::uint8_t {
  kOwn,        // whatever Decide() says
  kNever,      // StayAutomated() with the scenario's threshold
  kThreshold,  // Compare() with it
};

/// A policy: made from a scenario, and told of every step in order. It reads no clock, shares
/// nothing, and allocates nothing once it is made.
class EngagementPolicy {
 public:
  /// What it needs beyond the regular inputs; hidden by a policy that does.
  static constexpr bool kNeedsTrueGap = false;
  static constexpr bool kNeedsSurroundings = false;
  /// Whether it shares: its wishes lie between all and nothing. A driver who must be asked is asked
  /// for any share, and has that share once he has come.
  static constexpr bool kShares = false;
  /// Whether its decisions depend on the scenario's threshold; hidden by a policy of which they do
  /// not, though it has a rule of its own.
  static constexpr bool kUsesThreshold = true;
  /// Hidden by a policy that has no rule of its own.
  static constexpr Rule kRule = Rule::kOwn;

  virtual ~EngagementPolicy() = default;

  /// In the fusion, once per step in which there is a prediction. Not called for a policy that
  /// leaves it as it is.
  virtual Trust TrustIn(const FusionView& /*view*/) { return {}; }

  /// In the arbitrator, once per decision.
  virtual Wish Decide(const ArbitratorView& view) = 0;
};

}  // namespace fogline
