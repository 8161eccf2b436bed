// Decides which sensor is not used, because it is wrong.
#pragma once

#include <memory>

#include "services/conflict/measures.h"
#include "services/policies/evidence.h"
#include "services/policies/policy.h"

namespace fogline {

/// Drops the sensor with the larger blame, by the scenario's measure of blame, if this blame is at
/// least blame_threshold. Never drops both. The witness is the filter's prediction.
class Isolation {
 public:
  explicit Isolation(const ArbitratorSection& section)
      : blame_(RowOf(section.blame).make(ConflictParametersOf(section))),
        threshold_(section.blame_threshold) {}

  Trust Judge(const Evidence& evidence) {
    const auto [radar, lidar] = blame_->Step(evidence);
    return {.radar = radar < threshold_ || radar <= lidar,
            .lidar = lidar < threshold_ || lidar <= radar};
  }

 private:
  std::unique_ptr<BlameMeasure> blame_;
  double threshold_;
};

}  // namespace fogline
