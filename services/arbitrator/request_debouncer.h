// Debouncer of the policy's engagement request. The debouncer applies a hysteresis, and a least
// time between two changes.
#pragma once

#include <cstdint>

#include "scenario/sections/engagement.h"
#include "services/decision/policies/policy.h"

namespace fogline::arbitrator {

/// Computes the wanted authority of the human in every step from the policy's engagement request.
/// The scenario's hysteresis delays the result of the comparison of DoC and threshold:
///
///     none  the human is wanted while DoC >= threshold
///     band  the human is wanted from DoC >= threshold until
///           DoC < threshold - min(band, threshold/2);
///           this lower limit is at least threshold/2. So, if the threshold is above 0, the
///           human is not wanted at a DoC of 0, even if the threshold changes during the run
///     sprt  Wald's sequential probability ratio test (1945):
///           in each step, L grows by logit(DoC) - logit(threshold);
///           the human is wanted from L >= ln((1 - beta)/alpha) on,
///           the automation from L <= ln(beta/(1 - alpha)) on;
///           after every decision, a new test begins from L = 0
///
/// After the hysteresis, a change of the result also waits until min_dwell_s has passed since the
/// last change. The probabilities of error of the test sprt are alpha and beta if the DoC is a
/// probability, and if the DoCs of different steps are independent. A DoC that is computed from the
/// conflict z of a window is not a probability, and successive DoCs depend on each other. So with
/// this DoC the test makes more errors. If the DoC is a posterior, it already contains the evidence
/// of all steps. L is then logit(DoC) - logit(threshold), so that no evidence counts twice.
///
/// With hand_back fusion, a return to the automation also waits until the track has recovered
/// (fusion_recovery.h). A request that is `firm` (policies::EngagementRequest) is never delayed.
class RequestDebouncer {
 public:
  /// @param posterior whether the DoC is a posterior probability of all evidence so far
  RequestDebouncer(const TransferSection& section, double step_s, bool posterior = false);

  /// Returns the wanted authority of the human in this step, in [0, 1]. Call Step() once per
  /// decision.
  /// @param recovered whether the track has recovered; has an effect only with hand_back fusion
  double Step(const policies::EngagementRequest& request, double doc, bool recovered = true) {
    if (plain_) return request.lambda_human;
    if (request.firm) return Follow(request.lambda_human);
    return PutOff(request, doc, recovered);
  }

  /// L of hysteresis sprt after the last step (see the class comment); 0 with every other
  /// hysteresis.
  double evidence() const { return evidence_; }

 private:
  /// Returns the authority of a firm request without delay, and resets L to 0, so that hysteresis
  /// sprt begins a new test. If the request changes the wanted side, the wait for min_dwell_s
  /// starts in this step.
  double Follow(double lambda_human);
  double PutOff(const policies::EngagementRequest& request, double doc, bool recovered);
  bool HumanByHysteresis(const policies::EngagementRequest& request, double doc);
  double LowerThreshold(double threshold) const;

  TransferSection section_;
  bool posterior_;
  bool plain_;  // without hysteresis, min_dwell_s and hand_back fusion
  double accept_human_;
  double accept_automation_;
  std::int64_t dwell_steps_;

  double evidence_ = 0;         // L
  bool decided_human_ = false;  // result of the hysteresis
  bool wanted_human_ = false;   // result after the waits for min_dwell_s and for the track
  std::int64_t steps_since_change_;
};

}  // namespace fogline::arbitrator
