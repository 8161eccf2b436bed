#include "services/models/aeb/aeb.h"

#include <algorithm>

namespace fogline::models {

AebState Aeb::Step(const Situation& seen) { return state_ = StateOf(seen); }

double Aeb::Applied(double acceleration_mps2) const {
  if (state_ != AebState::kBraking) return acceleration_mps2;
  return std::min(acceleration_mps2, -section_.deceleration_mps2);
}

bool Aeb::Imminent(double gap_m, double closing_mps) const {
  const bool by_time = gap_m <= section_.ttc_s * closing_mps;
  const bool by_braking = closing_mps * closing_mps >= 2.0 * section_.required_mps2 * gap_m;
  switch (section_.trigger) {
    case AebTrigger::kTtc:
      return by_time;
    case AebTrigger::kDeceleration:
      return by_braking;
    case AebTrigger::kEither:
      return by_time || by_braking;
    case AebTrigger::kBoth:
      return by_time && by_braking;
  }
  return false;
}

AebState Aeb::StateOf(const Situation& seen) const {
  if (!seen.ahead) return AebState::kReady;
  const double gap_m = seen.ahead->gap_m;
  const double closing_mps = seen.speed_mps - seen.ahead->speed_mps;
  const bool goes_on = state_ == AebState::kBraking && seen.speed_mps > 0.0;
  if (goes_on && closing_mps > section_.release_closing_mps) return AebState::kBraking;
  const bool in_range =
      seen.speed_mps >= section_.min_speed_mps && seen.speed_mps <= section_.max_speed_mps;
  if (!in_range || closing_mps <= section_.release_closing_mps) return AebState::kReady;
  if (Imminent(gap_m, closing_mps)) return AebState::kBraking;
  if (Imminent(gap_m - section_.warning_s * closing_mps, closing_mps)) return AebState::kWarning;
  return AebState::kReady;
}

}  // namespace fogline::models
