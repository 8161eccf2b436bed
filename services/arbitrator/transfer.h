// How authority and command go from one driver of the host to the other.
#pragma once

#include <cstdint>
#include <optional>

#include "scenario/engagement.h"

namespace fogline {

/// From the authority that the human is to have to the one that he has, and the command that
/// follows, a = lambda_H a_H + lambda_A a_A. Profiles:
///
///     step          lambda_H is what is wanted, at once (the paper's)
///     linear        lambda_H moves by at most step/duration
///     sigmoid       lambda_H = S(p), p moves by at most step/duration,
///                   S(p) = (s(k (p - 1/2)) - s(-k/2))/(s(k/2) - s(-k/2)), s the logistic function
///     jerk_limited  as step, but until it has caught up the command changes by no more than jerk
///
/// The gate limits the command itself, in any profile, for gate_s after a transfer began, and its
/// change until it has caught up. A transfer begins when more than half of the authority is wanted
/// for the other one. Neither limit holds for braking harder than yield_mps2, which ends both.
///
/// With lambda_H at 0 or 1 and no limit in force an offer is passed on bit by bit, whatever the
/// other one is. What it makes of the automation's return: services/arbitrator/README.md.
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
  /// @param applied_mps2 acceleration of the host, from which the first command goes on
  State Step(double wanted, const Offers& offers, double applied_mps2) {
    if (plain_) return {wanted, Weighted(wanted, offers)};
    return Smooth(wanted, offers, applied_mps2);
  }

  /// What happens in this step was decided elsewhere: later steps go on from it.
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
  bool plain_;                // a step without gate
  double progress_per_step_;  // of the ramps
  double change_per_step_;    // m/s2; of a limited command
  std::int64_t gate_steps_;

  double progress_ = 0;
  bool to_human_ = false;  // who was wanted last
  bool limiting_ = false;
  std::int64_t gate_left_ = 0;
  std::optional<double> previous_mps2_;  // commanded
};

}  // namespace fogline
