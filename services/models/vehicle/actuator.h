// Actuator: the force follows the demanded force with a delay and a lag.
#pragma once

#include <array>
#include <cstddef>

namespace fogline::models {

/// Pure delay D followed by a first-order lag tau,
///
///     tau dF/dt = u(t - D) - F
///
/// solved exactly for a demand u that is constant within a step. D need not be a whole number of
/// steps, so the demand that arrives may change once within a step. For each piece of length t with
/// a constant arriving demand u:
///
///     F(t) = u + (F(0) - u) e^(-t/tau)        integral = u t + (F(0) - u) tau (1 - e^(-t/tau))
///
/// The solution has no error of discretisation, so a smaller step changes F only by rounding.
class Actuator {
 public:
  /// Longest delay in steps.
  static constexpr std::size_t kMaxDelaySteps = 254;

  /// @param delay_s D, at least 0
  /// @param lag_s tau, at least 0; with 0 the force equals the arriving demand
  /// @throw std::invalid_argument if D or tau is negative, or D is longer than kMaxDelaySteps
  /// steps.
  Actuator(double delay_s, double lag_s, double step_s);

  /// Sets the actuator to the state that it reaches after a long time with this demand.
  void Settle(double demand_n);

  /// Advances by one step with this demand. Returns the mean force over the step.
  double Step(double demand_n);

  /// F at the end of the last step.
  double force_n() const { return force_n_; }

 private:
  // A part of the step in which the arriving demand is constant.
  struct Piece {
    double duration_s = 0;
    double decay = 1;     // e^(-t/tau)
    double memory_s = 0;  // tau (1 - e^(-t/tau))
  };
  static Piece MakePiece(double duration_s, double lag_s);

  // Returns the integral of the force over the piece.
  double Run(const Piece& piece, double arriving_n);
  double Demanded(std::size_t steps_ago) const;

  double step_s_;
  std::size_t delay_steps_ = 0;  // whole steps in D
  Piece older_;                  // part of the step in which the older demand arrives
  Piece newer_;
  std::array<double, kMaxDelaySteps + 2> demands_n_{};  // a ring buffer
  std::size_t last_ = 0;                                // index of the last demand
  double force_n_ = 0;
};

}  // namespace fogline::models
