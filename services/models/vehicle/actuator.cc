#include "services/models/vehicle/actuator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/whole_steps.h"

namespace fogline::models {

Actuator::Actuator(double delay_s, double lag_s, double step_s) : step_s_(step_s) {
  if (!(delay_s >= 0.0) || !(lag_s >= 0.0) || !(step_s > 0.0)) {
    throw std::invalid_argument("actuator: delay and lag are at least 0, the step is above 0");
  }
  const double steps = WholeSteps(delay_s, step_s);
  if (steps > static_cast<double>(kMaxDelaySteps)) {
    throw std::invalid_argument("actuator: the delay is longer than 254 steps");
  }
  delay_steps_ = static_cast<std::size_t>(steps);
  const double rest_s = std::clamp(delay_s - steps * step_s, 0.0, step_s);
  older_ = MakePiece(rest_s, lag_s);
  newer_ = MakePiece(step_s - rest_s, lag_s);
}

Actuator::Piece Actuator::MakePiece(double duration_s, double lag_s) {
  if (duration_s == 0.0) return {};
  if (lag_s == 0.0) return {.duration_s = duration_s, .decay = 0.0, .memory_s = 0.0};
  const double ratio = -duration_s / lag_s;
  return {
      .duration_s = duration_s, .decay = std::exp(ratio), .memory_s = -lag_s * std::expm1(ratio)};
}

void Actuator::Settle(double demand_n) {
  demands_n_.fill(demand_n);
  force_n_ = demand_n;
}

double Actuator::Step(double demand_n) {
  last_ = (last_ + 1) % demands_n_.size();
  demands_n_[last_] = demand_n;
  const double earlier = Run(older_, Demanded(delay_steps_ + 1));
  return (earlier + Run(newer_, Demanded(delay_steps_))) / step_s_;
}

double Actuator::Run(const Piece& piece, double arriving_n) {
  const double behind_n = force_n_ - arriving_n;
  force_n_ = arriving_n + behind_n * piece.decay;
  return arriving_n * piece.duration_s + behind_n * piece.memory_s;
}

double Actuator::Demanded(std::size_t steps_ago) const {
  return demands_n_[(last_ + demands_n_.size() - steps_ago) % demands_n_.size()];
}

}  // namespace fogline::models
