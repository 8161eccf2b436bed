#include "services/arbitrator/conflict_meter.h"

#include <cstddef>

namespace fogline {

ConflictMeter::ConflictMeter(const Scenario& scenario)
    : section_(scenario.arbitrator),
      window_(static_cast<std::size_t>(scenario.arbitrator.window_steps)),
      witness_(scenario.fusion) {
  if (section_.measure == MeasureChoice::kDoc) return;
  measure_ = RowOf(section_.measure).make(ConflictParametersOf(section_));
}

void ConflictMeter::Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
  if (!measure_) return window_.Push(Difference(radar, lidar));
  Evidence evidence{.radar = StatedBy(radar), .lidar = StatedBy(lidar), .prediction = {}};
  if (track.header.step == radar.header.step) {
    evidence.prediction = witness_.Prediction(track, radar, lidar);
  }
  score_ = measure_->Step(evidence);
}

// What this step counts as in the window.
std::optional<double> ConflictMeter::Difference(const radar_t& radar, const lidar_t& lidar) {
  if (radar.valid && lidar.valid) return last_difference_m_ = radar.range_m - lidar.range_m;
  switch (section_.missing_lidar) {
    case MissingLidar::kHold:
      return last_difference_m_;  // none before the first one
    case MissingLidar::kSkip:
      return std::nullopt;
    case MissingLidar::kConflict:
      return section_.missing_conflict_m;
  }
  return std::nullopt;
}

}  // namespace fogline
