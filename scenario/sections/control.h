// Sections of a scenario for the ACC, the human driver and the arbitrator.
#pragma once

#include <array>
#include <cstdint>

#include "scenario/sections/decision_types.h"
#include "scenario/sections/engagement.h"
#include "scenario/sections/field.h"
#include "scenario/sections/take_over.h"

namespace fogline {

/// Parameters of the MPC-based ACC of the host, or of the following cars (services/acc).
struct AccSection {
  FOGLINE_FIELD(double, headway_s, 1.5, {0, 10, "s"},
                "Time gap T_hw, bumper to bumper, in d_r = T_hw v + d_0.",
                "ISO 15622 offers 1.5 to 2.2 s");
  FOGLINE_FIELD(double, standstill_m, 3.0, {0, 50, "m"},
                "Standstill gap d_0 in d_r = T_hw v + d_0.",
                "our choice, because it lies between the 2 m of Treiber et al. 2000 and the 6 m of "
                "openpilot");
  FOGLINE_FIELD(double, engine_time_constant_s, 0.46, {0.01, 10, "s"},
                "Time constant T_e of the engine.",
                "Takahama & Akasaka 2018, by public implementations: 0.460 s");
  FOGLINE_FIELD(double, engine_gain, 1.0, {0.01, 10}, "Steady-state gain K_e of the engine.",
                "our choice, because with 1 the command is the steady acceleration; public "
                "implementations of Takahama & Akasaka 2018: 0.732");
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
                "our choice, because the paper prints none: a command of 1 m/s2 costs as much as "
                "an error of 1 m");
  FOGLINE_FIELD(double, weight_control_change, 1.0, {0, 1e6, "s4/m2"},
                "Cost of a step's change of u squared.",
                "our choice, because the paper prints none: a change of u costs as much as u; "
                "paper.json has a value that is tuned to reduce jerk");
  FOGLINE_FIELD(double, min_acceleration_mps2, -3.0, {-10, -0.1, "m/s2"},
                "Strongest braking that u may command, as steady acceleration.",
                "ISO 15622: at most 3.5 m/s2 above 20 m/s");
  FOGLINE_FIELD(double, max_acceleration_mps2, 2.0, {0.1, 10, "m/s2"},
                "Strongest acceleration that u may command, as steady acceleration.",
                "ISO 15622: at most 2.0 m/s2 above 20 m/s");
  FOGLINE_FIELD(double, max_jerk_mps3, 5.0, {0.1, 100, "m/s3"},
                "Fastest change of u, as steady acceleration per second.",
                "ISO 15622: at most 5.0 m/s3 below 5 m/s, 2.5 above 20 m/s, averaged over 1 s; "
                "here the larger limit");
  FOGLINE_FIELD(double, max_speed_mps, 40.0, {1, 70, "m/s"},
                "Set speed of the ACC: the largest speed that it plans, also on a free road. A "
                "faster car reaches this speed at least as early as in a fallback.",
                "public implementations of Takahama & Akasaka 2018: 15 to 40 m/s");
  FOGLINE_FIELD(double, min_gap_m, 2.0, {0, 50, "m"},
                "Soft lower limit of the planned gap. A smaller gap costs min_gap_weight.",
                "Treiber et al. 2000: a standstill gap of 2 m");
  FOGLINE_FIELD(double, min_gap_weight, 1000.0, {0.001, 1e6, "1/m2"},
                "Cost of the planned shortfall below min_gap_m, squared.",
                "our choice, because a shortfall must cost far more than weight_distance");
  FOGLINE_FIELD(std::int64_t, max_iterations, 1000, {1, 10'000},
                "Iteration limit of the QP solver.",
                "our choice, because 20,000 random situations with 30 steps needed at most 230");
  FOGLINE_FIELD(double, fallback_deceleration_mps2, 2.0, {0, 10, "m/s2"},
                "Braking if there is no track or no optimum. It grows at max_jerk_mps3 and is "
                "limited by min_acceleration_mps2.",
                "our choice, because 2 m/s2 is a usual limit of comfort");
  FOGLINE_FIELD(double, max_track_std_m, 10.0, {0.01, 1e6, "m"},
                "A track whose distance has a larger standard deviation is ignored. A following "
                "car sees its distance itself and has no track.",
                "our choice, because it is a third of the gap at 20 m/s");

  bool operator==(const AccSection&) const = default;
};

/// Parameters of the human driver: Intelligent Driver Model (Treiber, Hennecke & Helbing 2000).
struct DriverSection {
  FOGLINE_FIELD(double, max_acceleration_mps2, 0.73, {0.05, 10, "m/s2"},
                "Largest acceleration a_max.", "Treiber et al. 2000: 0.73");
  FOGLINE_FIELD(double, comfortable_deceleration_mps2, 1.67, {0.05, 10, "m/s2"},
                "Comfortable deceleration b.", "Treiber et al. 2000: 1.67");
  FOGLINE_FIELD(double, desired_speed_mps, 33.33, {1, 70, "m/s"}, "Desired speed v_0.",
                "Treiber et al. 2000: 120 km/h");
  FOGLINE_FIELD(double, headway_s, 1.5, {0, 10, "s"}, "Desired time gap T_hw, bumper to bumper.",
                "our choice, because the equilibrium gap then comes near the ACC's; Treiber et al. "
                "2000: 1.6");
  FOGLINE_FIELD(double, standstill_m, 2.0, {0, 50, "m"}, "Standstill gap s_0.",
                "Treiber et al. 2000: 2 m");
  FOGLINE_FIELD(double, exponent, 4.0, {1, 10}, "Exponent delta of the speed ratio.",
                "Treiber et al. 2000: 4");
  FOGLINE_FIELD(double, max_deceleration_mps2, 9.0, {0.5, 12, "m/s2"},
                "Strongest braking. The IDM itself has no limit when the gap goes to 0.",
                "our choice, because tyres have a friction of 0.9 to 1.0 on a dry road");
  FOGLINE_FIELD(double, readiness, 1.0, {0, 1}, "Readiness that the driver reports.",
                "Sourav & Cheng 2024: the driver is always ready");

