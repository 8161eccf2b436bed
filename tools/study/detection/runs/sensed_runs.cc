#include "tools/study/detection/runs/sensed_runs.h"

#include <algorithm>

#include "services/closed_loop/closed_loop.h"

namespace fogline::study {

Traffic TrafficOf(const Scenario& scenario) {
  Traffic traffic{.scenario = scenario, .moments = {}};
  closed_loop::ClosedLoop(scenario).Run(0, [&](const closed_loop::StepView& step) {
    traffic.moments.push_back({.truth = step.truth, .ego = step.ego});
  });
  return traffic;
}

SensorBench::SensorBench(const Traffic& traffic, std::span<const std::size_t> detectors)
    : traffic_(traffic),
      scenario_(traffic.scenario),
      filters_(
          !std::ranges::all_of(detectors, [](std::size_t d) { return Detectors()[d].is_quick; })),
      bank_(DetectorParameters(traffic.scenario), detectors) {}

}  // namespace fogline::study
