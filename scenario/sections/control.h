// Sections of a scenario for the ACC, the human driver and the arbitrator.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "scenario/sections/engagement.h"
#include "scenario/sections/field.h"
#include "scenario/sections/take_over.h"

namespace fogline {

/// MPC-based ACC, of the host and of the following cars.
struct AccSection {
  double headway_s = 1.5;
  double standstill_m = 3.0;
  double engine_time_constant_s = 0.46;
  double engine_gain = 1.0;
  std::int64_t horizon_steps = 30;
  double weight_distance = 1.0;
  double weight_speed = 1.0;
  double weight_acceleration = 0.1;
  double weight_control = 1.0;
  double weight_control_change = 1.0;
  double min_acceleration_mps2 = -3.0;
  double max_acceleration_mps2 = 2.0;
  double max_jerk_mps3 = 5.0;
  double max_speed_mps = 40.0;
  double min_gap_m = 2.0;
  double min_gap_weight = 1000.0;
  std::int64_t max_iterations = 1000;
  double fallback_deceleration_mps2 = 2.0;
  double max_track_std_m = 10.0;

  bool operator==(const AccSection&) const = default;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("headway_s", self.headway_s,
                 {.min = 0,
                  .max = 10,
                  .unit = "s",
                  .doc = "T_hw of d_r = T_hw v + d_0.",
                  .source = "ISO 15622 offers 1.5 to 2.2 s"});
    visit.Number("standstill_m", self.standstill_m,
                 {.min = 0,
                  .max = 50,
                  .unit = "m",
                  .doc = "d_0 of d_r = T_hw v + d_0.",
                  .source = "our choice, because it lies between the 2 m of Treiber et al. 2000 "
                            "and the 6 m of openpilot"});
    visit.Number("engine_time_constant_s", self.engine_time_constant_s,
                 {.min = 0.01,
                  .max = 10,
                  .unit = "s",
                  .doc = "T_e.",
                  .source = "Takahama & Akasaka 2018, by public ports: 0.460 s"});
    visit.Number("engine_gain", self.engine_gain,
                 {.min = 0.01,
                  .max = 10,
                  .unit = "",
                  .doc = "K_e, steady-state gain.",
                  .source = "our choice, because with 1 the command is the steady acceleration; "
                            "public ports of Takahama & Akasaka 2018: 0.732"});
    visit.Integer("horizon_steps", self.horizon_steps,
                  {.min = 1,
                   .max = 60,
                   .unit = "steps",
                   .doc = "Prediction and control horizon.",
                   .source = "30 steps of 0.1 s: MathWorks ACC block"});
    visit.Number("weight_distance", self.weight_distance,
                 {.min = 0,
                  .max = 1e6,
                  .unit = "1/m2",
                  .doc = "Cost of delta_d squared.",
                  .source = "our choice, because the paper prints none: an error of 1 m costs as "
                            "much as one of 1 m/s"});
    visit.Number("weight_speed", self.weight_speed,
                 {.min = 0,
                  .max = 1e6,
                  .unit = "s2/m2",
                  .doc = "Cost of delta_v squared.",
                  .source = "our choice, because the paper prints none: an error of 1 m/s costs as "
                            "much as one of 1 m"});
    visit.Number(
        "weight_acceleration", self.weight_acceleration,
        {.min = 0,
         .max = 1e6,
         .unit = "s4/m2",
         .doc = "Cost of a squared.",
         .source =
             "our choice, because the paper prints none: a follows u, which is weighted already"});
    visit.Number("weight_control", self.weight_control,
                 {.min = 1e-6,
                  .max = 1e6,
                  .unit = "s4/m2",
                  .doc = "Cost of u squared.",
                  .source = "our choice, because the paper prints none: 1 m/s2 asked for costs as "
                            "much as an error of 1 m"});
    visit.Number("weight_control_change", self.weight_control_change,
                 {.min = 0,
                  .max = 1e6,
                  .unit = "s4/m2",
                  .doc = "Cost of a step's change of u squared.",
                  .source = "our choice, because the paper prints none: a change of u costs as "
                            "much as u; paper.json has one that is tuned against jerk"});
    visit.Number("min_acceleration_mps2", self.min_acceleration_mps2,
                 {.min = -10,
                  .max = -0.1,
                  .unit = "m/s2",
                  .doc = "Strongest braking that u may command, as steady acceleration.",
                  .source = "ISO 15622: at most 3.5 m/s2 above 20 m/s"});
    visit.Number("max_acceleration_mps2", self.max_acceleration_mps2,
                 {.min = 0.1,
                  .max = 10,
                  .unit = "m/s2",
                  .doc = "Strongest acceleration that u may command, as steady acceleration.",
                  .source = "ISO 15622: at most 2.0 m/s2 above 20 m/s"});
    visit.Number("max_jerk_mps3", self.max_jerk_mps3,
                 {.min = 0.1,
                  .max = 100,
                  .unit = "m/s3",
                  .doc = "Fastest change of u, as steady acceleration per second.",
                  .source = "ISO 15622: at most 5.0 m/s3 below 5 m/s, 2.5 above 20 m/s, averaged "
                            "over 1 s; the larger"});
    visit.Number(
        "max_speed_mps", self.max_speed_mps,
        {.min = 1,
         .max = 70,
         .unit = "m/s",
         .doc = "Speed that no plan exceeds; a faster car is braked at least as in a fallback.",
         .source = "public ports of Takahama & Akasaka 2018: 15 to 40 m/s"});
    visit.Number("min_gap_m", self.min_gap_m,
                 {.min = 0,
                  .max = 50,
                  .unit = "m",
                  .doc = "Soft lower limit of the planned gap; less costs min_gap_weight.",
                  .source = "Treiber et al. 2000: a standstill gap of 2 m"});
    visit.Number(
        "min_gap_weight", self.min_gap_weight,
        {.min = 0.001,
         .max = 1e6,
         .unit = "1/m2",
         .doc = "Cost of the planned shortfall below min_gap_m, squared.",
         .source = "our choice, because a shortfall has to outweigh weight_distance by far"});
    visit.Integer(
        "max_iterations", self.max_iterations,
        {.min = 1,
         .max = 10'000,
         .unit = "",
         .doc = "Iteration limit of the QP solver.",
         .source =
             "our choice, because 20,000 random situations with 30 steps needed at most 230"});
    visit.Number(
        "fallback_deceleration_mps2", self.fallback_deceleration_mps2,
        {.min = 0,
         .max = 10,
         .unit = "m/s2",
         .doc = "Braking when there is no track or no optimum, approached at max_jerk_mps3; "
                "min_acceleration_mps2 limits it.",
         .source = "our choice, because 2 m/s2 is a usual limit of comfort"});
    visit.Number("max_track_std_m", self.max_track_std_m,
                 {.min = 0.01,
                  .max = 1e6,
                  .unit = "m",
                  .doc = "A track whose distance has a larger standard deviation counts as none. A "
                         "following car sees its distance itself and has no track.",
                  .source = "our choice, because it is a third of the gap at 20 m/s"});
  }
};

