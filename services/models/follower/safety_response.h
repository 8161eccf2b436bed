// Response of a careful driver to the car ahead, by one of three published definitions. A follower
// may apply this response in addition to its car-following model.
#pragma once

#include "services/models/driver/situation.h"
#include "services/models/follower/safe_distance.h"

namespace fogline::models {

enum class SafetyModel { kReferenceHuman, kRss, kFuzzy };

/// Parameters of a driver's response. Defaults: the competent and careful human driver of UN R157
/// (Annex 4, appendix 3, after the JRC's implementation and secondary sources; the original text
/// was not available).
struct ResponseParameters {
  double perception_s = 0.4;        // time until the driver perceives the danger, at least 0
  double delay_s = 0.75;            // time from the perception to the braking, at least 0
  double lift_off_mps2 = 0.4;       // deceleration during the delay, at least 0
  double jerk_mps3 = 12.65;         // jerk of the brake, above 0: 0.774 g in 0.6 s
  double full_braking_mps2 = 7.59;  // 0.774 g, above 0
  double critical_ttc_s = 2.0;      // there is danger below this time to collision, at least 0
  double critical_headway_s = 2.0;  // there is danger below this time gap if the car ahead
                                    // brakes hard
  double lead_braking_mps2 = 5.0;   // the car ahead brakes hard above this deceleration
};

/// After the danger appears, the driver does nothing during the perception time. During the delay
/// that follows, the driver's foot is off the throttle. After the delay, the braking grows at the
/// jerk limit to the deceleration that the model demands:
///
/// - reference human: full braking while there is danger (ResponseParameters). After danger has
///   begun, it lasts at least until the closing speed is 0.
/// - RSS: full braking while the gap is below the safe distance. The response time rho of RSS
///   replaces the perception time, and there is no delay.
/// - fuzzy safety model: FuzzyDeceleration(). The response time of this model replaces the
///   perception time, and there is no delay.
///
/// If the model demands no braking, the response ends. At the next danger the response starts from
/// the beginning.
class SafetyResponse {
 public:
  /// @throw std::invalid_argument for a parameter out of its range.
  SafetyResponse(SafetyModel model, double step_s, const ResponseParameters& response = {},
                 const RssParameters& rss = {}, const FuzzyParameters& fuzzy = {});

  /// Deceleration of the response in this step in m/s2; 0 if there is no response. Call Step() once
  /// per step.
  double Step(const Situation& seen);

  /// Whether the model saw danger in the last step.
  bool alarmed() const { return alarmed_; }

 private:
  // Deceleration in m/s2 that the model demands now; 0 means no danger.
  double Target(const Situation& seen) const;
  bool HumanInDanger(const Situation& seen) const;

  SafetyModel model_;
  double step_s_;
  ResponseParameters response_;
  RssParameters rss_;
  FuzzyParameters fuzzy_;
  bool alarmed_ = false;
  double since_s_ = 0;  // time since the danger appeared
  double braking_mps2_ = 0;
};

}  // namespace fogline::models
