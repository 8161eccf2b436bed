// The section of a scenario for a driver who must first be asked to take over: request, take-over
// time, minimal risk manoeuvre.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class TakeOverMode { kInstant, kRequested };
template <>
struct ChoiceNames<TakeOverMode> {
  static constexpr std::array<std::string_view, 2> kNames{"instant", "requested"};
  static constexpr std::array<std::string_view, 2> kDocs{
      "the paper's: the driver is always at it",
      "the driver must be asked, comes after his take-over time or never, and the car stops if he "
      "does not (services/decision/take_over/take_over_table.h)"};
};

enum class TakeOverModel { kLogNormal, kLogNormalByLead, kSumo };
template <>
struct ChoiceNames<TakeOverModel> {
  static constexpr std::array<std::string_view, 3> kNames{"log_normal", "log_normal_by_lead",
                                                          "sumo"};
  static constexpr std::array<std::string_view, 3> kDocs{
      "log-normal with mean_s and std_s",
      "log-normal with SUMO's mean for the lead time, as wide as late_probability says",
      "SUMO's normal distribution for the lead time and late_probability"};
};

/// Distribution of the take-over time.
struct TakeOverParameters {
  TakeOverModel model = TakeOverModel::kLogNormal;
  double mean_s = 2.7;
  double std_s = 1.45;
  double late_probability = 0.05;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("model", self.model, "Distribution of the take-over time.");
    visit.Number("mean_s", self.mean_s,
                 {.min = 0.1,
                  .max = 60,
                  .unit = "s",
                  .doc = "For log_normal.",
                  .source = "Zhang et al. 2019, 129 studies: 2.7"});
    visit.Number("std_s", self.std_s,
                 {.min = 0.01,
                  .max = 60,
                  .unit = "s",
                  .doc = "For log_normal.",
                  .source = "Zhang et al. 2019, of the studies' means: 1.45"});
    visit.Number("late_probability", self.late_probability,
                 {.min = 1e-6,
                  .max = 0.1,
                  .unit = "",
                  .doc = "For the other two: that he takes longer than the lead time.",
                  .source = "SUMO's ToC device: 0.05"});
  }
};

/// Least time in s between a request to take over and the minimal risk manoeuvre, unless the
/// request is severe (UN R157, 5.4.4.1). No scenario can make it shorter.
inline constexpr double kLeastLead_s = 10.0;

/// Emergency fallback: request, escalation, minimal risk manoeuvre.
struct TakeOverSection {
  TakeOverMode mode = TakeOverMode::kInstant;
  double lead_s = 10.0;
  double escalation_s = 4.0;
  TakeOverParameters time;
  double absent_probability = 0.0;
  double required_readiness = 0.3;
  double recovery_s = 5.0;
  double severe_ttc_s = 1.5;
  double comfort_deceleration_mps2 = 1.5;
  double emergency_deceleration_mps2 = 4.0;
  double jerk_mps3 = 2.5;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("mode", self.mode, "Whether the driver must be asked.");
    visit.Number("lead_s", self.lead_s,
                 {.min = kLeastLead_s,
                  .max = 20,
                  .unit = "s",
                  .doc = "From the request to the minimal risk manoeuvre.",
                  .source = "UN R157: not before 10 s unless severe"});
    visit.Number("escalation_s", self.escalation_s,
                 {.min = 0.1,
                  .max = 20,
                  .unit = "s",
                  .doc = "From the request to its escalation.",
                  .source = "UN R157: at the latest after 4 s"});
    visit.Section("time", self.time, "How long he takes.");
    visit.Number("absent_probability", self.absent_probability,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "That he does not come at all.",
                  .source = "our choice, because the paper's driver always comes"});
    visit.Number("required_readiness", self.required_readiness,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "Readiness below which his acknowledgement does not give him the wheel.",
                  .source = "our choice, because it is less than what is left of awareness while "
                            "monitoring, 0.5"});
    visit.Number("recovery_s", self.recovery_s,
                 {.min = 0,
                  .max = 60,
                  .unit = "s",
                  .doc = "After the transfer, until he counts as recovered and the automation may "
                         "have the wheel back.",
                  .source = "SUMO's ToC device: 5 s from awareness 0.5"});
    visit.Number(
        "severe_ttc_s", self.severe_ttc_s,
        {.min = 0,
         .max = 10,
         .unit = "s",
         .doc = "Time to collision with the preceding car below which the manoeuvre begins "
                "at once, as an emergency.",
         .source = "our choice, because 1.5 s is a common limit of imminent collisions"});
    visit.Number("comfort_deceleration_mps2", self.comfort_deceleration_mps2,
                 {.min = 0.5,
                  .max = 4,
                  .unit = "m/s2",
                  .doc = "Of the comfortable manoeuvre.",
                  .source = "SUMO's ToC device: 1.5"});
    visit.Number("emergency_deceleration_mps2", self.emergency_deceleration_mps2,
                 {.min = 0.5,
                  .max = 4,
                  .unit = "m/s2",
                  .doc = "Of the emergency manoeuvre.",
                  .source = "UN R157: demand at most 4.0"});
    visit.Number("jerk_mps3", self.jerk_mps3,
                 {.min = 0.1,
                  .max = 20,
                  .unit = "m/s3",
                  .doc = "How fast the manoeuvre's deceleration grows.",
                  .source = "ISO 15622: 2.5 above 20 m/s"});
  }
};

}  // namespace fogline
