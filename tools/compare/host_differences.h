// The differences between the host of a run and a recorded car.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "services/metrics/sample.h"
#include "tools/compare/recorded_car.h"

namespace fogline::compare {

/// Differences of one quantity between the run and the recording, over all steps.
class Differences {
 public:
  void Add(double ours, double recorded) {
    const double difference = ours - recorded;
    ++steps_;
    ours_ += ours;
    recorded_ += recorded;
    squares_ += difference * difference;
    largest_ = std::max(largest_, std::abs(difference));
  }
  std::int64_t steps() const { return steps_; }
  double mean() const { return ours_ / Count(); }
  double recorded_mean() const { return recorded_ / Count(); }
  double rmse() const { return std::sqrt(squares_ / Count()); }
  /// Standard deviation of the differences. Unlike rmse(), it does not contain the mean difference,
  /// because the mean difference depends on the time gap that is set for the host.
  double spread() const {
    const double bias = mean() - recorded_mean();
    return std::sqrt(std::max(0.0, squares_ / Count() - bias * bias));
  }
  double largest() const { return largest_; }

 private:
  double Count() const { return static_cast<double>(steps_); }

  std::int64_t steps_ = 0;
  double ours_ = 0;
  double recorded_ = 0;
  double squares_ = 0;
  double largest_ = 0;
};

/// Host and recorded car at the time of one step.
struct ComparedStep {
  double time_s;  // of the run
  double speed_mps;
  double recorded_speed_mps;
  double gap_m;
  double recorded_gap_m;
};

/// Host and recorded car in each step of the run.
/// @param start_s time of the recording that belongs to step 0
/// @pre the times of the recording ascend and cover the times of the run (CheckTimes())
std::vector<ComparedStep> CompareSteps(std::span<const metrics::Sample> run, double start_s,
                                       const RecordedCar& car);

struct HostDifferences {
  Differences speed_mps;
  Differences gap_m;
};
HostDifferences DifferencesOf(std::span<const ComparedStep> steps);

}  // namespace fogline::compare
