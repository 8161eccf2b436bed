// Sections of a scenario that say what happens on the road: the cars, the leader's speed, the fog.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/field.h"

namespace fogline {

/// The cars at step 0, and how the world integrates their motion.
struct WorldSection {
  FOGLINE_FIELD(std::int64_t, substeps, 1, {1, 1000},
                "Integration steps within one simulation step.",
                "our choice, because one is exact: accelerations are constant within a step");
  FOGLINE_FIELD(bool, end_on_collision, true,
                "Whether the run ends at the step in which cars collide. Otherwise a collision is "
                "only recorded.");
  FOGLINE_FIELD(double, vehicle_length_m, 4.5, {1, 30, "m"}, "Length of every car.",
                "CommonRoad vehicle 2 (BMW 320i): 4.508 m");
  FOGLINE_FIELD(double, host_speed_mps, 20.0, {0, 70, "m/s"}, "Host's speed at step 0.",
                "our choice, because at the speed of the preceding car the gap is steady");
  FOGLINE_FIELD(
      double, host_gap_m, 33.0, {0.1, 1000, "m"},
      "Gap from the host to the preceding car at step 0, bumper to bumper.",
      "our choice, because it is the ACC's own gap at 20 m/s: 1.5 s times 20 m/s and 3 m");
  FOGLINE_FIELD(double, follower_speed_mps, 20.0, {0, 70, "m/s"},
                "Following car's speed at step 0.",
                "our choice, because at the speed of the host the gap is steady");
  FOGLINE_FIELD(double, follower_gap_m, 33.0, {0.1, 1000, "m"},
                "Gap from the following car to the host at step 0, bumper to bumper.",
                "our choice, because it is the following ACC's own gap at 20 m/s: 1.5 s times 20 "
                "m/s and 3 m");

  bool operator==(const WorldSection&) const = default;
};

enum class LeadProfile { kConstant, kBreakpoints, kSinusoid, kEmergencyBrake, kRecorded, kSumo };
constexpr auto ChoicesOf(LeadProfile) {
  return std::to_array<Choice>(
      {{"constant", "speed_mps throughout"},
       {"breakpoints", "from speed_mps linearly to each breakpoint's speed in turn"},
       {"sinusoid", "speed_mps plus a sine"},
       {"emergency_brake", "speed_mps, then hard braking"},
       {"recorded", "a recorded speed from a CSV file"},
       {"sumo", "the nearest of the cars that SUMO moves"}});
}

/// The leader's speed changes linearly from its last value to `speed_mps` within `duration_s`.
struct SpeedBreakpoint {
  FOGLINE_FIELD(
      double, duration_s, 1.0, {1e-3, 1e5, "s"}, "Time to reach speed_mps.",
      "our choice, because each breakpoint is the experiment's own; 1 s is a round number");
  FOGLINE_FIELD(double, speed_mps, 20.0, {0, 70, "m/s"}, "Speed at the end of duration_s.",
                "our choice, because it is the default of lead.speed_mps, so the first breakpoint "
                "changes nothing if both fields have their defaults");

  bool operator==(const SpeedBreakpoint&) const = default;
};

struct SinusoidSection {
  FOGLINE_FIELD(
      double, amplitude_mps, 2.0, {0, 30, "m/s"}, "Amplitude; the speed stays >= 0.",
      "our choice, because with period_s it asks for at most 0.63 m/s2, within the ACC's limits");
  FOGLINE_FIELD(double, period_s, 20.0, {0.5, 1e4, "s"}, "Period of the sine.",
                "our choice, because with amplitude_mps it asks for at most 0.63 m/s2, within the "
                "ACC's limits");
  FOGLINE_FIELD(double, start_s, 0.0, {0, 1e5, "s"}, "Time at which the sine begins.",
                "our choice, because a sine begins without a jump and needs no lead-in");

  bool operator==(const SinusoidSection&) const = default;
};

struct EmergencyBrakeSection {
  FOGLINE_FIELD(double, start_s, 10.0, {0, 1e5, "s"}, "Time at which the braking begins.",
                "our choice, because within 10 s the gaps settle");
  FOGLINE_FIELD(double, deceleration_mps2, 6.0, {0.1, 12, "m/s2"}, "Deceleration of the leader.",
                "ASAM OSC-ALKS scenario 4.3_2: 6.0 m/s2");
  FOGLINE_FIELD(double, final_speed_mps, 0.0, {0, 70, "m/s"}, "Speed at which the braking ends.",
                "our choice, because an emergency stop ends at rest");

