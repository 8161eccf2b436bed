// Transfer of authority and command between the automation and the human.
#pragma once

#include <cstdint>
#include <optional>

#include "scenario/sections/engagement.h"

namespace fogline::arbitrator {

/// Moves the human's authority lambda_H towards the wanted authority, and computes the command
/// a = lambda_H a_H + lambda_A a_A. Profiles:
///
///     step          lambda_H is the wanted authority without delay (as in the paper)
///     linear        lambda_H moves by at most step_s/duration_s in each step
///     sigmoid       lambda_H = S(p), p moves by at most step_s/duration_s in each step,
///                   S(p) = (s(k (p - 1/2)) - s(-k/2))/(s(k/2) - s(-k/2)), s the logistic function
///     jerk_limited  like step, but with a limited jerk of the command until the command reaches a
///
/// The gate is an option for every profile. A transfer begins when the wanted authority passes
/// kMainAuthority. For gate_s from this moment on, the gate limits the command itself. The gate
/// also limits the change of the command in each step, until the command reaches the weighted
/// acceleration a. If a is below -yield_mps2, all limits of the command end immediately.
///
/// If lambda_H is 0 or 1 and no limit applies, the command is the offer of the side with authority,
/// bit by bit. services/arbitrator/README.md describes the return to the automation.
class Transfer {
 public:
  struct Offers {
    double automation_mps2;  // a_A
    double human_mps2;       // a_H
  };
  struct State {
    double lambda_human = 0;
    double acceleration_mps2 = 0;  // commanded
  };

  Transfer(const TransferSection& section, double step_s);

  /// @param wanted authority of the human, in [0, 1]
  /// @param applied_mps2 acceleration of the host, from which the first command continues
  State Step(double wanted, const Offers& offers, double applied_mps2) {
    if (plain_) return {wanted, Weighted(wanted, offers)};
    return Smooth(wanted, offers, applied_mps2);
  }

  /// Sets authority and command of this step to values that other code has chosen. Later steps
  /// continue from `actual`.
  void Overrule(const State& actual);

 private:
  static double Weighted(double lambda_human, const Offers& offers) {
    if (lambda_human == 0) return offers.automation_mps2;
    if (lambda_human == 1) return offers.human_mps2;
    return lambda_human * offers.human_mps2 + (1 - lambda_human) * offers.automation_mps2;
  }
  State Smooth(double wanted, const Offers& offers, double applied_mps2);
  double AuthorityTowards(double wanted);
  double Limited(double target_mps2, double previous_mps2);

  TransferSection section_;
  bool plain_;                // profile step, without gate
  double progress_per_step_;  // change of progress_ per step
  double change_per_step_;    // m/s2; largest change of a limited command
  std::int64_t gate_steps_;

  double progress_ = 0;
  bool to_human_ = false;  // whether the human was wanted in the last step
  bool limiting_ = false;
  std::int64_t gate_left_ = 0;
  std::optional<double> previous_mps2_;  // commanded
};

}  // namespace fogline::arbitrator
