#include "services/arbitrator/conflict_meter.h"

#include <cstddef>

namespace fogline {

ConflictMeter::ConflictMeter(const Scenario& scenario)
    : reading_(scenario.arbitrator.conflict),
      missing_(scenario.arbitrator.missing_lidar),
      missing_conflict_m_(scenario.arbitrator.missing_conflict_m),
      slope_(scenario.arbitrator.doc_slope_per_m),
      centre_(scenario.arbitrator.doc_centre_m),
      window_(static_cast<std::size_t>(scenario.arbitrator.window_steps)),
      witness_(scenario.fusion) {
  const ArbitratorSection& section = scenario.arbitrator;
  if (section.measure == MeasureChoice::kDoc) return;
  measure_ = RowOf(section.measure).make(ConflictParametersOf(section));
  slope_ = section.measure_slope;
  centre_ = section.measure_centre;
}

void ConflictMeter::Measure(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
  Evidence evidence{.radar = StatedBy(radar), .lidar = StatedBy(lidar), .prediction = {}};
  if (track.header.step == radar.header.step) {
    evidence.prediction = witness_.Prediction(track, radar, lidar);
  }
  score_ = measure_->Step(evidence);
}

// What a step without both values counts as in the window.
std::optional<double> ConflictMeter::MissingDifference() const {
  switch (missing_) {
    case MissingLidar::kHold:
      return last_difference_m_;  // none before the first one
    case MissingLidar::kSkip:
      return std::nullopt;
    case MissingLidar::kConflict:
      return missing_conflict_m_;
  }
  return std::nullopt;
}

}  // namespace fogline
