// The scenarios of study `conflict`: clear air, or fog of one visibility.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/scenario.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Visibility at which the fog model `bias` has the bias of paper.json, m.
inline constexpr double kReferenceVisibility_m = 60;
/// Length of the fog in paper.json, s.
inline constexpr double kFog_s = 11;
/// Name of the noise that the figures, most claims and the ROC use.
inline constexpr std::string_view kUsualNoise = "near-range";

/// Standard deviations of the measured ranges, m. The filter assumes these values, but at least
/// 0.04 m for the radar.
struct ConflictNoise {
  std::string_view name;
  double radar_m;
  double lidar_m;
};
/// All noises of the study.
std::span<const ConflictNoise> ConflictNoises();

/// A fog model, a noise, and further overrides of paper.json.
struct ConflictSituation {
  std::string_view fog;  // bias or beam
  ConflictNoise noise;
  std::vector<std::string> other{};  // in the form of --set
};

/// A scenario without fog that lasts kClearRun_s after the warm-up. The measures of conflict know
/// the mounting offset of the sensors: measure_offset_m is the radar's offset minus the LiDAR's
/// offset. The human always drives.
/// @throws InputError
Scenario ScenarioInClearAir(const StudyContext& context, const ConflictSituation& situation);

/// The scenario of ScenarioInClearAir(), but with fog. The fog begins after the warm-up and lasts
/// kFog_s, until the end. In the fog model `bias`, the bias is inversely proportional to the
/// visibility.
/// @throws InputError
Scenario ScenarioInFog(const StudyContext& context, const ConflictSituation& situation,
                       double visibility_m);

}  // namespace fogline::study