/// Human driver: Intelligent Driver Model (Treiber, Hennecke & Helbing 2000).
struct DriverSection {
  double max_acceleration_mps2 = 0.73;
  double comfortable_deceleration_mps2 = 1.67;
  double desired_speed_mps = 33.33;
  double headway_s = 1.5;
  double standstill_m = 2.0;
  double exponent = 4.0;
  double max_deceleration_mps2 = 9.0;
  double readiness = 1.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("max_acceleration_mps2", self.max_acceleration_mps2,
                 {.min = 0.05,
                  .max = 10,
                  .unit = "m/s2",
                  .doc = "a_max.",
                  .source = "Treiber et al. 2000: 0.73"});
    visit.Number("comfortable_deceleration_mps2", self.comfortable_deceleration_mps2,
                 {.min = 0.05,
                  .max = 10,
                  .unit = "m/s2",
                  .doc = "b.",
                  .source = "Treiber et al. 2000: 1.67"});
    visit.Number("desired_speed_mps", self.desired_speed_mps,
                 {.min = 1,
                  .max = 70,
                  .unit = "m/s",
                  .doc = "v_0.",
                  .source = "Treiber et al. 2000: 120 km/h"});
    visit.Number("headway_s", self.headway_s,
                 {.min = 0,
                  .max = 10,
                  .unit = "s",
                  .doc = "T_hw.",
                  .source = "our choice, because the equilibrium gap then comes near the ACC's; "
                            "Treiber et al. 2000: 1.6"});
    visit.Number(
        "standstill_m", self.standstill_m,
        {.min = 0, .max = 50, .unit = "m", .doc = "s_0.", .source = "Treiber et al. 2000: 2 m"});
    visit.Number(
        "exponent", self.exponent,
        {.min = 1, .max = 10, .unit = "", .doc = "delta.", .source = "Treiber et al. 2000: 4"});
    visit.Number(
        "max_deceleration_mps2", self.max_deceleration_mps2,
        {.min = 0.5,
         .max = 12,
         .unit = "m/s2",
         .doc = "Strongest braking; the IDM itself knows no limit as the gap vanishes.",
         .source = "our choice, because tyres have a friction of 0.9 to 1.0 on a dry road"});
    visit.Number("readiness", self.readiness,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "Reported readiness.",
                  .source = "Sourav & Cheng 2024: the driver is always ready"});
  }
};

