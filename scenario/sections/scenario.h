// The whole scenario of an experiment, with defaults, ranges and sources. scenario/io/loader.h
// reads, checks and writes the JSON files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/control.h"
#include "scenario/sections/field.h"
#include "scenario/sections/human.h"
#include "scenario/sections/realtime.h"
#include "scenario/sections/road.h"
#include "scenario/sections/sensing.h"
#include "scenario/sections/traffic.h"
#include "scenario/sections/vehicle.h"

namespace fogline {

/// One row of a published table that the scenario is compared with.
struct PublishedRow {
  double threshold = 0.5;
  double si_pct = 0.0;
  double rhe_pct = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("threshold", self.threshold,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "DoC threshold of the row.",
                  .source = "Sourav & Cheng 2024: 0.2, 0.5, 0.8"});
    visit.Number("si_pct", self.si_pct,
                 {.min = -1000,
                  .max = 100,
                  .unit = "%",
                  .doc = "Safety improvement.",
                  .source = "Sourav & Cheng 2024: 100, 80.79, 10.23"});
    visit.Number("rhe_pct", self.rhe_pct,
                 {.min = 0,
                  .max = 100,
                  .unit = "%",
                  .doc = "Redundant human engagement.",
                  .source = "Sourav & Cheng 2024: 100, 0, 0"});
  }
};

/// Thresholds and parameters of the measures (services/metrics), with their sources.
struct MeasuresSection {
  double safety_floor_m = 0.001;
  double critical_ttc_s = 2.0;
  double picud_braking_mps2 = 3.3;
  double picud_reaction_s = 1.0;
  double rss_response_s = 0.5;
  double rss_acceleration_mps2 = 2.0;
  double rss_least_braking_mps2 = 6.0;
  double rss_most_braking_mps2 = 8.0;
  double madr_mean_mps2 = 8.45;
  double madr_std_mps2 = 1.40;
  double madr_least_mps2 = 4.23;
  double madr_most_mps2 = 12.68;
  double handover_s = 3.0;
  double lidar_tolerance_m = 0.1;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("safety_floor_m", self.safety_floor_m,
                 {.min = 0,
                  .max = 10,
                  .unit = "m",
                  .doc = "SI looks at fog steps whose compromised safety without traded control is "
                         "above this.",
                  .source = "our choice, because it keeps the ratio away from 0/0"});
    visit.Number("critical_ttc_s", self.critical_ttc_s,
                 {.min = 0.1,
                  .max = 60,
                  .unit = "s",
                  .doc = "TTC*: TET and TIT look at steps whose time to collision is at most this.",
                  .source = "CommonRoad-CriMe: 2 s; 1.5 to 4 s are in use"});
    visit.Number("picud_braking_mps2", self.picud_braking_mps2,
                 {.min = 0.5,
                  .max = 12,
                  .unit = "m/s2",
                  .doc = "Braking of both cars in PICUD.",
                  .source = "3.3 in the literature on PICUD"});
    visit.Number("picud_reaction_s", self.picud_reaction_s,
                 {.min = 0,
                  .max = 5,
                  .unit = "s",
                  .doc = "Reaction time of the car behind in PICUD.",
                  .source = "1 s in the literature on PICUD"});
    const auto rss = [&](std::string_view name, auto& value, double least, double most,
                         std::string_view unit, std::string_view doc, std::string_view source) {
      visit.Number(name, value,
                   {.min = least, .max = most, .unit = unit, .doc = doc, .source = source});
    };
    rss("rss_response_s", self.rss_response_s, 0, 5, "s", "RSS: response time of the car behind.",
        "our choice, because ad-rss-lib's set (1 s; 3.5, 4 and 8 m/s2) demands 66 m at 20 m/s, "
        "this one 22 m");
    rss("rss_acceleration_mps2", self.rss_acceleration_mps2, 0, 10, "m/s2",
        "RSS: acceleration of the car behind until it responds.",
        "our choice, because of what rss_response_s says");
    rss("rss_least_braking_mps2", self.rss_least_braking_mps2, 0.5, 12, "m/s2",
        "RSS: braking that the car behind answers with at least.",
        "our choice, because of what rss_response_s says");
    rss("rss_most_braking_mps2", self.rss_most_braking_mps2, 0.5, 12, "m/s2",
        "RSS: strongest braking of the car ahead.", "ad-rss-lib: 8");
    const auto madr = [&](std::string_view name, auto& value, double least, double most,
                          std::string_view doc) {
      visit.Number(name, value,
                   {.min = least,
                    .max = most,
                    .unit = "m/s2",
                    .doc = doc,
                    .source = "Cunto & Saccomanno 2008, as CommonRoad-CriMe has it"});
    };
    madr("madr_mean_mps2", self.madr_mean_mps2, 0.1, 20,
         "CPI: mean of a car's maximum available deceleration.");
    madr("madr_std_mps2", self.madr_std_mps2, 0.01, 10, "CPI: its standard deviation.");
    madr("madr_least_mps2", self.madr_least_mps2, 0, 10, "CPI: no car has less.");
    madr("madr_most_mps2", self.madr_most_mps2, 10, 30, "CPI: no car has more.");
    visit.Number("handover_s", self.handover_s,
                 {.min = 0.01,
                  .max = 60,
                  .unit = "s",
                  .doc = "How long after a change of the authorities jerk counts as that of the "
                         "hand-over.",
                  .source = "our choice, because the longest ramp or gate by default is 2 s, and a "
                            "car has a lag"});
    visit.Number(
        "lidar_tolerance_m", self.lidar_tolerance_m,
        {.min = 1e-3,
         .max = 100,
         .unit = "m",
         .doc = "Error of a distance from which on it counts as wrong.",
         .source =
             "our choice, because it is three times the accuracy of a Velodyne VLP-16, 3 cm"});
  }
};

