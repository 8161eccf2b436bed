#include "services/decision/conflict/disagreement.h"

#include <algorithm>
#include <cmath>

namespace fogline::conflict {

double Disagreement::standardised() const { return difference_m / std::sqrt(variance_m2()); }

DisagreementSource::DisagreementSource(const ConflictParameters& parameters, Offset offset)
    : missing_(parameters.missing),
      missing_conflict_m_(parameters.missing_conflict_m),
      offset_m_(offset == Offset::kSubtracted ? parameters.offset_m : 0),
      smallest_std_m_(parameters.smallest_std_m),
      nominal_radar_std_m_(parameters.nominal_radar_std_m),
      nominal_lidar_std_m_(parameters.nominal_lidar_std_m) {
  Reset();
}

void DisagreementSource::Reset() {
  radar_std_m_ = nominal_radar_std_m_;
  lidar_std_m_ = nominal_lidar_std_m_;
  measured_.reset();
}

std::optional<Disagreement> DisagreementSource::Next(const Evidence& evidence) {
  if (evidence.radar.valid) radar_std_m_ = std::max(evidence.radar.std_m, smallest_std_m_);
  if (evidence.lidar.valid) lidar_std_m_ = std::max(evidence.lidar.std_m, smallest_std_m_);
  if (evidence.radar.valid && evidence.lidar.valid) {
    measured_ = Disagreement{evidence.radar.range_m - evidence.lidar.range_m - offset_m_,
                             radar_std_m_, lidar_std_m_};
    return measured_;
  }
  switch (missing_) {
    case MissingLidar::kHold:
      return measured_;
    case MissingLidar::kSkip:
      return std::nullopt;
    case MissingLidar::kConflict:
      return Disagreement{missing_conflict_m_, radar_std_m_, lidar_std_m_};
  }
  return std::nullopt;
}

}  // namespace fogline::conflict
