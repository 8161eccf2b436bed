// Decides which sensor the fusion does not use, because this sensor seems to be wrong.
#pragma once

#include <memory>

#include "services/decision/conflict/conflict_measures.h"
#include "services/decision/policies/conflict_inputs.h"
#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// Excludes at most one sensor: the sensor that is more wrong than the other sensor, and whose
/// blame is at least blame_threshold. The scenario chooses the measure of blame. If both sensors
/// are equally wrong, no sensor is excluded.
class Isolation {
 public:
  explicit Isolation(const ArbitratorSection& section)
      : blame_(RowOf(section.blame).make(ConflictParametersOf(section))),
        threshold_(section.blame_threshold) {}

  SensorSelection Judge(const conflict::Evidence& evidence) {
    const conflict::Blame blame = blame_->Step(evidence);
    return {.radar = blame.radar < threshold_ || blame.radar_excess <= 0,
            .lidar = blame.lidar < threshold_ || blame.radar_excess >= 0};
  }

 private:
  std::unique_ptr<conflict::BlameMeasure> blame_;
  double threshold_;
};

}  // namespace fogline::policies
