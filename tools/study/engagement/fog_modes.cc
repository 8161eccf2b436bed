#include "tools/study/engagement/fog_modes.h"

#include <fmt/format.h>

namespace fogline::study {

StudyCase FogMode::Case(std::string_view with, const std::vector<std::string>& more) const {
  StudyCase one{.name = fmt::format("{}: {}", name, with),
                .file = std::string(file),
                .overrides = overrides,
                .group = std::string(name)};
  one.overrides.insert(one.overrides.end(), more.begin(), more.end());
  return one;
}

// In the mode with missing echoes, the echo of the fog itself is too weak to be detected. The fog
// is so dense that the echo of the car ahead is not detected either. Real data show this mode
// (RADIATE, Sheeny et al. 2021): 65 cars beyond 35 m give no echo, and the fog gives no echo
// either.
const std::vector<FogMode>& FogModes() {
  static const std::vector<FogMode> kModes{
      {"bias fog", "paper.json", {}},
      {"near echo fog", "dense_fog.json", {}},
      {"missing echo fog",
       "dense_fog.json",
       {"/fog/visibility_m=40", "/lidar/beam/backscatter_factor=0.001"}}};
  return kModes;
}

std::string_view FogModesText() {
  return "paper.json (fog biases the LiDAR's range), of dense_fog.json (the fog's own echo hides "
         "the car), and of dense_fog.json with a visibility of 40 m and a weak echo of the fog "
         "(there is no echo at all)";
}

const std::vector<std::string>& FallibleHuman() {
  static const std::vector<std::string> kOverrides{"/human/sight=fog", "/human/misjudges=true",
                                                   "/human/loses_awareness=true"};
  return kOverrides;
}

const std::vector<HumanCase>& BothHumans() {
  static const std::vector<HumanCase> kHumans{{kPerfectHuman, {}},
                                              {kFallibleHuman, FallibleHuman()}};
  return kHumans;
}

std::string_view HumansText() {
  return "The perfect human is the paper's. The fallible human sees only as far as the fog allows, "
         "misjudges distances and loses awareness while the automation drives.";
}

}  // namespace fogline::study
