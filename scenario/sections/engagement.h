// Sections of a scenario for the transfer of authority, and for the policies that do not use the
// paper's fixed threshold.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class TransferProfile { kStep, kLinear, kSigmoid, kJerkLimited };
constexpr auto ChoicesOf(TransferProfile) {
  return std::to_array<Choice>(
      {{"step", "the paper's: from one step to the next"},
       {"linear", "authorities change linearly over duration_s"},
       {"sigmoid", "authorities change along a logistic curve over duration_s"},
       {"jerk_limited",
        "authorities change at once; the command changes no faster than jerk_mps3 until it has "
        "caught up"}});
}

enum class Hysteresis { kNone, kBand, kSprt };
constexpr auto ChoicesOf(Hysteresis) {
  return std::to_array<Choice>(
      {{"none", "the paper's: one threshold for both directions"},
       {"band",
        "the automation returns below threshold - band, or below half of the threshold if that is "
        "higher"},
       {"sprt", "Wald's test: each direction waits for enough evidence (sprt_alpha, sprt_beta)"}});
}

enum class HandBack { kConflict, kFusion };
constexpr auto ChoicesOf(HandBack) {
  return std::to_array<Choice>(
      {{"conflict", "the paper's: as soon as the policy does not request the human"},
       {"fusion",
        "only if, in addition, the track has agreed with each sensor that has a value, within "
        "hand_back_error_m, for hand_back_s"}});
}

/// Transfer of authority between automation and human.
struct TransferSection {
  FOGLINE_FIELD(TransferProfile, profile, TransferProfile::kStep,
                "How authorities and command change at a transfer.");
  FOGLINE_FIELD(double, duration_s, 0.25, {0.01, 60, "s"},
                "For linear and sigmoid: length of a transfer.",
                "our choice, because it costs less than 3 points of SI in paper.json; 1 to 2 s, "
                "usual in shared control, cost 9 to 23");
  FOGLINE_FIELD(
      double, jerk_mps3, 2.0, {0.05, 100, "m/s3"},
      "For jerk_limited: fastest change of the command after a transfer.",
      "our choice, because it is below 2.5, the limit of ISO 15622 above 20 m/s, averaged "
      "over 1 s");
  FOGLINE_FIELD(
      double, yield_mps2, 3.5, {0, 20, "m/s2"},
      "For jerk_limited and gate: if a command of the side that drives brakes harder than "
      "this, it takes effect at once, even if the change is not smooth.",
      "ISO 15622: an ACC never brakes harder above 20 m/s");
  FOGLINE_FIELD(Hysteresis, hysteresis, Hysteresis::kNone, "Hysteresis of transfers.");
  FOGLINE_FIELD(double, band, 0.2, {0, 1},
                "For hysteresis band: distance of the return threshold below the threshold in "
                "force. More than half of this threshold counts as half; otherwise the automation "
                "would never get authority back.",
                "our choice, because at threshold 0.5 it is 8 cm of z, more than the effect of a "
                "noise of 1 to 2 cm");
  FOGLINE_FIELD(double, sprt_alpha, 0.01, {1e-6, 0.49},
                "For hysteresis sprt: probability of a transfer to the human without a conflict.",
                "our choice, because 1 % is a usual error level of tests");
  FOGLINE_FIELD(double, sprt_beta, 0.01, {1e-6, 0.49},
                "For hysteresis sprt: probability of missing a conflict.",
                "our choice, because 1 % is a usual error level of tests");
  FOGLINE_FIELD(double, min_dwell_s, 0.0, {0, 600, "s"},
                "Least time between two changes of the side that is wanted to drive. If the driver "
                "must be asked, a transfer comes later than the wish.",
                "Sourav & Cheng 2024: none; 3 to 5 s avoid rapid transfers to and from the human");
  FOGLINE_FIELD(HandBack, hand_back, HandBack::kConflict,
                "When the automation gets authority back. Without effect on the policies none, "
                "isolate, oracle and blend, whose requests pass without delay.");
  FOGLINE_FIELD(double, hand_back_error_m, 1.0, {0.001, 100, "m"},
                "For hand_back fusion: largest difference between the track's distance and the "
                "range of a sensor.",
                "our choice, because it is doc_centre_m; the radar of paper.json differs from the "
                "track by 0.9 m without a fault, and the automation must get authority back there");
  FOGLINE_FIELD(double, hand_back_s, 2.0, {0.001, 600, "s"},
                "For hand_back fusion: time for which the track must have agreed with the sensors.",
                "our choice, because the filter's memory is 2 s: after the fog of dense_fog.json "
                "an error of 1 m is 0.12 m after that time");
  FOGLINE_FIELD(bool, gate, false,
                "Whether the command itself is limited for gate_s after a transfer.");
  FOGLINE_FIELD(
      double, gate_s, 2.0, {0.01, 60, "s"},
      "For gate: time after a transfer in which the command is limited.",
      "our choice, because it is as long as the longer ramps of shared control, 1 to 2 s");
  FOGLINE_FIELD(double, gate_acceleration_mps2, 1.0, {0.1, 10, "m/s2"},
                "For gate: strongest acceleration and braking.",
                "Autoware's vehicle_cmd_gate on transition: 1.0");
  FOGLINE_FIELD(double, gate_jerk_mps3, 0.5, {0.05, 100, "m/s3"},
                "For gate: fastest change of the command.",
                "Autoware's vehicle_cmd_gate on transition: 0.5");

  bool operator==(const TransferSection&) const = default;
};

