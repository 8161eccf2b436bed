#include "services/arbitrator/transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/whole_steps.h"
#include "services/decision/policies/policy.h"
#include "services/host_modes.h"

namespace fogline::arbitrator {
namespace {

// k of the sigmoid, per duration_s. The number is the same as in the paper's slope of the DoC (10
// per metre). The steepest slope of the sigmoid is 2.53 times the slope of the linear ramp.
constexpr double kSteepness = 10;

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }

// S(p) of transfer.h; it maps [0, 1] to [0, 1].
double Sigmoid(double progress) {
  static const double kLowest = Logistic(-kSteepness / 2);
  return (Logistic(kSteepness * (progress - 0.5)) - kLowest) / (1 - 2 * kLowest);
}

double InverseSigmoid(double authority) {
  static const double kLowest = Logistic(-kSteepness / 2);
  const double p = kLowest + authority * (1 - 2 * kLowest);
  return 0.5 + std::log(p / (1 - p)) / kSteepness;
}

// `from` moved towards `to` by at most `change`; exactly `to` if the distance is at most `change`.
double Towards(double from, double to, double change) {
  if (std::abs(to - from) <= change) return to;
  return to > from ? from + change : from - change;
}

}  // namespace

Transfer::Transfer(const TransferSection& section, double step_s)
    : section_(section),
      plain_(section.profile == TransferProfile::kStep && !section.gate),
      progress_per_step_(step_s / section.duration_s),
      change_per_step_(std::numeric_limits<double>::infinity()),
      gate_steps_(StepsUntil(section.gate_s, step_s)) {
  if (section.profile == TransferProfile::kJerkLimited) {
    change_per_step_ = section.jerk_mps3 * step_s;
  }
  if (section.gate) {
    change_per_step_ = std::min(change_per_step_, section.gate_jerk_mps3 * step_s);
  }
}

Transfer::State Transfer::Smooth(double wanted, const Offers& offers, double applied_mps2) {
  const bool to_human = wanted >= kMainAuthority;
  if (to_human != to_human_) {
    to_human_ = to_human;
    limiting_ = section_.gate || section_.profile == TransferProfile::kJerkLimited;
    gate_left_ = section_.gate ? gate_steps_ : 0;
  }
  State state{.lambda_human = AuthorityTowards(wanted), .acceleration_mps2 = 0};
  state.acceleration_mps2 = Weighted(state.lambda_human, offers);
  if (limiting_) {
    state.acceleration_mps2 =
        Limited(state.acceleration_mps2, previous_mps2_.value_or(applied_mps2));
  }
  previous_mps2_ = state.acceleration_mps2;
  return state;
}

double Transfer::AuthorityTowards(double wanted) {
  if (section_.profile == TransferProfile::kLinear) {
    return progress_ = Towards(progress_, wanted, progress_per_step_);
  }
  if (section_.profile != TransferProfile::kSigmoid) return wanted;
  // If the wanted authority is 0 or 1, the target is this value itself, because the logarithm in
  // InverseSigmoid() would give a rounded value.
  const double target = wanted == 0 || wanted == 1 ? wanted : InverseSigmoid(wanted);
  progress_ = Towards(progress_, target, progress_per_step_);
  if (progress_ == target) return wanted;
  return std::clamp(Sigmoid(progress_), 0.0, 1.0);
}

double Transfer::Limited(double target_mps2, double previous_mps2) {
  if (target_mps2 < -section_.yield_mps2) {
    limiting_ = false;
    return target_mps2;
  }
  if (gate_left_ > 0) {
    --gate_left_;
    target_mps2 =
        std::clamp(target_mps2, -section_.gate_acceleration_mps2, section_.gate_acceleration_mps2);
  } else if (std::abs(target_mps2 - previous_mps2) <= change_per_step_) {
    limiting_ = false;
  }
  return Towards(previous_mps2, target_mps2, change_per_step_);
}

void Transfer::Overrule(const State& actual) {
  const bool end = actual.lambda_human == 0 || actual.lambda_human == 1;
  progress_ = section_.profile == TransferProfile::kSigmoid && !end
                  ? InverseSigmoid(actual.lambda_human)
                  : actual.lambda_human;
  to_human_ = actual.lambda_human >= kMainAuthority;
  limiting_ = false;
  previous_mps2_ = actual.acceleration_mps2;
}

}  // namespace fogline::arbitrator
