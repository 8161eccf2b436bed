// Sections of a scenario that say what happens on the road: the cars, the leader's speed, the fog.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/field.h"

namespace fogline {

/// The three cars at step 0 and how the world integrates them.
struct WorldSection {
  std::int64_t substeps = 1;
  bool end_on_collision = true;
  double vehicle_length_m = 4.5;
  double host_speed_mps = 20.0;
  double host_gap_m = 33.0;
  double follower_speed_mps = 20.0;
  double follower_gap_m = 33.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Integer(
        "substeps", self.substeps,
        {.min = 1,
         .max = 1000,
         .unit = "",
         .doc = "Integration steps within one simulation step.",
         .source = "our choice, because one is exact: accelerations are constant within a step"});
    visit.Flag("end_on_collision", self.end_on_collision,
               "End the run at the step in which cars collide; otherwise it is only recorded.");
    visit.Number("vehicle_length_m", self.vehicle_length_m,
                 {.min = 1,
                  .max = 30,
                  .unit = "m",
                  .doc = "Length of every car.",
                  .source = "CommonRoad vehicle 2 (BMW 320i): 4.508 m"});
    visit.Number(
        "host_speed_mps", self.host_speed_mps,
        {.min = 0,
         .max = 70,
         .unit = "m/s",
         .doc = "Host's speed at step 0.",
         .source = "our choice, because at the speed of the preceding car the gap is steady"});
    visit.Number(
        "host_gap_m", self.host_gap_m,
        {.min = 0.1,
         .max = 1000,
         .unit = "m",
         .doc = "Gap from the host to the preceding car at step 0, bumper to bumper.",
         .source =
             "our choice, because it is the ACC's own gap at 20 m/s: 1.5 s times 20 m/s and 3 m"});
    visit.Number("follower_speed_mps", self.follower_speed_mps,
                 {.min = 0,
                  .max = 70,
                  .unit = "m/s",
                  .doc = "Following car's speed at step 0.",
                  .source = "our choice, because at the speed of the host the gap is steady"});
    visit.Number("follower_gap_m", self.follower_gap_m,
                 {.min = 0.1,
                  .max = 1000,
                  .unit = "m",
                  .doc = "Gap from the following car to the host at step 0, bumper to bumper.",
                  .source = "our choice, because it is the following ACC's own gap at 20 m/s: 1.5 "
                            "s times 20 m/s and 3 m"});
  }
};

enum class LeadProfile { kConstant, kBreakpoints, kSinusoid, kEmergencyBrake, kRecorded };
template <>
struct ChoiceNames<LeadProfile> {
  static constexpr std::array<std::string_view, 5> kNames{"constant", "breakpoints", "sinusoid",
                                                          "emergency_brake", "recorded"};
  static constexpr std::array<std::string_view, 5> kDocs{
      "speed_mps throughout", "from speed_mps linearly to each breakpoint's speed in turn",
      "speed_mps and a sine on top", "speed_mps, then hard braking",
      "a recorded speed from a CSV file"};
};

/// The leader's speed changes linearly from the one before to `speed_mps` within `duration_s`.
struct SpeedBreakpoint {
  double duration_s = 1.0;
  double speed_mps = 20.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number(
        "duration_s", self.duration_s,
        {.min = 1e-3,
         .max = 1e5,
         .unit = "s",
         .doc = "Time to reach speed_mps.",
         .source =
             "our choice, because each breakpoint is the experiment's own; 1 s is a round number"});
    visit.Number("speed_mps", self.speed_mps,
                 {.min = 0,
                  .max = 70,
                  .unit = "m/s",
                  .doc = "Speed at the end of duration_s.",
                  .source = "our choice, because with lead.speed_mps a breakpoint that names no "
                            "speed changes none"});
  }
};