/// Policy adaptive: like traded, but the threshold depends on the situation:
///
///     clip(threshold + readiness_gain (1 - A) - visibility_gain_m / MOR
///          - closing_gain_s max(0, 1/TTC of the follower)
///          - braking_gain_s2pm max(0, host's braking), least, most)
///
/// A is the driver's readiness, MOR the visibility, and TTC the time to collision.
struct AdaptiveSection {
  FOGLINE_FIELD(double, readiness_gain, 0.4, {0, 10},
                "Increase of the threshold for a driver without readiness.",
                "our choice, because without readiness the threshold then goes from 0.5 to 0.9, "
                "the largest threshold (field most)");
  FOGLINE_FIELD(double, visibility_gain_m, 5.0, {0, 1000, "m"},
                "Decrease of the threshold in fog, per 1/m of the inverse visibility.",
                "our choice, because the threshold is then lower by 0.1 at a visibility of 50 m");
  FOGLINE_FIELD(
      double, closing_gain_s, 0.5, {0, 100, "s"},
      "Decrease of the threshold, per 1/s of the follower's inverse time to collision.",
      "our choice, because the threshold is then lower by 0.1 at a time to collision of 5 s");
  FOGLINE_FIELD(double, braking_gain_s2pm, 0.1, {0, 10, "s2/m"},
                "Decrease of the threshold, per m/s2 of the host's braking.",
                "our choice, because it is 0.1 for each 1 m/s2");
  FOGLINE_FIELD(double, least, 0.3, {0, 0.5}, "Smallest threshold.",
                "our choice, because with a threshold near 0 the automation would never drive");
  FOGLINE_FIELD(double, most, 0.9, {0.5, 1}, "Largest threshold.",
                "our choice, because with a threshold near 1 the human would never drive");

  bool operator==(const AdaptiveSection&) const = default;
};

/// Policy bayes: the human drives while P(conflict) >= C_h / (C_h + C_a). C_h = human_cost +
/// unready_cost (1 - A) + blind_cost min(1, near_m / MOR) is the expected cost of a human who
/// drives. C_a = automation_cost + follower_cost min(1, near_ttc_s / TTC of the follower) is the
/// expected cost of an automation that uses a wrong distance. A is the driver's readiness, MOR the
/// visibility, and TTC the time to collision. The policy uses the DoC as P(conflict). With measure
/// lidar_modes and measure_scale probability, the DoC is a posterior probability. With the paper's
/// measure, the DoC is not a probability: it is only a steep function of the conflict.
struct BayesSection {
  FOGLINE_FIELD(
      double, human_cost, 1.0, {1e-6, 1e6}, "Cost of any human engagement.",
      "our choice, because it is the unit of the other costs, of which only the ratios count");
  FOGLINE_FIELD(double, unready_cost, 3.0, {0, 1e6},
                "Additional cost of a driver without readiness.",
                "our choice, because the threshold then goes from 1/2 to 4/5");
  FOGLINE_FIELD(double, blind_cost, 1.0, {0, 1e6},
                "Additional cost of a driver that sees no further than near_m.",
                "our choice, because the threshold then goes from 1/2 to 2/3");
  FOGLINE_FIELD(double, automation_cost, 1.0, {1e-6, 1e6},
                "Cost of an automation that is deceived.",
                "our choice, because with human_cost it makes the threshold 1/2");
  FOGLINE_FIELD(
      double, follower_cost, 3.0, {0, 1e6},
      "Additional cost of a deceived automation if the follower is as close as near_ttc_s.",
      "our choice, because the threshold then goes from 1/2 to 1/5");
  FOGLINE_FIELD(double, near_m, 40.0, {1, 1000, "m"},
                "Visibility at which blind_cost counts in full.",
                "Hogema & van der Horst 1994: 40 to 100 m are most critical");
  FOGLINE_FIELD(double, near_ttc_s, 4.0, {0.1, 60, "s"},
                "Time to collision at which follower_cost counts in full.",
                "our choice, because 4 s is a common limit of severe conflicts");

  bool operator==(const BayesSection&) const = default;
};

/// Policy availability: like traded, but the driver gets authority only if a take-over is possible
/// in time. The take-over must end before the follower has to brake harder than comfort_mps2, and
/// within horizon_s. The policy uses the 95th percentile of the take-over time, and adds time if
/// the driver's readiness is below 1. If the take-over would come too late, the automation
/// continues to drive. Whenever the automation drives, it does not use the sensor that is to blame,
/// as with policy isolate.
struct AvailabilitySection {
  FOGLINE_FIELD(double, comfort_mps2, 3.0, {0.5, 10, "m/s2"},
                "Braking that a follower must not exceed (DRAC).",
                "our choice, because surrogate safety studies call 3.0 to 3.4 critical");
  FOGLINE_FIELD(
      double, unready_s, 2.0, {0, 60, "s"},
      "Additional take-over time of a driver without readiness.",
      "our choice, because no measurement is known; it is less than a whole take-over, 2.7 s");
  FOGLINE_FIELD(double, horizon_s, 20.0, {1, 600, "s"},
                "Look-ahead time. Later events do not count.",
                "our choice, because a take-over by default ends much earlier: 95 % within 5.5 s");

  bool operator==(const AvailabilitySection&) const = default;
};

/// Policy blend: both sides drive. The authority of the human, lambda_H, grows with the conflict:
/// lambda_H = clip((DoC - from) / width, 0, 1).
struct BlendSection {
  FOGLINE_FIELD(double, from, 0.2, {0, 1}, "DoC up to which the automation drives alone.",
                "Sourav & Cheng 2024: 0.2 is the lowest threshold");
  FOGLINE_FIELD(double, width, 0.6, {0.001, 1},
                "Width of the DoC range that begins at the value of `from`. In this range both "
                "drive; above it the human drives alone.",
                "Sourav & Cheng 2024: 0.8 is the highest threshold");

  bool operator==(const BlendSection&) const = default;
};

}  // namespace fogline
