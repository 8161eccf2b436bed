// What keeps authority from going to and fro: hysteresis, and a least stay.
#pragma once

#include <cstdint>

#include "scenario/engagement.h"
#include "services/policies/policy.h"

namespace fogline {

/// From what a policy wishes in every step to what is wanted: the comparison of DoC and threshold,
/// put off by the scenario's hysteresis,
///
///     none  the human is wanted while DoC >= threshold
///     band  and until DoC < threshold - min(band, threshold/2): a DoC that falls to 0 always gives
///           the wheel back, also where the threshold moves
///     sprt  Wald's test (1945) of log odds: L += logit(DoC) - logit(threshold); the human from
///           L >= ln((1 - beta)/alpha) on, the automation from L <= ln(beta/(1 - alpha)) on, and
///           with every decision a new test begins from L = 0
///
/// and then by min_dwell_s since the last change. The test's probabilities of error are alpha and
/// beta as far as the DoC is a probability and its steps are independent; a windowed z is not, and
/// errs more often. A DoC that is a posterior has added up the evidence of all steps itself: then
/// L = logit(DoC) - logit(threshold), and nothing is counted twice. A firm wish passes as it is.
class SteadyWish {
 public:
  /// @param posterior whether the DoC is a posterior probability of all evidence so far
  SteadyWish(const TransferSection& section, double step_s, bool posterior = false);

  /// Authority of the human that is wanted in this step, in [0, 1]. Once per decision.
  double Step(const Wish& wish, double doc) {
    if (wish.firm) return wish.lambda_human;
    return plain_ ? wish.lambda_human : PutOff(wish, doc);
  }

  /// L of the test under way, with hysteresis sprt; of a posterior that of the last step.
  double evidence() const { return evidence_; }

 private:
  double PutOff(const Wish& wish, double doc);
  bool HumanByHysteresis(const Wish& wish, double doc);
  double LowerThreshold(double threshold) const;

  TransferSection section_;
  bool posterior_;
  bool plain_;  // neither hysteresis nor least stay
  double accept_human_;
  double accept_automation_;
  std::int64_t dwell_steps_;

  double evidence_ = 0;         // L
  bool decided_human_ = false;  // by the hysteresis
  bool wanted_human_ = false;   // after the least stay
  std::int64_t steps_since_change_;
};

}  // namespace fogline