/// Policy for the authority over the host: the index of a row of the table in
/// services/decision/policies/policies.cc. Only the two rows that other code refers to have an
/// enumerator.
enum class Policy : std::uint8_t { kNone, kTraded };
template <>
struct ChoiceNames<Policy> {
  static const std::span<const std::string_view> kNames;
  static const std::span<const std::string_view> kDocs;
};

/// A measure of conflict: the index of a row of the first table in
/// services/decision/conflict/conflict_measures.cc.
enum class MeasureChoice : std::uint8_t { kDoc };
template <>
struct ChoiceNames<MeasureChoice> {
  static const std::span<const std::string_view> kNames;
  static const std::span<const std::string_view> kDocs;
};

/// A measure of which sensor is wrong: the index of a row of the second table in that file.
enum class BlameChoice : std::uint8_t { kNis };
template <>
struct ChoiceNames<BlameChoice> {
  static const std::span<const std::string_view> kNames;
  static const std::span<const std::string_view> kDocs;
};

/// How a measure's score becomes the DoC.
enum class MeasureScale : std::uint8_t { kLogistic, kProbability };
template <>
struct ChoiceNames<MeasureScale> {
  static constexpr std::array<std::string_view, 2> kNames{"logistic", "probability"};
  static constexpr std::array<std::string_view, 2> kDocs{
      "1 / (1 + exp(-measure_slope (score - measure_centre)))",
      "the score itself, in [0, 1]: for lidar_modes, which is a posterior of all evidence so far"};
};

enum class ConflictReading { kMeanOfAbsolute, kAbsoluteOfMean };
template <>
struct ChoiceNames<ConflictReading> {
  static constexpr std::array<std::string_view, 2> kNames{"mean_of_absolute", "absolute_of_mean"};
  static constexpr std::array<std::string_view, 2> kDocs{"z = mean of |radar - LiDAR|",
                                                         "z = |mean of (radar - LiDAR)|"};
};

enum class MissingLidar { kHold, kSkip, kConflict };
template <>
struct ChoiceNames<MissingLidar> {
  static constexpr std::array<std::string_view, 3> kNames{"hold", "skip", "conflict"};
  static constexpr std::array<std::string_view, 3> kDocs{
      "repeats the last difference",
      "leaves its place in the window empty (silence looks like agreement)",
      "counts as a difference of missing_conflict_m"};
};

