// Estimates the noise variance of one kind of measured value while the filter runs.
#pragma once

#include "scenario/sections/sensing.h"

namespace fogline::fusion {

/// One correction of the filter by a measured value z. h(x) is the value that a state x predicts,
/// and H is the Jacobian of h. x- and P- are state and covariance right before this correction. x+
/// and P+ are state and covariance right after it.
struct CorrectionTrace {
  double innovation = 0;          // d = z - h(x-)
  double predicted_variance = 0;  // H P- H'
  double residual = 0;            // e = z - h(x+)
  double corrected_variance = 0;  // H P+ H'
};

/// Estimates the noise variance R of one kind of measured value, such as the radar's range. Each
/// correction by a value of this kind updates R, with the forgetting factor a:
///
///     innovation  R <- max(R_0, a R + (1 - a) (d^2 - H P- H'))       Mehra 1972
///     residual    R <- max(R_0, a R + (1 - a) (e^2 + H P+ H'))       Mohamed & Schwarz 1999;
///                                                                    Akhlaghi, Zhou & Huang 2017
///
/// If the R of the filter is right, the terms that are multiplied by (1 - a) have the mean R in
/// both rules. The reason: the variance of d is S = H P- H' + R, the variance of e is R^2 / S, and
/// H P+ H' is R - R^2 / S.
///
/// R never falls below the assumed variance R_0, for three reasons. First, the term of rule
/// `innovation` may be negative. Second, a sensor with a steady error shifts the filter's state
/// towards the values of this sensor, so the innovations of this sensor become small. Without the
/// limit, the filter would give this sensor more and more weight. Third, the assumed variance
/// covers errors that are not white, such as a constant offset.
class AdaptiveNoise {
 public:
  /// @param assumed_variance R_0, above 0
  /// @param forgetting a, in [0, 1]
  AdaptiveNoise(NoiseAdaptation rule, double assumed_variance, double forgetting);

  /// R for the next correction.
  double variance() const { return variance_; }

  /// Updates R. Call Learn() after each correction by a value of this kind. Do not call it for a
  /// value that the filter refuses, because such a value does not show how large the noise of the
  /// other values is.
  void Learn(const CorrectionTrace& correction);

 private:
  NoiseAdaptation rule_;
  double assumed_variance_;
  double forgetting_;
  double variance_;
};

}  // namespace fogline::fusion
