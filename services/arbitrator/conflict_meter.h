// Computes the Degree of Conflict, a number in [0, 1], from the sensors' values of every step.
#pragma once

#include <algorithm>
#include <memory>

#include "scenario/sections/scenario.h"
#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/over_time/doc.h"
#include "services/decision/policies/conflict_inputs.h"
#include "services/graph.h"

namespace fogline::arbitrator {

/// DoC = 1/(1 + exp(-slope (x - centre))). x depends on the scenario's measure. With measure `doc`,
/// x is the windowed conflict z of the paper (services/decision/conflict/over_time/doc.h). With
/// another measure, x is the measure's score (services/decision/conflict/conflict_measures.cc). If
/// measure_scale is `probability`, this formula does not apply: the DoC is the score itself.
class ConflictMeter {
 public:
  /// @throw InputError if measure_scale is `probability`, but the measure's score is not a
  /// probability
  explicit ConflictMeter(const Scenario& scenario);

  /// Adds the values of a step. Some measures compare the sensors with the range that the filter
  /// has predicted; `track` gives this prediction. `track` is used only if it belongs to the same
  /// step as `radar`.
  void Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
    conflict::Evidence evidence{
        .radar = policies::StatedBy(radar), .lidar = policies::StatedBy(lidar), .prediction = {}};
    if (!measure_) return doc_.Observe(evidence);
    if (track.header.step == radar.header.step) {
      evidence.prediction = witness_.Prediction(track, radar, lidar);
    }
    score_ = measure_->Step(evidence);
  }

  /// Conflict after the last observed step. With measure `doc` it is z, in m. With another measure
  /// it is the score, in the measure's own unit.
  double conflict() const { return measure_ ? score_ : doc_.conflict_m(); }
  /// The DoC for this value of conflict().
  double DocOf(double conflict) const {
    if (is_posterior_) return std::clamp(conflict, 0.0, 1.0);
    return conflict::DegreeOfConflict(conflict, slope_, centre_);
  }
  /// Whether the DoC is the posterior probability that a sensor is wrong, given all evidence so
  /// far.
  bool is_posterior() const { return is_posterior_; }

 private:
  bool is_posterior_ = false;
  double slope_;  // slope of the DoC over z or over the score
  double centre_;
  conflict::Doc doc_;
  policies::Witness witness_;
  std::unique_ptr<conflict::ConflictMeasure> measure_;  // null for measure `doc`
  double score_ = 0;
};

}  // namespace fogline::arbitrator