struct SinusoidSection {
  double amplitude_mps = 2.0;
  double period_s = 20.0;
  double start_s = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("amplitude_mps", self.amplitude_mps,
                 {.min = 0,
                  .max = 30,
                  .unit = "m/s",
                  .doc = "Amplitude; the speed stays >= 0.",
                  .source = "our choice, because with period_s it asks for at most 0.63 m/s2, "
                            "within the ACC's limits"});
    visit.Number("period_s", self.period_s,
                 {.min = 0.5,
                  .max = 1e4,
                  .unit = "s",
                  .doc = "Period of the sine.",
                  .source = "our choice, because with amplitude_mps it asks for at most 0.63 m/s2, "
                            "within the ACC's limits"});
    visit.Number(
        "start_s", self.start_s,
        {.min = 0,
         .max = 1e5,
         .unit = "s",
         .doc = "Time at which the sine sets in.",
         .source = "our choice, because a sine begins without a jump and needs no lead-in"});
  }
};

struct EmergencyBrakeSection {
  double start_s = 10.0;
  double deceleration_mps2 = 6.0;
  double final_speed_mps = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("start_s", self.start_s,
                 {.min = 0,
                  .max = 1e5,
                  .unit = "s",
                  .doc = "Time at which the braking sets in.",
                  .source = "our choice, because 10 s leave the gaps time to settle"});
    visit.Number("deceleration_mps2", self.deceleration_mps2,
                 {.min = 0.1,
                  .max = 12,
                  .unit = "m/s2",
                  .doc = "Deceleration of the leader.",
                  .source = "ASAM OSC-ALKS scenario 4.3_2: 6.0 m/s2"});
    visit.Number("final_speed_mps", self.final_speed_mps,
                 {.min = 0,
                  .max = 70,
                  .unit = "m/s",
                  .doc = "Speed at which the braking ends.",
                  .source = "our choice, because an emergency stop ends at rest"});
  }
};

/// Most speeds that a recorded leader may have: 27 hours of 0.1 s steps.
inline constexpr std::int64_t kMaxRecordedSpeeds = 1'000'000;

/// A recorded speed. LoadScenario reads the file and fills `speeds_mps` with its speed at each
/// step, so that no other machine needs the file. If the scenario has `speeds_mps`, `file` only
/// states the origin and is not read.
struct RecordedSection {
  std::string file;
  std::string time_column = "Time";
  std::string speed_column = "Speed1";
  double start_s = 0.0;
  std::vector<double> speeds_mps;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Text("file", self.file,
               "CSV file with a header line, relative to the scenario's folder; only a note where "
               "speeds_mps is given.");
    visit.Text("time_column", self.time_column, "Name of the column with the time in s.");
    visit.Text("speed_column", self.speed_column, "Name of the column with the speed in m/s.");
    visit.Number("start_s", self.start_s,
                 {.min = -1e9,
                  .max = 1e9,
                  .unit = "s",
                  .doc = "Time in the file at which step 0 lies.",
                  .source = "our choice, because most recordings count from 0; that of "
                            "recorded_lead.json begins at 200 s"});
    visit.Numbers("speeds_mps", self.speeds_mps,
                  {.min = 0,
                   .max = 70,
                   .unit = "m/s",
                   .doc = "Speed at steps 0, 1, 2 ..., instead of a file; the last one holds on.",
                   .source = "the recording that file names, or the scenario's own list"},
                  {.min_items = 0, .max_items = kMaxRecordedSpeeds, .doc = ""});
  }
};

