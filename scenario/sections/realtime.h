// Sections of a scenario that only a run in real time uses: when an input counts as failed, and how
// a car stops when neither automation nor human can drive. A period is step_s divided by the speed
// of the run, in wall-clock time.
#pragma once

#include "scenario/sections/field.h"

namespace fogline {

/// Limits that decide whether an input is OK, STALE or LOST
/// (services/runtime/realtime/input_health.h).
struct HealthSection {
  FOGLINE_FIELD(double, stale_periods, 1.5, {1.1, 100, "periods"},
                "An input without a new step for this time is STALE: its last value holds.",
                "our choice, because one step and half a period of jitter are normal; so one "
                "missing step already makes the input STALE");
  FOGLINE_FIELD(
      double, lost_periods, 2.5, {1.1, 100, "periods"},
      "An input without a new step for this time is LOST, and the fallback begins. LOST never "
      "comes before STALE.",
      "our choice, because two steps and half a period of jitter may pass, so one lost datagram is "
      "no failure; with half a period for scheduling, LOST comes within 3 periods");
  FOGLINE_FIELD(
      std::int64_t, recover_steps, 5, {1, 1000, "steps"},
      "Number of consecutive steps that must come on time before an input is OK again.",
      "our choice, because an input should recover more slowly than it fails: twice lost_periods");
  FOGLINE_FIELD(double, deadline_share, 0.5, {0.05, 0.95, "periods"},
                "Time for which the arbitrator waits after HOST_EGO for the step's other inputs. "
                "Then it decides with the inputs that have come.",
                "our choice, because half a period is for the inputs, and half for the command's "
                "way to the vehicle");

  bool operator==(const HealthSection&) const = default;
};

/// Limits of the minimal risk manoeuvre (services/models/minimal_risk/minimal_risk.h).
struct MinimalRiskSection {
  FOGLINE_FIELD(double, deceleration_mps2, 1.0, {0.5, 4, "m/s2"}, "Strongest braking.",
                "UN R157, 5.5.1: at most 4.0; Autoware's comfortable stop: 1.0; above 1.5 the "
                "following car of paper.json runs into the host");
  FOGLINE_FIELD(double, jerk_mps3, 1.0, {0.1, 100, "m/s3"},
                "Fastest change of the acceleration, both at the beginning and at the end.",
                "our choice, because it is between Autoware's comfortable stop (0.3) and its "
                "emergency stop (1.5)");

  bool operator==(const MinimalRiskSection&) const = default;
};

}  // namespace fogline
