// The whole scenario of an experiment, with defaults, ranges and sources. scenario/io/loader.h
// reads, checks and writes the JSON files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/aeb.h"
#include "scenario/sections/control.h"
#include "scenario/sections/field.h"
#include "scenario/sections/human.h"
#include "scenario/sections/person.h"
#include "scenario/sections/realtime.h"
#include "scenario/sections/road.h"
#include "scenario/sections/sensing.h"
#include "scenario/sections/traffic.h"
#include "scenario/sections/vehicle.h"

namespace fogline {

/// One row of a published table with which the scenario is compared.
struct PublishedRow {
  FOGLINE_FIELD(double, threshold, 0.5, {0, 1}, "DoC threshold of the row.",
                "Sourav & Cheng 2024: 0.2, 0.5, 0.8");
  FOGLINE_FIELD(double, si_pct, 0.0, {-1000, 100, "%"}, "Safety improvement.",
                "Sourav & Cheng 2024: 100, 80.79, 10.23");
  FOGLINE_FIELD(double, rhe_pct, 0.0, {0, 100, "%"}, "Redundant human engagement.",
                "Sourav & Cheng 2024: 100, 0, 0");

  bool operator==(const PublishedRow&) const = default;
};

/// Thresholds and parameters of the measures (services/metrics), with their sources.
struct MeasuresSection {
  FOGLINE_FIELD(double, safety_floor_m, 0.001, {0, 10, "m"},
                "SI counts only fog steps whose compromised safety without traded control is above "
                "this. SI depends on it: at threshold 0.5, SI of paper.json is 84.5 % with 20 mm "
                "and 68.5 % with 0 mm (fogline table prints such values).",
                "our choice, because it keeps the ratio away from 0/0");
  FOGLINE_FIELD(double, critical_ttc_s, 2.0, {0.1, 60, "s"},
                "TTC*: TET and TIT count only steps whose time to collision is at most this.",
                "CommonRoad-CriMe: 2 s; 1.5 to 4 s are in use");
  FOGLINE_FIELD(double, picud_braking_mps2, 3.3, {0.5, 12, "m/s2"},
                "Braking of both cars in PICUD.", "3.3 in the literature on PICUD");
  FOGLINE_FIELD(double, picud_reaction_s, 1.0, {0, 5, "s"},
                "Reaction time of the car behind in PICUD.", "1 s in the literature on PICUD");
  FOGLINE_FIELD(double, rss_response_s, 0.5, {0, 5, "s"}, "RSS: response time of the car behind.",
                "our choice, because at 20 m/s the safe distance is 22 m with this set of values, "
                "and 66 m with that of ad-rss-lib; the measures that end in rss_margin_ad_rss_m "
                "have ad-rss-lib's set");
  FOGLINE_FIELD(double, rss_acceleration_mps2, 2.0, {0, 10, "m/s2"},
                "RSS: acceleration of the car behind until it responds.",
                "our choice, because it belongs to the set of values that rss_response_s explains");
  FOGLINE_FIELD(double, rss_least_braking_mps2, 6.0, {0.5, 12, "m/s2"},
                "RSS: smallest braking of the car behind after its response time.",
                "our choice, because it belongs to the set of values that rss_response_s explains");
  FOGLINE_FIELD(double, rss_most_braking_mps2, 8.0, {0.5, 12, "m/s2"},
                "RSS: strongest braking of the car ahead.", "ad-rss-lib: 8");
  FOGLINE_FIELD(double, madr_mean_mps2, 8.45, {0.1, 20, "m/s2"},
                "CPI: mean of the maximum available deceleration of cars.",
                "Cunto & Saccomanno 2008, as CommonRoad-CriMe has it");
  FOGLINE_FIELD(double, madr_std_mps2, 1.40, {0.01, 10, "m/s2"},
                "CPI: standard deviation of this deceleration.",
                "Cunto & Saccomanno 2008, as CommonRoad-CriMe has it");
  FOGLINE_FIELD(double, madr_least_mps2, 4.23, {0, 10, "m/s2"},
                "CPI: smallest value of this deceleration.",
                "Cunto & Saccomanno 2008, as CommonRoad-CriMe has it");
  FOGLINE_FIELD(double, madr_most_mps2, 12.68, {10, 30, "m/s2"},
                "CPI: largest value of this deceleration.",
                "Cunto & Saccomanno 2008, as CommonRoad-CriMe has it");
  FOGLINE_FIELD(
      double, handover_s, 3.0, {0.01, 60, "s"},
      "Time after a change of the authorities in which jerk counts as that of the hand-over.",
      "our choice, because by default the longest ramp or gate is 2 s, and a car responds with a "
      "lag");
  FOGLINE_FIELD(
      double, lidar_tolerance_m, 0.1, {1e-3, 100, "m"},
      "Error from which on a distance counts as wrong: that of the LiDAR, and that of the "
      "track beyond the error that the sensors' offsets cause.",
      "our choice, because it is three times the accuracy of a Velodyne VLP-16, 3 cm");

