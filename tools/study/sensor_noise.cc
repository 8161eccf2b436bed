#include "tools/study/sensor_noise.h"

#include <fmt/format.h>

namespace fogline::study {

const std::vector<std::string>& RealisticNoise() {
  static const std::vector<std::string> kOverrides{
      fmt::format("/radar/range_std_m={}", kRealisticNoise_m),
      fmt::format("/fusion/radar_range_std_m={}", kRealisticNoise_m)};
  return kOverrides;
}

StudyCase WithRealisticNoise(StudyCase one) {
  one.name += kWithRealisticNoise;
  one.overrides.insert(one.overrides.end(), RealisticNoise().begin(), RealisticNoise().end());
  return one;
}

std::string RealisticNoiseText() {
  return fmt::format("Realistic noise: a radar with a range noise of {} m, which the filter knows.",
                     kRealisticNoise_m);
}

}  // namespace fogline::study
