// Runs in which only the sensors are random. The human always drives and sees the truth, so the
// traffic does not depend on the sensors.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/decision/policies/conflict_inputs.h"
#include "services/fusion/fusion.h"
#include "services/lidar/lidar.h"
#include "services/radar/radar.h"
#include "tools/study/detection/detector_bank.h"

namespace fogline::study {

/// The traffic of a scenario, step by step. @pre the human always drives and makes no errors
struct Traffic {
  struct Moment {
    truth_t truth;
    ego_t ego;
  };
  Scenario scenario;
  std::vector<Moment> moments;
};

/// The traffic of the scenario, from one run of the closed loop.
Traffic TrafficOf(const Scenario& scenario);

/// Runs sensors, filter and detectors in the same traffic with one seed after the other. The scores
/// are equal to the scores in runs of the closed loop with these seeds, but such runs would take
/// more time. Only one thread may use a bench.
class SensorBench {
 public:
  /// @param traffic must outlive the bench
  /// @param detectors indices in Detectors(). If all of them are quick (Detector::is_quick), the
  ///     bench has no filter, because quick detectors need no prediction of the filter.
  SensorBench(const Traffic& traffic, std::span<const std::size_t> detectors);

  /// Calls `visit(truth, scores)` after each step, with the scores in the order of the detectors.
  template <class Visit>
  void Run(std::int64_t seed, Visit&& visit) {
    scenario_.seed = seed;
    radar::Radar radar(scenario_);
    lidar::Lidar lidar(scenario_);
    std::optional<fusion::Fusion> filter;
    std::optional<policies::Witness> witness;
    if (filters_) {
      filter.emplace(scenario_);
      witness.emplace(scenario_);
    }
    bank_.Reset();
    for (const Traffic::Moment& moment : traffic_.moments) {
      const radar_t& by_radar = radar.Step(moment.truth);
      const lidar_t& by_lidar = lidar.Step(moment.truth);
      conflict::Evidence evidence{.radar = policies::StatedBy(by_radar),
                                  .lidar = policies::StatedBy(by_lidar),
                                  .prediction = {}};
      if (filter) {
        evidence.prediction =
            witness->Prediction(filter->Step(moment.ego, by_radar, by_lidar), by_radar, by_lidar);
      }
      visit(moment.truth, bank_.Step(evidence));
    }
  }

 private:
  const Traffic& traffic_;
  Scenario scenario_;
  bool filters_;
  DetectorBank bank_;
};

}  // namespace fogline::study
