// The three ways in which a LiDAR fails in fog, and two human drivers. Studies run each of their
// variants with each of these ways and each of these humans.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"

namespace fogline::study {

inline constexpr std::string_view kPerfectHuman = "perfect human";
inline constexpr std::string_view kFallibleHuman = "fallible human";

/// One way in which a LiDAR fails.
struct FogMode {
  std::string_view name;
  std::string_view file;
  std::vector<std::string> overrides;

  /// The case of this fog with the overrides `more`, such as those of a human. `with` is the end of
  /// the case's name, such as "perfect human" in "bias fog: perfect human".
  StudyCase Case(std::string_view with, const std::vector<std::string>& more = {}) const;
};

/// The three modes: bias (paper.json), near echo (dense_fog.json), and missing echo (dense_fog.json
/// with overrides).
const std::vector<FogMode>& FogModes();
/// Text that explains the modes, for the method of a study.
std::string_view FogModesText();

/// Overrides for a human who sees the fog, misjudges distances and loses awareness.
const std::vector<std::string>& FallibleHuman();
/// A human with its overrides. The perfect human has no overrides.
struct HumanCase {
  std::string_view name;
  std::vector<std::string> overrides;
};
const std::vector<HumanCase>& BothHumans();
/// Text that explains the two humans, for the method of a study.
std::string_view HumansText();

}  // namespace fogline::study
