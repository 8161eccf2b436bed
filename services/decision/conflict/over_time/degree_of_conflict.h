// The windowed conflict z of radar and LiDAR, and the Degree of Conflict that is computed from it
// (Sourav & Cheng 2024).
#pragma once

#include "scenario/sections/control.h"
#include "services/decision/conflict/window.h"

namespace fogline::conflict {

/// DoC = 1 / (1 + exp(-slope (z - centre))), in [0, 1], where z is `conflict_m`.
double DegreeOfConflict(double conflict_m, double slope_per_m, double centre_m);

/// The differences radar - LiDAR of the last W steps. Their average is the conflict z, at least 0.
/// Before step W, the average is over all steps so far. A step without a difference adds an empty
/// entry, which does not count in the average.
class ConflictWindow : public Window {
 public:
  using Window::Window;

  /// The conflict z. `reading` says which average it is: the mean of the absolute differences, or
  /// the absolute value of the mean difference. z is 0 if no step in the window has a difference.
  double Conflict(ConflictReading reading) const;
};

}  // namespace fogline::conflict
