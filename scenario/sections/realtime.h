// Sections of a scenario that only a run in real time uses: when an input counts as failed, and how
// a car stops when neither automation nor human can drive it. A period is step_s of the wall clock,
// divided by the speed of the run.
#pragma once

#include "scenario/sections/field.h"

namespace fogline {

/// Health of inputs (services/runtime/realtime/input_health.h).
struct HealthSection {
  double stale_periods = 1.5;
  double lost_periods = 2.5;
  std::int64_t recover_steps = 5;
  double deadline_share = 0.5;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("stale_periods", self.stale_periods,
                 {.min = 1.1,
                  .max = 100,
                  .unit = "periods",
                  .doc = "Without a new step for so long, an input is STALE: its last value holds.",
                  .source = "our choice, because one step and half a period of jitter may pass; "
                            "the first step that is missing shows"});
    visit.Number(
        "lost_periods", self.lost_periods,
        {.min = 1.1,
         .max = 100,
         .unit = "periods",
         .doc = "Without a new step for so long, an input is LOST and the fallback begins; "
                "never sooner than STALE.",
         .source =
             "our choice, because two steps and half a period of jitter may pass, so one lost "
             "datagram is no failure; with half a period for scheduling within 3 periods"});
    visit.Integer(
        "recover_steps", self.recover_steps,
        {.min = 1,
         .max = 1000,
         .unit = "steps",
         .doc = "So many steps in time, one after the other, and the input is OK again.",
         .source = "our choice, because trust should be slower than doubt: twice lost_periods"});
    visit.Number("deadline_share", self.deadline_share,
                 {.min = 0.05,
                  .max = 0.95,
                  .unit = "periods",
                  .doc = "The arbitrator waits so long after HOST_EGO for the step's other inputs, "
                         "then decides with what there is.",
                  .source = "our choice, because half is for them, half for its command on its way "
                            "to the vehicle"});
  }
};

/// Minimal risk manoeuvre (services/models/minimal_risk/minimal_risk.h).
struct MinimalRiskSection {
  double deceleration_mps2 = 1.0;
  double jerk_mps3 = 1.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("deceleration_mps2", self.deceleration_mps2,
                 {.min = 0.5,
                  .max = 4,
                  .unit = "m/s2",
                  .doc = "Strongest braking.",
                  .source = "UN R157, 5.5.1: at most 4.0; Autoware's comfortable stop: 1.0; above "
                            "1.5 the following car of paper.json runs into the host"});
    visit.Number("jerk_mps3", self.jerk_mps3,
                 {.min = 0.1,
                  .max = 100,
                  .unit = "m/s3",
                  .doc = "Fastest change of the acceleration, at the end as at the beginning.",
                  .source = "our choice, because it is between Autoware's comfortable stop (0.3) "
                            "and its emergency stop (1.5)"});
  }
};

}  // namespace fogline