  bool operator==(const EmergencyBrakeSection&) const = default;
};

/// Largest number of speeds of a recorded leader, enough for 27 hours with steps of 0.1 s.
inline constexpr std::int64_t kMaxRecordedSpeeds = 1'000'000;

/// A recorded speed. LoadScenario() reads the file and fills `speeds_mps` with the recorded speed
/// at each step, so that no other machine needs the file. If the scenario has `speeds_mps`, `file`
/// only states the origin and is not read.
struct RecordedSection {
  FOGLINE_FIELD(std::string, file, {},
                "CSV file with a header line, relative to the scenario's folder; without effect if "
                "speeds_mps is given.");
  FOGLINE_FIELD(std::string, time_column, "Time", "Name of the column with the time in s.");
  FOGLINE_FIELD(std::string, speed_column, "Speed1", "Name of the column with the speed in m/s.");
  FOGLINE_FIELD(double, start_s, 0.0, {-1e9, 1e9, "s"}, "Time in the file that belongs to step 0.",
                "our choice, because most recordings count from 0; that of recorded_lead.json "
                "begins at 200 s");
  FOGLINE_FIELD(std::vector<double>, speeds_mps, {}, {0, kMaxRecordedSpeeds}, {0, 70, "m/s"},
                "Speed at steps 0, 1, 2 ..., instead of a file; the last one stays.",
                "the recording that file names, or the scenario's own list");

  bool operator==(const RecordedSection&) const = default;
};

/// Largest number of lines of each of the two texts for SUMO: network and routes.
inline constexpr std::int64_t kMaxSumoLines = 200'000;

/// A traffic simulation by SUMO, with the host in it. LoadScenario() reads the two files and fills
/// `net` and `routes` with their lines, so that no other machine needs the files.
struct SumoSection {
  FOGLINE_FIELD(std::string, net_file, {},
                "SUMO's network (.net.xml), relative to the scenario's folder; without effect if "
                "net is given.");
  FOGLINE_FIELD(std::string, route_file, {},
                "SUMO's routes and cars (.rou.xml), relative to the scenario's folder; without "
                "effect if routes is given.");
  FOGLINE_FIELD(std::string, behind, {},
                "Name of the car of SUMO behind which the host begins, at world.host_gap_m. The "
                "host drives along the route of this car.");
  FOGLINE_FIELD(double, start_s, 1.0, {0.001, 1e5, "s"},
                "SUMO's time that belongs to step 0; SUMO's cars drive alone before it.",
                "our choice, because cars that depart at 0 s are then on the road");
  FOGLINE_FIELD(std::string, version, {},
                "SUMO's version, such as \"SUMO 1.15.0\"; a machine with another one refuses the "
                "scenario. If it is empty, a run states here the version that it has.");
  FOGLINE_FIELD(std::vector<std::string>, net, {}, {0, kMaxSumoLines},
                "Lines of the network, instead of net_file.");
  FOGLINE_FIELD(std::vector<std::string>, routes, {}, {0, kMaxSumoLines},
                "Lines of the routes and cars, instead of route_file.");

