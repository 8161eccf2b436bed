// Model of a driver's awareness of the road, which fades and returns.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scenario/sections/human.h"

namespace fogline::models {

enum class DriverTask {
  kMonitors,  // the automation drives and has not asked the driver to take over
  kDrives,    // the driver drives, or has been asked to drive and may still take over
};

/// Awareness A in [0, 1], integrated exactly from step to step, with the target A_mon = monitoring,
/// the time constant tau = fading_s and the rate r = recovery_ps of AwarenessParameters:
///
///     monitors:  dA/dt = (A_mon - A) / tau            drives:  dA/dt = r, up to 1
///
/// The reaction time is reaction_time_s + slow_reaction_time_s (1 - A). The driver's errors of
/// perception are as large as those of SUMO's driver state (MSDriverState). Each error is a factor
/// times a random process with the standard deviation 0.2 (1 - A). For the relative gap error, the
/// factor is 0.75. For the error of the closing speed, the factor is 0.15 per second, times the
/// gap.
class Awareness {
 public:
  /// @throw std::invalid_argument for a parameter out of its range.
  explicit Awareness(const AwarenessParameters& parameters, double awareness = 1.0)
      : parameters_(parameters), awareness_(std::clamp(awareness, 0.0, 1.0)) {
    const bool valid = parameters.monitoring >= 0.0 && parameters.monitoring <= 1.0 &&
                       parameters.fading_s > 0.0 && parameters.recovery_ps > 0.0 &&
                       parameters.reaction_time_s >= 0.0 && parameters.slow_reaction_time_s >= 0.0;
    if (!valid) throw std::invalid_argument("awareness: a parameter is out of its range");
  }

  /// Advances A by `duration_s`. The driver has this task during the whole time. Returns A at the
  /// end.
  double Step(DriverTask task, double duration_s) {
    if (task == DriverTask::kDrives) {
      awareness_ = std::min(1.0, awareness_ + parameters_.recovery_ps * duration_s);
    } else {
      awareness_ -=
          (parameters_.monitoring - awareness_) * std::expm1(-duration_s / parameters_.fading_s);
    }
    return awareness_;
  }

  double awareness() const { return awareness_; }
  double ReactionTime_s() const {
    return parameters_.reaction_time_s + parameters_.slow_reaction_time_s * (1.0 - awareness_);
  }

  /// The longest reaction time that can occur from now on.
  double LongestReactionTime_s() const {
    const double least = std::min(awareness_, parameters_.monitoring);
    return parameters_.reaction_time_s + parameters_.slow_reaction_time_s * (1.0 - least);
  }

  /// The sizes V_s and r_c of the errors (human_driver.h). The sizes are the same as in SUMO's
  /// driver state.
  double GapError() const { return kSumoGap * kSumoDeviation * (1.0 - awareness_); }
  double ApproachError_ps() const { return kSumoApproach_ps * kSumoDeviation * (1.0 - awareness_); }

 private:
  // Defaults of SUMO's MSDriverState.
  static constexpr double kSumoDeviation = 0.2;
  static constexpr double kSumoGap = 0.75;
  static constexpr double kSumoApproach_ps = 0.15;

  AwarenessParameters parameters_;
  double awareness_;
};

}  // namespace fogline::models
