// Decides whether a measured value belongs to the tracked car.
#pragma once

#include <cstdint>

namespace fogline::fusion {

/// Gate on the normalised innovation squared of one measured value: nu^2 / S, with the innovation
/// nu and its variance S. While the filter's model is valid, this number has the chi-square
/// distribution with one degree of freedom (Bar-Shalom, Li & Kirubarajan 2001, section 5.4). After
/// `reopen_after` refusals in a row, a change of the scene is more likely than failed measurements.
/// So the gate then admits every value until a value is inside the limit again. A gate that never
/// reopens refuses every value outside the limit.
class Gate {
 public:
  /// @param probability probability that a good value is inside the gate, in (0, 1)
  /// @param reopen_after at least 0; if 0, the gate never reopens
  Gate(double probability, std::int64_t reopen_after);

  /// Whether to use a value with this normalised innovation squared. Call Admits() once per value.
  bool Admits(double normalised_innovation_squared);

  /// Largest normalised innovation squared inside the gate.
  double limit() const { return limit_; }

 private:
  double limit_;
  std::int64_t reopen_after_;
  // Number of refusals in a row. The number stays at reopen_after_ while the gate is open, and at 0
  // if the gate never reopens.
  std::int64_t refusals_ = 0;
};

}  // namespace fogline::fusion
