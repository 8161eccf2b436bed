// How much radar and LiDAR disagree: the windowed conflict z and the Degree of Conflict made of it
// (Sourav & Cheng 2024).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenario/control.h"

namespace fogline {

/// DoC = 1 / (1 + exp(-slope (z - centre))), in [0, 1].
double DegreeOfConflict(double conflict_m, double slope_per_m, double centre_m);

/// The differences radar - LiDAR of the last W steps, of which z >= 0 is the average. A step can be
/// there without a difference: its place is empty, and it ages like any other. Before W steps have
/// been, the average is that of those there were.
///
/// The sum is made anew over the window in every step, oldest first, and never carried on: z
/// depends on what the window holds, to the last bit, and on nothing that was before.
class ConflictWindow {
 public:
  /// @param steps W, at least 1.
  explicit ConflictWindow(std::size_t steps) : differences_(steps) {}

  /// Adds a step; the oldest of W leaves. nullopt: a step without a difference.
  void Push(std::optional<double> difference_m);

  /// z as `reading` has it: the mean of the absolute differences or the absolute value of their
  /// mean; 0 when no step in the window has a difference.
  double Conflict(ConflictReading reading) const;

 private:
  std::vector<std::optional<double>> differences_;  // a ring; begins with empty places
  std::size_t oldest_ = 0;
};

}  // namespace fogline
