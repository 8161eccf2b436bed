// The section of a scenario for a driver who must be asked before a take-over. Its fields describe
// the request, the take-over time and the minimal risk manoeuvre.
#pragma once

#include <array>
#include <string_view>

#include "scenario/sections/field.h"

namespace fogline {

enum class TakeOverMode { kInstant, kRequested };
constexpr auto ChoicesOf(TakeOverMode) {
  return std::to_array<Choice>(
      {{"instant", "the paper's: the driver is always ready to drive"},
       {"requested",
        "the driver must be asked, and takes over after the take-over time; if the driver never "
        "takes over, the car stops (services/decision/take_over/take_over_table.h)"}});
}

enum class TakeOverModel { kLogNormal, kLogNormalByLead, kSumo };
constexpr auto ChoicesOf(TakeOverModel) {
  return std::to_array<Choice>(
      {{"log_normal", "log-normal with mean_s and std_s"},
       {"log_normal_by_lead",
        "log-normal with SUMO's mean for the lead time, and with late_probability"},
       {"sumo", "SUMO's normal distribution for the lead time, with late_probability"}});
}

/// Distribution of the take-over time.
struct TakeOverParameters {
  FOGLINE_FIELD(TakeOverModel, model, TakeOverModel::kLogNormal,
                "Distribution of the take-over time.");
  FOGLINE_FIELD(double, mean_s, 2.7, {0.1, 60, "s"}, "For log_normal: mean.",
                "Zhang et al. 2019, 129 studies: 2.7");
  FOGLINE_FIELD(double, std_s, 1.45, {0.01, 60, "s"}, "For log_normal: standard deviation.",
                "Zhang et al. 2019, standard deviation of the studies' means: 1.45");
  FOGLINE_FIELD(
      double, late_probability, 0.05, {1e-6, 0.1},
      "For log_normal_by_lead and sumo: probability that the take-over time exceeds the lead time.",
      "SUMO's ToC device: 0.05");

  bool operator==(const TakeOverParameters&) const = default;
};

/// Least time in s between a request to take over and the minimal risk manoeuvre, if the situation
/// is not severe (UN R157, 5.4.4.1). No scenario can set a shorter time.
inline constexpr double kLeastLead_s = 10.0;

/// Parameters of a take-over on request: request, escalation, minimal risk manoeuvre.
struct TakeOverSection {
  FOGLINE_FIELD(TakeOverMode, mode, TakeOverMode::kInstant, "Whether the driver must be asked.");
  FOGLINE_FIELD(double, lead_s, 10.0, {kLeastLead_s, 20, "s"},
                "Time from the request to the minimal risk manoeuvre.",
                "UN R157: not before 10 s unless severe");
  FOGLINE_FIELD(double, escalation_s, 4.0, {0.1, 20, "s"},
                "Time from the request to its escalation.", "UN R157: at the latest after 4 s");
  FOGLINE_FIELD(TakeOverParameters, time, {}, "The driver's take-over time.");
  FOGLINE_FIELD(double, absent_probability, 0.0, {0, 1},
                "Probability that the driver never takes over.",
                "our choice, because the paper's driver always takes over");
  FOGLINE_FIELD(
      double, required_readiness, 0.3, {0, 1},
      "Readiness below which an acknowledgement does not give the driver authority.",
      "our choice, because it is less than the awareness that remains while monitoring, 0.5");
  FOGLINE_FIELD(double, recovery_s, 5.0, {0, 60, "s"},
                "Time from the transfer until the driver counts as recovered. Then the automation "
                "may get authority back.",
                "SUMO's ToC device: 5 s from awareness 0.5");
  FOGLINE_FIELD(
      double, slow_down_mps2, 0.0, {0, 4, "m/s2"},
      "Deceleration of the automation from the request until the driver takes over. 0: it "
      "only stops accelerating.",
      "our choice, because UN R157 demands no braking before the manoeuvre; up to 4 m/s2 "
      "are allowed in it");
  FOGLINE_FIELD(double, severe_ttc_s, 1.5, {0, 10, "s"},
                "Time to collision with the preceding car below which the manoeuvre begins at "
                "once, as an emergency.",
                "our choice, because 1.5 s is a common limit of imminent collisions");
  FOGLINE_FIELD(double, comfort_deceleration_mps2, 1.5, {0.5, 4, "m/s2"},
                "Deceleration of the comfortable manoeuvre.", "SUMO's ToC device: 1.5");
  FOGLINE_FIELD(double, emergency_deceleration_mps2, 4.0, {0.5, 4, "m/s2"},
                "Deceleration of the emergency manoeuvre.",
                "UN R157: a deceleration demand of at most 4.0");
  FOGLINE_FIELD(double, jerk_mps3, 2.5, {0.1, 20, "m/s3"},
                "How fast the manoeuvre's deceleration grows.",
                "ISO 15622: 2.5 above 20 m/s, averaged over 1 s");

  bool operator==(const TakeOverSection&) const = default;
};

}  // namespace fogline
