// Normalised squares and means of the difference over a window, for tests with the chi-square and
// the normal distribution (Bar-Shalom, Li & Kirubarajan 2001, section 5.4).
#pragma once

#include "services/decision/conflict/one_step/divergence.h"
#include "services/decision/conflict/over_time/windowed.h"

namespace fogline::conflict {

/// Mean of the n values of a window; 0 if the window is empty.
double Mean(const Window& window);
/// sum / sqrt(n) of the n values of a window; 0 if the window is empty.
double StandardisedMean(const Window& window);

/// Mean of NIS (divergence.h) over the window, at least 0. Without a fault, n times the mean of n
/// values has the chi-square distribution with n degrees of freedom.
using WindowedNis = Windowed<NormalisedSquare, Mean, &ConflictParameters::window_steps>;

/// T = sum u_i / sqrt(n) over the n differences of the window, any real number. u = d/sqrt(S) is
/// the standardised difference of a step (disagreement.h). Without a fault, T is standard normal.
/// While S is constant, T is mean(d) sqrt(n/S). T is above 0 if the LiDAR's range is too short, and
/// below 0 if this range is too long. T detects a constant bias best.
using SignedNis =
    Windowed<&Disagreement::standardised, StandardisedMean, &ConflictParameters::window_steps>;

}  // namespace fogline::conflict