  bool operator==(const DriverSection&) const = default;
};

/// The formula that turns the score of a measure of conflict into the degree of conflict (DoC).
enum class MeasureScale : std::uint8_t { kLogistic, kProbability };
constexpr auto ChoicesOf(MeasureScale) {
  return std::to_array<Choice>(
      {{"logistic", "1 / (1 + exp(-measure_slope (score - measure_centre)))"},
       {"probability",
        "the score itself, in [0, 1]: for lidar_modes, whose score is a posterior probability"}});
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
       {"skip", "leaves its place in the window empty, so a silent sensor looks like agreement"},
       {"conflict", "counts as a difference of missing_conflict_m"}});
}

/// Parameters of the arbitrator of Sourav & Cheng 2024. With measure `doc`, the degree of conflict
/// is DoC = 1 / (1 + exp(-doc_slope_per_m (z - doc_centre_m))). Here z is the conflict, averaged
/// over a window of window_steps steps.
struct ArbitratorSection {
  FOGLINE_FIELD(Policy, policy, Policy::kTraded, "Rule that decides who drives the host.");
  FOGLINE_FIELD(double, threshold, 0.5, {0, 1}, "DoC_th: below it the automation drives.",
                "Sourav & Cheng 2024: 0.2, 0.5, 0.8");
  FOGLINE_FIELD(double, doc_slope_per_m, 10.0, {0.01, 1000, "1/m"}, "Slope of the DoC.",
                "Sourav & Cheng 2024: 10");
  FOGLINE_FIELD(double, doc_centre_m, 1.0, {0, 100, "m"}, "Conflict z at which DoC is 1/2.",
                "Sourav & Cheng 2024: 1");
  FOGLINE_FIELD(ConflictReading, conflict, ConflictReading::kMeanOfAbsolute,
                "How z is computed. The paper leaves it open.");
  FOGLINE_FIELD(std::int64_t, window_steps, 8, {1, 1000, "steps"},
                "Length of the window over which z is averaged.",
                "our choice, because the paper prints none, and 5 to 10 steps reproduce its table");
  FOGLINE_FIELD(MissingLidar, missing_lidar, MissingLidar::kHold,
                "How a step without a radar or LiDAR value counts.");
  FOGLINE_FIELD(double, missing_conflict_m, 10.0, {0, 1000, "m"},
                "For missing_lidar conflict: the difference that such a step counts as.",
                "our choice, because one missing value in a window of 8 steps then passes the "
                "DoC's centre, 1 m");
  FOGLINE_FIELD(MeasureChoice, measure, MeasureChoice::kDoc,
                "Input of the DoC: z, or the score of another measure.");
  FOGLINE_FIELD(MeasureScale, measure_scale, MeasureScale::kLogistic,
                "How a score becomes the DoC, for every measure except doc.");
  FOGLINE_FIELD(double, measure_slope, 10.0, {1e-6, 1e6},
                "For measure_scale logistic: slope of the DoC over the score.",
                "our choice, because it is the paper's, and steep enough for scores in [0, 1]");
  FOGLINE_FIELD(double, measure_centre, 0.5, {-1e6, 1e6},
                "For measure_scale logistic: score at which DoC is 1/2.",
                "our choice, because it is the middle of scores in [0, 1]");
  FOGLINE_FIELD(double, measure_offset_m, 0.0, {-10, 10, "m"},
                "Known value of radar - LiDAR without a fault. It is subtracted for blame, and for "
                "every measure except doc.",
                "our choice, because calibrated sensors have none");
  FOGLINE_FIELD(BlameChoice, blame, BlameChoice::kNis,
                "Measure that tells which sensor is wrong, for policies that drop a sensor: "
                "isolate, availability, traded_isolating.");
  FOGLINE_FIELD(double, blame_threshold, 0.999, {0, 1},
                "Smallest blame at which the sensor with more blame is dropped.",
                "our choice, because with nis one step in 1000 then drops a sensor without fault");
  FOGLINE_FIELD(TransferSection, transfer, {},
                "How authority passes between automation and human.");
  FOGLINE_FIELD(AdaptiveSection, adaptive, {}, "Parameters of policy adaptive.");
  FOGLINE_FIELD(BayesSection, bayes, {}, "Parameters of policy bayes.");
  FOGLINE_FIELD(AvailabilitySection, availability, {}, "Parameters of policy availability.");
  FOGLINE_FIELD(BlendSection, blend, {}, "Parameters of policy blend.");
  FOGLINE_FIELD(TakeOverSection, take_over, {},
                "Emergency fallback: whether and how the driver is asked to take over.");

  bool operator==(const ArbitratorSection&) const = default;
};

}  // namespace fogline