  bool operator==(const MeasuresSection&) const = default;
};

/// Largest number of steps of a run.
inline constexpr std::int64_t kMostRunSteps = 10'000'000;

struct Scenario {
  FOGLINE_FIELD(std::int64_t, version, 1, {1, 1}, "Version of this file format.",
                "our choice, because formats count from 1");
  FOGLINE_FIELD(std::string, title, {}, "One line that names the experiment.");
  FOGLINE_FIELD(std::string, description, {},
                "Purpose of the experiment, and the sources of its numbers.");
  FOGLINE_FIELD(std::int64_t, seed, 1, {0, 9'007'199'254'740'991},
                "Seed of every random number of the run.",
                "our choice, because seeds count from 1; the paper names none");
  FOGLINE_FIELD(std::int64_t, steps, 500, {1, kMostRunSteps, "steps"}, "Length of the run.",
                "Sourav & Cheng 2024: 500");
  FOGLINE_FIELD(double, step_s, 0.1, {0.001, 1, "s"}, "Length of a step.",
                "Sourav & Cheng 2024: 0.1 s");
  FOGLINE_FIELD(WorldSection, world, {}, "The cars at step 0, and their integration.");
  FOGLINE_FIELD(RoadSection, road, {}, "Surface and slope of the road.");
  FOGLINE_FIELD(VehicleSection, host_vehicle, {}, "How the host carries out an acceleration.");
  FOGLINE_FIELD(VehicleSection, follower_vehicle, {},
                "How following cars carry out an acceleration.");
  FOGLINE_FIELD(LeadSection, lead, {}, "Speed of the preceding car.");
  FOGLINE_FIELD(FogSection, fog, {}, "Fog and rain over time.");
  FOGLINE_FIELD(RadarSection, radar, {}, "The host's radar.");
  FOGLINE_FIELD(LidarSection, lidar, {}, "The host's LiDAR.");
  FOGLINE_FIELD(FusionSection, fusion, {}, "Extended Kalman filter over radar and LiDAR.");
  FOGLINE_FIELD(AccSection, acc, {}, "The host's automation agent.");
  FOGLINE_FIELD(DriverSection, driver, {}, "The human driver of the host.");
  FOGLINE_FIELD(HumanSection, human, {},
                "Human weaknesses of the driver, which the paper's driver lacks.");
  FOGLINE_FIELD(PersonSection, person, {},
                "Real time: a person who drives in place of the model of a driver.");
  FOGLINE_FIELD(
      ArbitratorSection, arbitrator, {},
      "Rule that gives the authority over the host to automation or human, and its parameters.");
  FOGLINE_FIELD(AebSection, aeb, {},
                "Emergency braking of the host, on the fused track, whichever side drives.");
  FOGLINE_FIELD(AccSection, follower, {}, "ACC of the following car.");
  FOGLINE_FIELD(FollowersSection, followers, {}, "The cars behind the host, and their drivers.");
  FOGLINE_FIELD(HealthSection, health, {}, "Real time: when an input counts as stale or lost.");
  FOGLINE_FIELD(MinimalRiskSection, minimal_risk, {},
                "Real time: how a car stops when neither automation nor human drives it.");
  FOGLINE_FIELD(MeasuresSection, measures, {}, "Parameters of the measures.");
  FOGLINE_FIELD(std::vector<PublishedRow>, published, {}, {0, 100},
                "A published table; `fogline table` prints it beside its own.");

  bool operator==(const Scenario&) const = default;
};

}  // namespace fogline
