// Sections of a scenario for the transfer of authority: how smoothly it goes, and the rules of the
// policies that do not use the paper's fixed threshold.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class TransferProfile { kStep, kLinear, kSigmoid, kJerkLimited };
template <>
struct ChoiceNames<TransferProfile> {
  static constexpr std::array<std::string_view, 4> kNames{"step", "linear", "sigmoid",
                                                          "jerk_limited"};
  static constexpr std::array<std::string_view, 4> kDocs{
      "the paper's: from one step to the next", "authorities go linearly over duration_s",
      "authorities go along a logistic curve over duration_s",
      "at once, but the command changes by no more than jerk_mps3 until it has caught up"};
};

enum class Hysteresis { kNone, kBand, kSprt };
template <>
struct ChoiceNames<Hysteresis> {
  static constexpr std::array<std::string_view, 3> kNames{"none", "band", "sprt"};
  static constexpr std::array<std::string_view, 3> kDocs{
      "the paper's: one threshold for both directions",
      "the automation returns below threshold - band, but no lower than half of the threshold",
      "Wald's test: each direction waits for enough evidence (sprt_alpha, sprt_beta)"};
};

/// Transfer of authority between automation and human.
struct TransferSection {
  TransferProfile profile = TransferProfile::kStep;
  double duration_s = 0.25;
  double jerk_mps3 = 2.0;
  double yield_mps2 = 3.5;
  Hysteresis hysteresis = Hysteresis::kNone;
  double band = 0.2;
  double sprt_alpha = 0.01;
  double sprt_beta = 0.01;
  double min_dwell_s = 0.0;
  bool gate = false;
  double gate_s = 2.0;
  double gate_acceleration_mps2 = 1.0;
  double gate_jerk_mps3 = 0.5;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("profile", self.profile, "How authorities and command change at a transfer.");
    visit.Number("duration_s", self.duration_s,
                 {.min = 0.01,
                  .max = 60,
                  .unit = "s",
                  .doc = "For linear and sigmoid.",
                  .source = "our choice, because it costs less than 3 points of SI in paper.json; "
                            "1 to 2 s, usual in shared control, cost 9 to 23"});
    visit.Number(
        "jerk_mps3", self.jerk_mps3,
        {.min = 0.05,
         .max = 100,
         .unit = "m/s3",
         .doc = "For jerk_limited: how fast the command may change after a transfer.",
         .source = "our choice, because it is below 2.5, the limit of ISO 15622 above 20 m/s"});
    visit.Number("yield_mps2", self.yield_mps2,
                 {.min = 0,
                  .max = 20,
                  .unit = "m/s2",
                  .doc = "For jerk_limited and gate: whoever drives and brakes harder than this is "
                         "obeyed at once, smooth or not.",
                  .source = "ISO 15622: an ACC never brakes harder above 20 m/s"});
    visit.Choice("hysteresis", self.hysteresis, "What keeps authority from going to and fro.");
    visit.Number("band", self.band,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "For hysteresis band. More than half of the threshold in force counts as "
                         "that half, or the wheel would never come back.",
                  .source = "our choice, because at threshold 0.5 it is 8 cm of z, more than a "
                            "noise of 1 to 2 cm moves it"});
    visit.Number("sprt_alpha", self.sprt_alpha,
                 {.min = 1e-6,
                  .max = 0.49,
                  .unit = "",
                  .doc = "For hysteresis sprt: probability of a transfer to the human for nothing.",
                  .source = "our choice, because 1 % is a usual error level of tests"});
    visit.Number("sprt_beta", self.sprt_beta,
                 {.min = 1e-6,
                  .max = 0.49,
                  .unit = "",
                  .doc = "For hysteresis sprt: probability of a conflict that is missed.",
                  .source = "our choice, because 1 % is a usual error level of tests"});
    visit.Number("min_dwell_s", self.min_dwell_s,
                 {.min = 0,
                  .max = 600,
                  .unit = "s",
                  .doc = "Least time between two transfers.",
                  .source = "Sourav & Cheng 2024: none; 3 to 5 s avoid flapping"});
    visit.Flag("gate", self.gate, "Limit the command itself for gate_s after a transfer.");
    visit.Number(
        "gate_s", self.gate_s,
        {.min = 0.01,
         .max = 60,
         .unit = "s",
         .doc = "For gate: how long after a transfer.",
         .source =
             "our choice, because it is as long as the longer ramps of shared control, 1 to 2 s"});
    visit.Number("gate_acceleration_mps2", self.gate_acceleration_mps2,
                 {.min = 0.1,
                  .max = 10,
                  .unit = "m/s2",
                  .doc = "For gate: strongest acceleration and braking.",
                  .source = "Autoware's vehicle_cmd_gate on transition: 1.0"});
    visit.Number("gate_jerk_mps3", self.gate_jerk_mps3,
                 {.min = 0.05,
                  .max = 100,
                  .unit = "m/s3",
                  .doc = "For gate: fastest change of the command.",
                  .source = "Autoware's vehicle_cmd_gate on transition: 0.5"});
  }
};