/// Speed of the preceding car over time.
struct LeadSection {
  LeadProfile profile = LeadProfile::kConstant;
  double speed_mps = 20.0;
  std::vector<SpeedBreakpoint> breakpoints;
  SinusoidSection sinusoid;
  EmergencyBrakeSection emergency_brake;
  RecordedSection recorded;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("profile", self.profile, "Kind of speed profile.");
    visit.Number("speed_mps", self.speed_mps,
                 {.min = 0,
                  .max = 70,
                  .unit = "m/s",
                  .doc = "Speed at step 0 (of every profile but the recorded one).",
                  .source = "our choice, because the paper prints none; from 20 m/s on the limits "
                            "of ISO 15622 are the tightest"});
    visit.List("breakpoints", self.breakpoints,
               {.min_items = 0, .max_items = 10'000, .doc = "For profile breakpoints."});
    visit.Section("sinusoid", self.sinusoid, "For profile sinusoid.");
    visit.Section("emergency_brake", self.emergency_brake, "For profile emergency_brake.");
    visit.Section("recorded", self.recorded, "For profile recorded.");
    visit.Needs({.choice = "profile",
                 .value = "recorded",
                 .section = "recorded",
                 .fields = {"file", "speeds_mps"}});
  }
};

enum class FogModel { kNone, kBias, kBeam };
template <>
struct ChoiceNames<FogModel> {
  static constexpr std::array<std::string_view, 3> kNames{"none", "bias", "beam"};
  static constexpr std::array<std::string_view, 3> kDocs{
      "no fog", "the paper's: the LiDAR's range is short by a bias that follows the profile",
      "the physical one: attenuation, backscatter that can win over the target, dropouts"};
};

enum class FogProfile { kBox, kHalfSine, kRaisedCosine, kTriangle };
template <>
struct ChoiceNames<FogProfile> {
  static constexpr std::array<std::string_view, 4> kNames{"box", "half_sine", "raised_cosine",
                                                          "triangle"};
  static constexpr std::array<std::string_view, 4> kDocs{"1 throughout", "sin(pi x)",
                                                         "(1 - cos(2 pi x)) / 2", "1 - |2 x - 1|"};
};

/// Fog over time. Its level in [0, 1] follows `profile` over the window; the level scales the bias
/// (model bias) or the extinction coefficient between clear air and `visibility_m` (model beam).
struct FogSection {
  FogModel model = FogModel::kNone;
  FogProfile profile = FogProfile::kRaisedCosine;
  double start_s = 19.0;
  double duration_s = 11.0;
  double bias_m = 0.34;
  double visibility_m = 60.0;
  double clear_visibility_m = 20000.0;
  double rain_mmph = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("model", self.model, "How fog acts on the sensors.");
    visit.Choice("profile", self.profile,
                 "Level over the fog window; x runs from 0 to 1 within it.");
    visit.Number("start_s", self.start_s,
                 {.min = 0,
                  .max = 1e5,
                  .unit = "s",
                  .doc = "Begin of the fog window.",
                  .source = "Sourav & Cheng 2024: step 190"});
    visit.Number("duration_s", self.duration_s,
                 {.min = 0,
                  .max = 1e5,
                  .unit = "s",
                  .doc = "Length of the fog window; its end does not belong to it.",
                  .source = "Sourav & Cheng 2024: steps 190 to 300"});
    visit.Number("bias_m", self.bias_m,
                 {.min = 0,
                  .max = 100,
                  .unit = "m",
                  .doc = "Model bias: how much too short the LiDAR's range is at level 1.",
                  .source = "our choice, because the paper prints none, and 0.2 to 0.4 m meet its "
                            "table; paper.json has one that is calibrated"});
    visit.Number(
        "visibility_m", self.visibility_m,
        {.min = 5,
         .max = 1e5,
         .unit = "m",
         .doc = "Model beam: meteorological optical range (5 % contrast) at level 1.",
         .source =
             "our choice, because at 60 m the fog's echo wins over a car 33 m ahead: the crossover "
             "is at 23 m for a visibility of 50 m, at 31 m for 75 m (services/lidar)"});
    visit.Number("clear_visibility_m", self.clear_visibility_m,
                 {.min = 5,
                  .max = 1e5,
                  .unit = "m",
                  .doc = "Meteorological optical range at level 0.",
                  .source = "WMO: 20 km is very clear air"});
    visit.Number("rain_mmph", self.rain_mmph,
                 {.min = 0,
                  .max = 200,
                  .unit = "mm/h",
                  .doc = "Rain rate throughout; attenuates the radar (ITU-R P.838-3).",
                  .source = "our choice, because the paper's weather is fog alone"});
  }
};

}  // namespace fogline
