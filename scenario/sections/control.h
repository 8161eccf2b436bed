// Sections of a scenario for the ACC, the human driver and the arbitrator.
#pragma once

#include <array>
#include <cstdint>

#include "scenario/sections/decision.h"
#include "scenario/sections/engagement.h"
#include "scenario/sections/field.h"
#include "scenario/sections/take_over.h"

namespace fogline {

/// MPC-based ACC, of the host and of the following cars.
struct AccSection {
  FOGLINE_FIELD(double, headway_s, 1.5, {0, 10, "s"}, "T_hw of d_r = T_hw v + d_0.",
                "ISO 15622 offers 1.5 to 2.2 s");
  FOGLINE_FIELD(double, standstill_m, 3.0, {0, 50, "m"}, "d_0 of d_r = T_hw v + d_0.",
                "our choice, because it lies between the 2 m of Treiber et al. 2000 and the 6 m of "
                "openpilot");
  FOGLINE_FIELD(double, engine_time_constant_s, 0.46, {0.01, 10, "s"}, "T_e.",
                "Takahama & Akasaka 2018, by public ports: 0.460 s");
  FOGLINE_FIELD(double, engine_gain, 1.0, {0.01, 10}, "K_e, steady-state gain.",
                "our choice, because with 1 the command is the steady acceleration; public ports "
                "of Takahama & Akasaka 2018: 0.732");
  FOGLINE_FIELD(std::int64_t, horizon_steps, 30, {1, 60, "steps"},
                "Prediction and control horizon.", "30 steps of 0.1 s: MathWorks ACC block");
  FOGLINE_FIELD(
      double, weight_distance, 1.0, {0, 1e6, "1/m2"}, "Cost of delta_d squared.",
      "our choice, because the paper prints none: an error of 1 m costs as much as one of 1 m/s");
  FOGLINE_FIELD(
      double, weight_speed, 1.0, {0, 1e6, "s2/m2"}, "Cost of delta_v squared.",
      "our choice, because the paper prints none: an error of 1 m/s costs as much as one of 1 m");
  FOGLINE_FIELD(
      double, weight_acceleration, 0.1, {0, 1e6, "s4/m2"}, "Cost of a squared.",
      "our choice, because the paper prints none: a follows u, which is weighted already");
  FOGLINE_FIELD(double, weight_control, 1.0, {1e-6, 1e6, "s4/m2"}, "Cost of u squared.",
                "our choice, because the paper prints none: 1 m/s2 asked for costs as much as an "
                "error of 1 m");
  FOGLINE_FIELD(double, weight_control_change, 1.0, {0, 1e6, "s4/m2"},
                "Cost of a step's change of u squared.",
                "our choice, because the paper prints none: a change of u costs as much as u; "
                "paper.json has one that is tuned against jerk");
  FOGLINE_FIELD(double, min_acceleration_mps2, -3.0, {-10, -0.1, "m/s2"},
                "Strongest braking that u may command, as steady acceleration.",
                "ISO 15622: at most 3.5 m/s2 above 20 m/s");
  FOGLINE_FIELD(double, max_acceleration_mps2, 2.0, {0.1, 10, "m/s2"},
                "Strongest acceleration that u may command, as steady acceleration.",
                "ISO 15622: at most 2.0 m/s2 above 20 m/s");
  FOGLINE_FIELD(
      double, max_jerk_mps3, 5.0, {0.1, 100, "m/s3"},
      "Fastest change of u, as steady acceleration per second.",
      "ISO 15622: at most 5.0 m/s3 below 5 m/s, 2.5 above 20 m/s, averaged over 1 s; the larger");
  FOGLINE_FIELD(double, max_speed_mps, 40.0, {1, 70, "m/s"},
                "Speed that no plan exceeds; a faster car is braked at least as in a fallback.",
                "public ports of Takahama & Akasaka 2018: 15 to 40 m/s");
  FOGLINE_FIELD(double, min_gap_m, 2.0, {0, 50, "m"},
                "Soft lower limit of the planned gap; less costs min_gap_weight.",
                "Treiber et al. 2000: a standstill gap of 2 m");
  FOGLINE_FIELD(double, min_gap_weight, 1000.0, {0.001, 1e6, "1/m2"},
                "Cost of the planned shortfall below min_gap_m, squared.",
                "our choice, because a shortfall has to outweigh weight_distance by far");
  FOGLINE_FIELD(std::int64_t, max_iterations, 1000, {1, 10'000},
                "Iteration limit of the QP solver.",
                "our choice, because 20,000 random situations with 30 steps needed at most 230");
  FOGLINE_FIELD(double, fallback_deceleration_mps2, 2.0, {0, 10, "m/s2"},
                "Braking when there is no track or no optimum, approached at max_jerk_mps3; "
                "min_acceleration_mps2 limits it.",
                "our choice, because 2 m/s2 is a usual limit of comfort");
  FOGLINE_FIELD(double, max_track_std_m, 10.0, {0.01, 1e6, "m"},
                "A track whose distance has a larger standard deviation counts as none. A "
                "following car sees its distance itself and has no track.",
                "our choice, because it is a third of the gap at 20 m/s");

  bool operator==(const AccSection&) const = default;
};

/// Human driver: Intelligent Driver Model (Treiber, Hennecke & Helbing 2000).
struct DriverSection {
  FOGLINE_FIELD(double, max_acceleration_mps2, 0.73, {0.05, 10, "m/s2"}, "a_max.",
                "Treiber et al. 2000: 0.73");
  FOGLINE_FIELD(double, comfortable_deceleration_mps2, 1.67, {0.05, 10, "m/s2"}, "b.",
                "Treiber et al. 2000: 1.67");
  FOGLINE_FIELD(double, desired_speed_mps, 33.33, {1, 70, "m/s"}, "v_0.",
                "Treiber et al. 2000: 120 km/h");
  FOGLINE_FIELD(double, headway_s, 1.5, {0, 10, "s"}, "T_hw.",
                "our choice, because the equilibrium gap then comes near the ACC's; Treiber et al. "
                "2000: 1.6");
  FOGLINE_FIELD(double, standstill_m, 2.0, {0, 50, "m"}, "s_0.", "Treiber et al. 2000: 2 m");
  FOGLINE_FIELD(double, exponent, 4.0, {1, 10}, "delta.", "Treiber et al. 2000: 4");
  FOGLINE_FIELD(double, max_deceleration_mps2, 9.0, {0.5, 12, "m/s2"},
                "Strongest braking; the IDM itself knows no limit as the gap vanishes.",
                "our choice, because tyres have a friction of 0.9 to 1.0 on a dry road");
  FOGLINE_FIELD(double, readiness, 1.0, {0, 1}, "Reported readiness.",
                "Sourav & Cheng 2024: the driver is always ready");
};

/// How a measure's score becomes the DoC.
enum class MeasureScale : std::uint8_t { kLogistic, kProbability };
constexpr auto ChoicesOf(MeasureScale) {
  return std::to_array<Choice>(
      {{"logistic", "1 / (1 + exp(-measure_slope (score - measure_centre)))"},
       {"probability",
        "the score itself, in [0, 1]: for lidar_modes, which is a posterior of all evidence so "
        "far"}});
}

enum class ConflictReading { kMeanOfAbsolute, kAbsoluteOfMean };
constexpr auto ChoicesOf(ConflictReading) {
  return std::to_array<Choice>({{"mean_of_absolute", "z = mean of |radar - LiDAR|"},
                                {"absolute_of_mean", "z = |mean of (radar - LiDAR)|"}});
}

enum class MissingLidar { kHold, kSkip, kConflict };
constexpr auto ChoicesOf(MissingLidar) {
  return std::to_array<Choice>(
      {{"hold", "repeats the last difference"},
       {"skip", "leaves its place in the window empty (silence looks like agreement)"},
       {"conflict", "counts as a difference of missing_conflict_m"}});
}

/// Arbitrator of Sourav & Cheng 2024: DoC = 1 / (1 + exp(-slope (z - centre))).
struct ArbitratorSection {
  FOGLINE_FIELD(Policy, policy, Policy::kTraded, "Who may drive.");
  FOGLINE_FIELD(double, threshold, 0.5, {0, 1}, "DoC_th: the automation drives below it.",
                "Sourav & Cheng 2024: 0.2, 0.5, 0.8");
  FOGLINE_FIELD(double, doc_slope_per_m, 10.0, {0.01, 1000, "1/m"}, "Slope of the DoC.",
                "Sourav & Cheng 2024: 10");
  FOGLINE_FIELD(double, doc_centre_m, 1.0, {0, 100, "m"}, "Conflict z at which DoC is 1/2.",
                "Sourav & Cheng 2024: 1");
  FOGLINE_FIELD(ConflictReading, conflict, ConflictReading::kMeanOfAbsolute,
                "How z is read (the paper leaves it open).");
  FOGLINE_FIELD(std::int64_t, window_steps, 8, {1, 1000, "steps"},
                "Window that z is averaged over.",
                "our choice, because the paper prints none, and 5 to 10 steps meet its table");
  FOGLINE_FIELD(MissingLidar, missing_lidar, MissingLidar::kHold,
                "What a step without radar or LiDAR value counts as.");
  FOGLINE_FIELD(double, missing_conflict_m, 10.0, {0, 1000, "m"}, "For missing_lidar conflict.",
                "our choice, because one missing value in a window of 8 steps then passes the "
                "DoC's centre, 1 m");
  FOGLINE_FIELD(MeasureChoice, measure, MeasureChoice::kDoc,
                "What the DoC is made of: z as above, or the score of another measure.");
  FOGLINE_FIELD(MeasureScale, measure_scale, MeasureScale::kLogistic,
                "What makes the DoC of a score, for any measure but doc.");
  FOGLINE_FIELD(double, measure_slope, 10.0, {1e-6, 1e6},
                "For measure_scale logistic: slope of the DoC over the score.",
                "our choice, because it is the paper's, and steep enough for scores in [0, 1]");
  FOGLINE_FIELD(double, measure_centre, 0.5, {-1e6, 1e6},
                "For measure_scale logistic: score at which DoC is 1/2.",
                "our choice, because it is the middle of scores in [0, 1]");
  FOGLINE_FIELD(double, measure_offset_m, 0.0, {-10, 10, "m"},
                "Radar - LiDAR without a fault, as far as it is known; taken off for any measure "
                "but doc, and for blame.",
                "our choice, because calibrated sensors have none");
  FOGLINE_FIELD(BlameChoice, blame, BlameChoice::kNis,
                "Which sensor is wrong, for policies that drop one: isolate, availability.");
  FOGLINE_FIELD(double, blame_threshold, 0.999, {0, 1},
                "Blame from which on the more blamed sensor is dropped.",
                "our choice, because with nis one step in 1000 then drops a sensor without fault");
  FOGLINE_FIELD(TransferSection, transfer, {}, "How authority goes from one to the other.");
  FOGLINE_FIELD(AdaptiveSection, adaptive, {}, "For policy adaptive.");
  FOGLINE_FIELD(BayesSection, bayes, {}, "For policy bayes.");
  FOGLINE_FIELD(AvailabilitySection, availability, {}, "For policy availability.");
  FOGLINE_FIELD(BlendSection, blend, {}, "For policy blend.");
  FOGLINE_FIELD(TakeOverSection, take_over, {}, "Emergency fallback: a driver who must be asked.");
};

}  // namespace fogline
