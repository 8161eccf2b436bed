// Sections of a scenario that only a run in real time uses: when an input counts as failed, and how
// a car stops when neither automation nor human can drive it. A period is step_s of the wall clock,
// divided by the speed of the run.
#pragma once

#include "scenario/sections/field.h"

namespace fogline {

/// Health of inputs (services/runtime/realtime/input_health.h).
struct HealthSection {
  FOGLINE_FIELD(double, stale_periods, 1.5, {1.1, 100, "periods"},
                "Without a new step for so long, an input is STALE: its last value holds.",
                "our choice, because one step and half a period of jitter may pass; the first step "
                "that is missing shows");
  FOGLINE_FIELD(double, lost_periods, 2.5, {1.1, 100, "periods"},
                "Without a new step for so long, an input is LOST and the fallback begins; never "
                "sooner than STALE.",
                "our choice, because two steps and half a period of jitter may pass, so one lost "
                "datagram is no failure; with half a period for scheduling within 3 periods");
  FOGLINE_FIELD(std::int64_t, recover_steps, 5, {1, 1000, "steps"},
                "So many steps in time, one after the other, and the input is OK again.",
                "our choice, because trust should be slower than doubt: twice lost_periods");
  FOGLINE_FIELD(
      double, deadline_share, 0.5, {0.05, 0.95, "periods"},
      "The arbitrator waits so long after HOST_EGO for the step's other inputs, then decides with "
      "what there is.",
      "our choice, because half is for them, half for its command on its way to the vehicle");
};

/// Minimal risk manoeuvre (services/models/minimal_risk/minimal_risk.h).
struct MinimalRiskSection {
  FOGLINE_FIELD(double, deceleration_mps2, 1.0, {0.5, 4, "m/s2"}, "Strongest braking.",
                "UN R157, 5.5.1: at most 4.0; Autoware's comfortable stop: 1.0; above 1.5 the "
                "following car of paper.json runs into the host");
  FOGLINE_FIELD(double, jerk_mps3, 1.0, {0.1, 100, "m/s3"},
                "Fastest change of the acceleration, at the end as at the beginning.",
                "our choice, because it is between Autoware's comfortable stop (0.3) and its "
                "emergency stop (1.5)");
};

}  // namespace fogline
