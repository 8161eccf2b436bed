#include "tools/study/engagement/calibrated_radar.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fogline::study {

double StandstillWithoutOffset(const Scenario& scenario) {
  constexpr double kPerMetre = 1e4;
  const double standstill =
      scenario.world.host_gap_m - scenario.acc.headway_s * scenario.world.host_speed_mps;
  return std::max(0.0, std::round(standstill * kPerMetre) / kPerMetre);
}

std::vector<std::string> CalibratedRadar(const Scenario& scenario) {
  // The centre has seven decimals, because the offsets in scenario/ensemble have seven decimals.
  const double centre = scenario.arbitrator.doc_centre_m - scenario.radar.bias_m;
  return {"/radar/bias_m=0", fmt::format("/arbitrator/doc_centre_m={:.7f}", centre),
          fmt::format("/acc/standstill_m={:.4f}", StandstillWithoutOffset(scenario))};
}

}  // namespace fogline::study