/// Policy adaptive: a threshold that moves with the situation,
/// clip(threshold + readiness_gain (1 - A) - visibility_gain_m / MOR - closing_gain_s max(0, 1/TTC
/// of the follower) - braking_gain_s2pm max(0, host's braking), least, most).
struct AdaptiveSection {
  double readiness_gain = 0.4;
  double visibility_gain_m = 5.0;
  double closing_gain_s = 0.5;
  double braking_gain_s2pm = 0.1;
  double least = 0.3;
  double most = 0.9;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number(
        "readiness_gain", self.readiness_gain,
        {.min = 0,
         .max = 10,
         .unit = "",
         .doc = "How much higher for a driver without readiness.",
         .source =
             "our choice, because without readiness the threshold then goes from 0.5 to most"});
    visit.Number("visibility_gain_m", self.visibility_gain_m,
                 {.min = 0,
                  .max = 1000,
                  .unit = "m",
                  .doc = "How much lower in fog, per 1/m of the inverse visibility.",
                  .source = "our choice, because it is 0.1 at 50 m"});
    visit.Number("closing_gain_s", self.closing_gain_s,
                 {.min = 0,
                  .max = 100,
                  .unit = "s",
                  .doc = "How much lower, per 1/s of the follower's inverse time to collision.",
                  .source = "our choice, because it is 0.1 at a time to collision of 5 s"});
    visit.Number("braking_gain_s2pm", self.braking_gain_s2pm,
                 {.min = 0,
                  .max = 10,
                  .unit = "s2/m",
                  .doc = "How much lower, per m/s2 of the host's braking.",
                  .source = "our choice, because it is 0.1 for each 1 m/s2"});
    visit.Number(
        "least", self.least,
        {.min = 0,
         .max = 0.5,
         .unit = "",
         .doc = "Never below.",
         .source =
             "our choice, because with a threshold near 0 the human would never be relieved"});
    visit.Number(
        "most", self.most,
        {.min = 0.5,
         .max = 1,
         .unit = "",
         .doc = "Never above.",
         .source = "our choice, because with a threshold near 1 the human would never be asked"});
  }
};

/// Policy bayes: the human drives while P(conflict) > C_h / (C_h + C_a), with the expected costs
/// C_h = human_cost + unready_cost (1 - A) + blind_cost min(1, near_m / MOR) of a human who drives,
/// C_a = automation_cost + follower_cost min(1, near_ttc_s / TTC of the follower) of an automation
/// that uses a wrong distance. P is the DoC: steep with the paper's slope; a posterior probability
/// with measure lidar_modes and measure_scale probability.
struct BayesSection {
  double human_cost = 1.0;
  double unready_cost = 3.0;
  double blind_cost = 1.0;
  double automation_cost = 1.0;
  double follower_cost = 3.0;
  double near_m = 40.0;
  double near_ttc_s = 4.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    const auto cost = [&](std::string_view name, auto& value, double least, std::string_view doc,
                          std::string_view source) {
      visit.Number(name, value,
                   {.min = least, .max = 1e6, .unit = "", .doc = doc, .source = source});
    };
    cost("human_cost", self.human_cost, 1e-6, "Of any human engagement.",
         "our choice, because it is the unit of the other costs: only their ratios count");
    cost("unready_cost", self.unready_cost, 0, "On top, of a driver without readiness.",
         "our choice, because the threshold then goes from 1/2 to 4/5");
    cost("blind_cost", self.blind_cost, 0, "On top, of one who sees no further than near_m.",
         "our choice, because the threshold then goes from 1/2 to 2/3");
    cost("automation_cost", self.automation_cost, 1e-6, "Of an automation that is deceived.",
         "our choice, because with human_cost it makes the threshold 1/2");
    cost("follower_cost", self.follower_cost, 0, "On top, with a follower as close as near_ttc_s.",
         "our choice, because the threshold then goes from 1/2 to 1/5");
    visit.Number("near_m", self.near_m,
                 {.min = 1,
                  .max = 1000,
                  .unit = "m",
                  .doc = "Visibility at which blind_cost counts in full.",
                  .source = "Hogema & van der Horst 1994: 40 to 100 m are most critical"});
    visit.Number("near_ttc_s", self.near_ttc_s,
                 {.min = 0.1,
                  .max = 60,
                  .unit = "s",
                  .doc = "Time to collision at which follower_cost counts in full.",
                  .source = "our choice, because 4 s is a common limit of severe conflicts"});
  }
};

/// Policy availability: like traded, but the driver gets authority only if he can take over in
/// time: the time until the follower must brake harder than comfort_mps2 must be longer than his
/// take-over time (95th percentile, longer if his readiness is below 1). Otherwise the automation
/// keeps authority. In both cases the automation uses only the sensor that is not to blame, as with
/// policy isolate.
struct AvailabilitySection {
  double comfort_mps2 = 3.0;
  double unready_s = 2.0;
  double horizon_s = 20.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number(
        "comfort_mps2", self.comfort_mps2,
        {.min = 0.5,
         .max = 10,
         .unit = "m/s2",
         .doc = "Braking that a follower must not exceed (DRAC).",
         .source = "our choice, because surrogate safety studies take 3.0 to 3.4 for critical"});
    visit.Number("unready_s", self.unready_s,
                 {.min = 0,
                  .max = 60,
                  .unit = "s",
                  .doc = "How much later a driver without readiness is.",
                  .source = "our choice, because nothing measured is at hand; it is less than a "
                            "whole take-over, 2.7 s"});
    visit.Number(
        "horizon_s", self.horizon_s,
        {.min = 1,
         .max = 600,
         .unit = "s",
         .doc = "What lies beyond does not count.",
         .source =
             "our choice, because a take-over by default ends far sooner: 95 % within 5.5 s"});
  }
};

/// Policy blend: both drive, the human in proportion to the conflict:
/// lambda_H = clip((DoC - from) / width, 0, 1).
struct BlendSection {
  double from = 0.2;
  double width = 0.6;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("from", self.from,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "DoC up to which the automation drives alone.",
                  .source = "Sourav & Cheng 2024: 0.2 is the lowest threshold"});
    visit.Number("width", self.width,
                 {.min = 0.001,
                  .max = 1,
                  .unit = "",
                  .doc = "DoC from there until the human drives alone.",
                  .source = "Sourav & Cheng 2024: 0.8 is the highest threshold"});
  }
};

}  // namespace fogline
