// Decides which sensor the fusion does not use, because this sensor seems to be wrong.
#pragma once

#include <memory>

#include "services/decision/conflict/conflict_measures.h"
#include "services/decision/policies/conflict_inputs.h"
#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// Excludes the sensor with the larger blame if this blame is at least blame_threshold. The
/// scenario chooses the measure of blame. If both blames are equal, no sensor is excluded. So at
/// least one sensor is always used.
class Isolation {
 public:
  explicit Isolation(const ArbitratorSection& section)
      : blame_(RowOf(section.blame).make(ConflictParametersOf(section))),
        threshold_(section.blame_threshold) {}

  SensorSelection Judge(const conflict::Evidence& evidence) {
    const auto [radar, lidar] = blame_->Step(evidence);
    return {.radar = radar < threshold_ || radar <= lidar,
            .lidar = lidar < threshold_ || lidar <= radar};
  }

 private:
  std::unique_ptr<conflict::BlameMeasure> blame_;
  double threshold_;
};

}  // namespace fogline::policies
