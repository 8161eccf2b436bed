#include "services/metrics/detection.h"

#include <algorithm>
#include <cmath>

namespace fogline::metrics {
namespace {

constexpr double kSecondsPerHour = 3600;

}  // namespace

double LidarError(const Sample& sample, const LidarSection& lidar) {
  // After a collision the gap is negative. The LiDAR then measures a gap of 0.
  const double gap_m = std::max(sample.host_gap_m, 0.0);
  const double right_m =
      std::sqrt(gap_m * gap_m + lidar.lateral_offset_m * lidar.lateral_offset_m) + lidar.bias_m;
  return sample.lidar_range_m - std::max(right_m, 0.0);
}

DetectionAccumulator::DetectionAccumulator(const Scenario& scenario)
    : tolerance_m_(scenario.measures.lidar_tolerance_m), lidar_(scenario.lidar), track_(scenario) {}

// A missing value (NaN) does not count as deceived.
bool DetectionAccumulator::IsDeceived(const Sample& sample) const {
  return std::abs(LidarError(sample, lidar_)) > tolerance_m_;
}

void DetectionAccumulator::Pass(double duration_s) {
  metrics_.wrong_human_s += wrong_human_ * duration_s;
  metrics_.wrong_automation_s += wrong_automation_ * duration_s;
  if (quiet_) quiet_s_ += duration_s;
}

void DetectionAccumulator::Add(const Sample& sample) {
  // If a log begins late and its first step has an alarm, the alarm may have begun earlier. So this
  // alarm does not count as a false alarm.
  const bool began_before = !begun_ && sample.step > 0;
  if (begun_) Pass(sample.time_s - time_s_);
  const bool deceived = IsDeceived(sample);
  const bool alarm = sample.doc >= sample.threshold;
  quiet_ = !deceived && !sample.fog_present;
  wrong_human_ = deceived ? 0 : sample.lambda_human;
  wrong_automation_ = track_.IsWrong(sample) ? sample.lambda_automation : 0;
  if (deceived && !onset_s_) onset_s_ = sample.time_s;
  if (alarm && onset_s_ && !metrics_.deception_to_alarm_s) {
    metrics_.deception_to_alarm_s = sample.time_s - *onset_s_;
  }
  if (alarm && !alarm_ && quiet_ && !began_before) ++false_alarms_;
  alarm_ = alarm;
  time_s_ = sample.time_s;
  begun_ = true;
}

DetectionMetrics DetectionAccumulator::Result() const {
  DetectionMetrics result = metrics_;
  if (quiet_s_ > 0) result.false_alarms_ph = kSecondsPerHour * false_alarms_ / quiet_s_;
  return result;
}

}  // namespace fogline::metrics
