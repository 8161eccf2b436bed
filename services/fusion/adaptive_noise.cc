#include "services/fusion/adaptive_noise.h"

#include <algorithm>

namespace fogline::fusion {

AdaptiveNoise::AdaptiveNoise(NoiseAdaptation rule, double assumed_variance, double forgetting)
    : rule_(rule),
      assumed_variance_(assumed_variance),
      forgetting_(forgetting),
      variance_(assumed_variance) {}

void AdaptiveNoise::Learn(const CorrectionTrace& correction) {
  double seen = 0;
  switch (rule_) {
    case NoiseAdaptation::kNone:
      return;
    case NoiseAdaptation::kInnovation:
      seen = correction.innovation * correction.innovation - correction.predicted_variance;
      break;
    case NoiseAdaptation::kResidual:
      seen = correction.residual * correction.residual + correction.corrected_variance;
      break;
  }
  variance_ = std::max(assumed_variance_, forgetting_ * variance_ + (1 - forgetting_) * seen);
}

}  // namespace fogline::fusion