struct Scenario {
  std::int64_t version = 1;
  std::string title;
  std::string description;
  std::int64_t seed = 1;
  std::int64_t steps = 500;
  double step_s = 0.1;
  WorldSection world;
  RoadSection road;
  VehicleSection host_vehicle;
  VehicleSection follower_vehicle;
  LeadSection lead;
  FogSection fog;
  RadarSection radar;
  LidarSection lidar;
  FusionSection fusion;
  AccSection acc;
  DriverSection driver;
  HumanSection human;
  ArbitratorSection arbitrator;
  AccSection follower;
  FollowersSection followers;
  HealthSection health;
  MinimalRiskSection minimal_risk;
  MeasuresSection measures;
  std::vector<PublishedRow> published;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Integer("version", self.version,
                  {.min = 1,
                   .max = 1,
                   .unit = "",
                   .doc = "Version of this file format.",
                   .source = "our choice, because formats count from 1"});
    visit.Text("title", self.title, "One line that names the experiment.");
    visit.Text("description", self.description, "What it is for, and where its numbers come from.");
    visit.Integer("seed", self.seed,
                  {.min = 0,
                   .max = 9'007'199'254'740'991,
                   .unit = "",
                   .doc = "Seed of every random number of the run.",
                   .source = "our choice, because seeds count from 1; the paper names none"});
    visit.Integer("steps", self.steps,
                  {.min = 1,
                   .max = 10'000'000,
                   .unit = "steps",
                   .doc = "Length of the run.",
                   .source = "Sourav & Cheng 2024: 500"});
    visit.Number("step_s", self.step_s,
                 {.min = 0.001,
                  .max = 1,
                  .unit = "s",
                  .doc = "Length of a step.",
                  .source = "Sourav & Cheng 2024: 0.1 s"});
    visit.Section("world", self.world, "The cars at step 0, and their integration.");
    visit.Section("road", self.road, "What the cars drive on.");
    visit.Section("host_vehicle", self.host_vehicle, "How the host obeys its driver.");
    visit.Section("follower_vehicle", self.follower_vehicle, "How following cars obey theirs.");
    visit.Section("lead", self.lead, "Speed of the preceding car.");
    visit.Section("fog", self.fog, "Fog and rain over time.");
    visit.Section("radar", self.radar, "The host's radar.");
    visit.Section("lidar", self.lidar, "The host's LiDAR.");
    visit.Section("fusion", self.fusion, "Extended Kalman filter over both.");
    visit.Section("acc", self.acc, "The host's automation agent.");
    visit.Section("driver", self.driver, "The human driver of the host.");
    visit.Section("human", self.human, "What makes him more human than the paper's.");
    visit.Section("arbitrator", self.arbitrator, "Who drives the host.");
    visit.Section("follower", self.follower, "ACC of the following car.");
    visit.Section("followers", self.followers, "The cars behind the host, and who drives them.");
    visit.Section("health", self.health, "Real time: when an input counts as stale or lost.");
    visit.Section("minimal_risk", self.minimal_risk,
                  "Real time: how a car stops that nobody drives any more.");
    visit.Section("measures", self.measures, "How runs are judged.");
    visit.List("published", self.published,
               {.min_items = 0,
                .max_items = 100,
                .doc = "A published table; `fogline table` prints it beside its own."});
  }
};

}  // namespace fogline
