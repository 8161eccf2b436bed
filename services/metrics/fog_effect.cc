#include "services/metrics/fog_effect.h"

#include "services/metrics/run_metrics.h"

namespace fogline::metrics {

void FogEffectAccumulator::Add(const Sample& sample) {
  if (!sample.fog_present) return;
  compromised_safety_m_.Add(CompromisedSafety(sample));
  if (!speed_at_begin_mps_) speed_at_begin_mps_ = sample.host_speed_mps;
  Raise(slow_down_mps_, *speed_at_begin_mps_ - sample.host_speed_mps);
}

FogEffect FogEffectAccumulator::Result() const {
  return {.mean_compromised_safety_m = compromised_safety_m_.Value(),
          .slow_down_mps = slow_down_mps_};
}

}  // namespace fogline::metrics