/// Arbitrator of Sourav & Cheng 2024: DoC = 1 / (1 + exp(-slope (z - centre))).
struct ArbitratorSection {
  Policy policy = Policy::kTraded;
  double threshold = 0.5;
  double doc_slope_per_m = 10.0;
  double doc_centre_m = 1.0;
  ConflictReading conflict = ConflictReading::kMeanOfAbsolute;
  std::int64_t window_steps = 8;
  MissingLidar missing_lidar = MissingLidar::kHold;
  double missing_conflict_m = 10.0;
  MeasureChoice measure = MeasureChoice::kDoc;
  MeasureScale measure_scale = MeasureScale::kLogistic;
  double measure_slope = 10.0;
  double measure_centre = 0.5;
  double measure_offset_m = 0.0;
  BlameChoice blame = BlameChoice::kNis;
  double blame_threshold = 0.999;
  TransferSection transfer;
  AdaptiveSection adaptive;
  BayesSection bayes;
  AvailabilitySection availability;
  BlendSection blend;
  TakeOverSection take_over;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("policy", self.policy, "Who may drive.");
    visit.Number("threshold", self.threshold,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "DoC_th: the automation drives below it.",
                  .source = "Sourav & Cheng 2024: 0.2, 0.5, 0.8"});
    visit.Number("doc_slope_per_m", self.doc_slope_per_m,
                 {.min = 0.01,
                  .max = 1000,
                  .unit = "1/m",
                  .doc = "Slope of the DoC.",
                  .source = "Sourav & Cheng 2024: 10"});
    visit.Number("doc_centre_m", self.doc_centre_m,
                 {.min = 0,
                  .max = 100,
                  .unit = "m",
                  .doc = "Conflict z at which DoC is 1/2.",
                  .source = "Sourav & Cheng 2024: 1"});
    visit.Choice("conflict", self.conflict, "How z is read (the paper leaves it open).");
    visit.Integer(
        "window_steps", self.window_steps,
        {.min = 1,
         .max = 1000,
         .unit = "steps",
         .doc = "Window that z is averaged over.",
         .source = "our choice, because the paper prints none, and 5 to 10 steps meet its table"});
    visit.Choice("missing_lidar", self.missing_lidar,
                 "What a step without radar or LiDAR value counts as.");
    visit.Number("missing_conflict_m", self.missing_conflict_m,
                 {.min = 0,
                  .max = 1000,
                  .unit = "m",
                  .doc = "For missing_lidar conflict.",
                  .source = "our choice, because one missing value in a window of 8 steps then "
                            "passes the DoC's centre, 1 m"});
    visit.Choice("measure", self.measure,
                 "What the DoC is made of: z as above, or the score of another measure.");
    visit.Choice("measure_scale", self.measure_scale,
                 "What makes the DoC of a score, for any measure but doc.");
    visit.Number(
        "measure_slope", self.measure_slope,
        {.min = 1e-6,
         .max = 1e6,
         .unit = "",
         .doc = "For measure_scale logistic: slope of the DoC over the score.",
         .source = "our choice, because it is the paper's, and steep enough for scores in [0, 1]"});
    visit.Number("measure_centre", self.measure_centre,
                 {.min = -1e6,
                  .max = 1e6,
                  .unit = "",
                  .doc = "For measure_scale logistic: score at which DoC is 1/2.",
                  .source = "our choice, because it is the middle of scores in [0, 1]"});
    visit.Number("measure_offset_m", self.measure_offset_m,
                 {.min = -10,
                  .max = 10,
                  .unit = "m",
                  .doc = "Radar - LiDAR without a fault, as far as it is known; taken off for any "
                         "measure but doc, and for blame.",
                  .source = "our choice, because calibrated sensors have none"});
    visit.Choice("blame", self.blame,
                 "Which sensor is wrong, for policies that drop one: isolate, availability.");
    visit.Number(
        "blame_threshold", self.blame_threshold,
        {.min = 0,
         .max = 1,
         .unit = "",
         .doc = "Blame from which on the more blamed sensor is dropped.",
         .source =
             "our choice, because with nis one step in 1000 then drops a sensor without fault"});
    visit.Section("transfer", self.transfer, "How authority goes from one to the other.");
    visit.Section("adaptive", self.adaptive, "For policy adaptive.");
    visit.Section("bayes", self.bayes, "For policy bayes.");
    visit.Section("availability", self.availability, "For policy availability.");
    visit.Section("blend", self.blend, "For policy blend.");
    visit.Section("take_over", self.take_over, "Emergency fallback: a driver who must be asked.");
  }
};

}  // namespace fogline
