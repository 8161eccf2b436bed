// What an experiment is: the whole scenario file, with defaults, ranges and sources.
// This header knows nothing of JSON; scenario/loader.h reads, checks and writes the files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenario/control.h"
#include "scenario/field.h"
#include "scenario/human.h"
#include "scenario/realtime.h"
#include "scenario/road.h"
#include "scenario/sensing.h"
#include "scenario/traffic.h"
#include "scenario/vehicle.h"

namespace fogline {

/// One row of a published table that the scenario is compared with.
struct PublishedRow {
  double threshold = 0.5;
  double si_pct = 0.0;
  double rhe_pct = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("threshold", self.threshold,
                 {.min = 0, .max = 1, .unit = "", .doc = "DoC threshold of the row."});
    visit.Number("si_pct", self.si_pct,
                 {.min = -1000, .max = 100, .unit = "%", .doc = "Safety improvement."});
    visit.Number("rhe_pct", self.rhe_pct,
                 {.min = 0, .max = 100, .unit = "%", .doc = "Redundant human engagement."});
  }
};

struct MeasuresSection {
  double safety_floor_m = 0.001;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("safety_floor_m", self.safety_floor_m,
                 {.min = 0,
                  .max = 10,
                  .unit = "m",
                  .doc = "SI looks at fog steps whose compromised safety without traded control is "
                         "above this.",
                  .source = "keeps the ratio away from 0/0"});
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
                  {.min = 1, .max = 1, .unit = "", .doc = "Version of this file format."});
    visit.Text("title", self.title, "One line that names the experiment.");
    visit.Text("description", self.description, "What it is for, and where its numbers come from.");
    visit.Integer("seed", self.seed,
                  {.min = 0,
                   .max = 9'007'199'254'740'991,
                   .unit = "",
                   .doc = "Seed of every random number of the run."});
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
