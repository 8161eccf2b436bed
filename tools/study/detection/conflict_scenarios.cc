#include "tools/study/detection/conflict_scenarios.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tools/study/detection/runs/clear_air.h"
#include "tools/study/sensor_noise.h"

namespace fogline::study {
namespace {

// The first noise is the optimistic noise of paper.json. The other noises are data sheet values of
// a Continental ARS408 radar with a Velodyne VLP-16 LiDAR: at near range, between near and far
// range, and at far range.
constexpr std::array kNoises{
    ConflictNoise{"calibrated", 0.01, 0.01}, ConflictNoise{kUsualNoise, 0.1, 0.03},
    ConflictNoise{"realistic", kRealisticNoise_m, 0.03}, ConflictNoise{"far-range", 0.4, 0.03}};

std::vector<std::string> OverridesOf(const ConflictSituation& situation) {
  const ConflictNoise& noise = situation.noise;
  std::vector<std::string> overrides = situation.other;
  overrides.insert(
      overrides.end(),
      {"/arbitrator/policy=traded", "/arbitrator/missing_lidar=conflict",
       "/arbitrator/threshold=0",  // the human drives throughout
       fmt::format("/fog/model={}", situation.fog), fmt::format("/fog/start_s={}", kWarmUp_s),
       fmt::format("/radar/range_std_m={}", noise.radar_m),
       fmt::format("/lidar/range_std_m={}", noise.lidar_m),
       fmt::format("/fusion/radar_range_std_m={}", std::max(noise.radar_m, 0.04)),
       fmt::format("/fusion/lidar_range_std_m={}", noise.lidar_m)});
  return overrides;
}

/// The scenario paper.json with these overrides. The run lasts for `duration_s` after the warm-up.
/// The measures of conflict know the mounting offset of the sensors.
Scenario ConflictScenario(const StudyContext& context, const std::vector<std::string>& overrides,
                          double duration_s) {
  Scenario scenario = context.Load("paper.json", overrides);
  scenario.arbitrator.measure_offset_m = scenario.radar.bias_m - scenario.lidar.bias_m;
  scenario.steps = std::llround((kWarmUp_s + duration_s) / scenario.step_s) + 1;
  return scenario;
}

}  // namespace

std::span<const ConflictNoise> ConflictNoises() { return kNoises; }

Scenario ScenarioInClearAir(const StudyContext& context, const ConflictSituation& situation) {
  std::vector<std::string> overrides = OverridesOf(situation);
  overrides.emplace_back("/fog/duration_s=0");
  return ConflictScenario(context, overrides, kClearRun_s);
}

Scenario ScenarioInFog(const StudyContext& context, const ConflictSituation& situation,
                       double visibility_m) {
  std::vector<std::string> overrides = OverridesOf(situation);
  overrides.push_back(fmt::format("/fog/visibility_m={}", visibility_m));
  overrides.push_back(fmt::format("/fog/duration_s={}", kFog_s));
  Scenario scenario = ConflictScenario(context, overrides, kFog_s);
  scenario.fog.bias_m *= kReferenceVisibility_m / visibility_m;
  return scenario;
}

}  // namespace fogline::study
