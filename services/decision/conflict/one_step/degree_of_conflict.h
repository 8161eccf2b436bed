// The windowed conflict z of radar and LiDAR, and the Degree of Conflict that is computed from it
// (Sourav & Cheng 2024).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenario/sections/control.h"

namespace fogline::conflict {

/// DoC = 1 / (1 + exp(-slope (z - centre))), in [0, 1].
double DegreeOfConflict(double conflict_m, double slope_per_m, double centre_m);

/// The differences radar - LiDAR of the last W steps; z >= 0 is their average. A step without a
/// difference has an empty place, which leaves the window like any other. Before step W, the
/// average is over the steps so far.
///
/// Every step computes the whole sum over the window again, oldest first. So z depends only on the
/// contents of the window, to the last bit.
class ConflictWindow {
 public:
  /// @param steps W, at least 1.
  explicit ConflictWindow(std::size_t steps) : differences_(steps) {}

  /// Adds a step and removes the oldest of the W steps. nullopt: a step without a difference.
  void Push(std::optional<double> difference_m);

  /// z according to `reading`: the mean of the absolute differences, or the absolute value of their
  /// mean; 0 if no step in the window has a difference.
  double Conflict(ConflictReading reading) const;

 private:
  std::vector<std::optional<double>> differences_;  // a ring; all places are empty at first
  std::size_t oldest_ = 0;
};

}  // namespace fogline::conflict