  bool operator==(const SumoSection&) const = default;
};

/// Speed of the preceding car over time.
struct LeadSection {
  FOGLINE_FIELD(LeadProfile, profile, LeadProfile::kConstant, "Kind of speed profile.");
  FOGLINE_FIELD(double, speed_mps, 20.0, {0, 70, "m/s"},
                "Speed at step 0, for every profile except recorded and sumo.",
                "our choice, because the paper prints none; from 20 m/s on the limits of ISO 15622 "
                "are the tightest");
  FOGLINE_FIELD(std::vector<SpeedBreakpoint>, breakpoints, {}, {0, 10'000},
                "For profile breakpoints: the speeds, in the order of time.");
  FOGLINE_FIELD(SinusoidSection, sinusoid, {}, "Parameters of profile sinusoid.");
  FOGLINE_FIELD(EmergencyBrakeSection, emergency_brake, {},
                "Parameters of profile emergency_brake.");
  FOGLINE_FIELD(RecordedSection, recorded, {}, "Parameters of profile recorded.",
                {.choice = "profile", .value = "recorded", .fields = {"file", "speeds_mps"}});
  FOGLINE_FIELD(SumoSection, sumo, {}, "Parameters of profile sumo.",
                {.choice = "profile", .value = "sumo", .fields = {"net_file", "net"}});

  bool operator==(const LeadSection&) const = default;
};

enum class FogModel { kNone, kBias, kBeam, kModes };
constexpr auto ChoicesOf(FogModel) {
  return std::to_array<Choice>(
      {{"none", "no fog"},
       {"bias", "the paper's: the LiDAR's range is too short by a bias that follows the profile"},
       {"beam",
        "the physical one: attenuation, dropouts, and backscatter that can be stronger than the "
        "target's echo"},
       {"modes",
        "a mixture by shares: in each step the LiDAR's value is right, too short by bias_m, a near "
        "echo of the fog, or missing"}});
}

/// Whether a fog model changes the visibility. With all other models, the visibility is always that
/// of clear air.
constexpr bool HasVisibility(FogModel model) {
  return model == FogModel::kBeam || model == FogModel::kModes;
}

enum class FogProfile { kBox, kHalfSine, kRaisedCosine, kTriangle };
constexpr auto ChoicesOf(FogProfile) {
  return std::to_array<Choice>({{"box", "1 throughout"},
                                {"half_sine", "sin(pi x)"},
                                {"raised_cosine", "(1 - cos(2 pi x)) / 2"},
                                {"triangle", "1 - |2 x - 1|"}});
}

/// Fog model `modes`: the shares of the steps in which the LiDAR fails in each way. The fog's level
/// scales the shares. In the remaining steps the value is right.
struct FogModesSection {
  FOGLINE_FIELD(double, biased_share, 0.0, {0, 1},
                "Share of steps in which the range is too short by fog.bias_m, at level 1.",
                "our choice, because no measurement is known");
  FOGLINE_FIELD(double, near_echo_share, 0.0, {0, 1},
                "Share of steps in which the range is that of a near echo of the fog, as in model "
                "beam, at level 1.",
                "our choice, because the drive in fog of RADIATE has none; others document such "
                "echoes, without a share (Hahner et al. 2021; Rasshofer et al. 2011)");
  FOGLINE_FIELD(double, missing_share, 1.0, {0, 1},
                "Share of steps in which a value beyond missing_beyond_m is missing, at level 1. "
                "The three shares together are at most 1.",
                "RADIATE (Sheeny et al. 2021), drive fog_6_0: beyond 35 m no car of 65 is seen");
  FOGLINE_FIELD(
      double, missing_from_m, 25.0, {0, 1000, "m"},
      "Range up to which no value is missing. From here on the share grows linearly.",
      "RADIATE (Sheeny et al. 2021), drive fog_6_0: every car up to 25 m is seen, 0.67 of "
      "those at 25 to 30 m, 0.12 of those at 30 to 35 m");
  FOGLINE_FIELD(double, missing_beyond_m, 35.0, {0, 1000, "m"},
                "Range beyond which the share is missing_share; below missing_from_m it counts as "
                "missing_from_m.",
                "RADIATE (Sheeny et al. 2021), drive fog_6_0: beyond 35 m no car of 65 is seen");

  bool operator==(const FogModesSection&) const = default;
};

/// Fog over time. Its level in [0, 1] follows `profile` over the window. The level scales the bias
/// (model bias), the extinction coefficient between clear air and `visibility_m` (models beam and
/// modes), and the shares of the modes (model modes).
struct FogSection {
  FOGLINE_FIELD(FogModel, model, FogModel::kNone, "How fog acts on the sensors.");
  FOGLINE_FIELD(FogProfile, profile, FogProfile::kRaisedCosine,
                "Level over the fog window; x runs from 0 to 1 within it.");
  FOGLINE_FIELD(double, start_s, 19.0, {0, 1e5, "s"}, "Beginning of the fog window.",
                "Sourav & Cheng 2024: step 190");
  FOGLINE_FIELD(double, duration_s, 11.0, {0, 1e5, "s"},
                "Length of the fog window, which excludes its end.",
                "Sourav & Cheng 2024: steps 190 to 300");
  FOGLINE_FIELD(double, bias_m, 0.34, {0, 100, "m"},
                "Error by which the LiDAR's range is too short: in model bias at level 1, in model "
                "modes in each biased step.",
                "our choice, because the paper prints none, and 0.2 to 0.4 m meet its table; "
                "paper.json has a calibrated value");
  FOGLINE_FIELD(
      double, visibility_m, 60.0, {5, 1e5, "m"},
      "Models beam and modes: meteorological optical range (5 % contrast) at level 1.",
      "our choice, because at 60 m the fog's echo is stronger than that of a car 33 m ahead: they "
      "are equal at 23 m for a visibility of 50 m, at 31 m for 75 m (services/lidar)");
  FOGLINE_FIELD(double, clear_visibility_m, 20000.0, {5, 1e5, "m"},
                "Meteorological optical range at level 0.", "WMO: 20 km is very clear air");
  FOGLINE_FIELD(double, rain_mmph, 0.0, {0, 200, "mm/h"},
                "Rain rate during the whole run. Rain attenuates the radar (ITU-R P.838-3).",
                "our choice, because the paper's weather is only fog");
  FOGLINE_FIELD(FogModesSection, modes, {}, "Parameters of model modes.");

  bool operator==(const FogSection&) const = default;
};

}  // namespace fogline
