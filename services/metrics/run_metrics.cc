#include "services/metrics/run_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/host_modes.h"

namespace fogline::metrics {
namespace {

constexpr double kPercent = 100.0;
constexpr double kSecondsPerMinute = 60.0;

std::optional<double> Root(std::optional<double> mean_square) {
  if (!mean_square) return std::nullopt;
  return std::sqrt(*mean_square);
}

/// The sample of a step without HOST_COMMAND, with the values of the HOST_COMMAND before.
Sample WithCommandOf(const Sample& before, const Sample& sample) {
  Sample filled = sample;
  filled.command_mps2 = before.command_mps2;
  filled.lambda_automation = before.lambda_automation;
  filled.lambda_human = before.lambda_human;
  filled.doc = before.doc;
  filled.threshold = before.threshold;
  return filled;
}

/// The values before the first HOST_COMMAND: the automation drives, and there is no alarm.
const Sample kBeforeTheFirstCommand{.threshold = std::numeric_limits<double>::infinity()};

}  // namespace

FogEffect FogEffectOf(const RunMetrics& measures) {
  return {.mean_compromised_safety_m = measures.mean_compromised_safety_fog_m,
          .slow_down_mps = measures.max_slow_down_fog_mps};
}

double CompromisedSafety(const Sample& sample) {
  return CompromisedSafety(sample.follower_safe_distance_m, sample.follower_gap_m);
}

MetricsAccumulator::MetricsAccumulator(const Scenario& scenario)
    : handover_s_(scenario.measures.handover_s),
      step_s_(scenario.step_s),
      command_lost_s_(std::max(scenario.health.stale_periods, scenario.health.lost_periods) *
                      scenario.step_s),
      host_(scenario.measures),
      follower_(scenario.measures),
      detection_(scenario),
      track_(scenario) {}

// In real time a step may lack HOST_COMMAND. The vehicle then keeps the last command until its
// input counts as lost. From then on it makes a minimal risk manoeuvre, in which it stays. The
// command of a step acts until the next step, so the age of the command at the end of the step
// decides.
void MetricsAccumulator::Add(const Sample& sample) {
  const bool has_command = !std::isnan(sample.lambda_human);
  if (has_command) commanded_s_ = sample.time_s;
  const double since_s = commanded_s_.value_or(previous_ ? first_time_s_ : sample.time_s);
  stops_ = stops_ || (!has_command && sample.time_s + step_s_ - since_s > command_lost_s_);
  if (has_command && !stops_) return AddStep(sample);
  Sample filled =
      has_command ? sample : WithCommandOf(previous_.value_or(kBeforeTheFirstCommand), sample);
  if (stops_) filled.lambda_automation = filled.lambda_human = 0;
  AddStep(filled);
}

// The command of a step is applied only in the next step. So the jerk of a step belongs to the
// transfers of earlier steps, and AddMotion() comes before AddAuthority().
void MetricsAccumulator::AddStep(const Sample& sample) {
  if (!previous_) first_time_s_ = sample.time_s;
  ++metrics_.steps;
  metrics_.duration_s = sample.time_s - first_time_s_;
  AddSafety(sample);
  AddPairs(sample);
  AddMotion(sample);
  AddAuthority(sample);
  AddSensing(sample);
  detection_.Add(sample);
  previous_ = sample;
}

void MetricsAccumulator::AddSafety(const Sample& sample) {
  const double compromised = CompromisedSafety(sample);
  Lower(metrics_.min_host_gap_m, sample.host_gap_m);
  Lower(metrics_.min_follower_gap_m, sample.follower_gap_m);
  Raise(metrics_.max_compromised_safety_m, compromised);
  fog_effect_.Add(sample);
  compromised_safety_until_recovery_m_.Step(sample.fog_present, track_.IsWrong(sample),
                                            [&](CompromisedSafetySums& sums) {
                                              Raise(sums.max_m, compromised);
                                              sums.mean_m.Add(compromised);
                                            });
  if (sample.collision != truth_t::COLLISION_NONE && !metrics_.collision_time_s) {
    metrics_.collision = sample.collision;
    metrics_.collision_time_s = sample.collision_time_s;
  }
}

void MetricsAccumulator::AddPairs(const Sample& sample) {
  const double since_s = previous_ ? sample.time_s - previous_->time_s : 0;
  host_.Add({sample.host_gap_m, sample.host_speed_mps, sample.preceding_speed_mps}, since_s);
  follower_.Add({sample.follower_gap_m, sample.follower_speed_mps, sample.host_speed_mps}, since_s);
}

void MetricsAccumulator::AddAuthority(const Sample& sample) {
  if (!sample.fog_present) human_in_clear_air_.Add(HumanIsEngaged(sample.lambda_human) ? 1 : 0);
  if (!previous_) return;
  if (previous_->lambda_automation == 0 && previous_->lambda_human == 0) {
    metrics_.minimal_risk_s += sample.time_s - previous_->time_s;
  }
  if (HumanIsEngaged(previous_->lambda_human)) {
    metrics_.human_time_s += sample.time_s - previous_->time_s;
  }
  if (sample.lambda_human != previous_->lambda_human ||
      sample.lambda_automation != previous_->lambda_automation) {
    authority_changed_s_ = sample.time_s;
  }
  if (HumanDrives(sample.lambda_human) != HumanDrives(previous_->lambda_human)) AddTransfer(sample);
}

void MetricsAccumulator::AddTransfer(const Sample& sample) {
  ++metrics_.transfers;
  metrics_.max_handover_jump_mps2 = std::max(
      metrics_.max_handover_jump_mps2, std::abs(sample.command_mps2 - previous_->command_mps2));
  if (transferred_s_) Lower(metrics_.min_dwell_s, sample.time_s - *transferred_s_);
  transferred_s_ = sample.time_s;
}

// Step 0 does not count, because no acceleration was applied before it.
void MetricsAccumulator::AddMotion(const Sample& sample) {
  if (sample.step == 0) return;
  Raise(metrics_.max_abs_acceleration_mps2, std::abs(sample.host_acceleration_mps2));
  const bool in_handover =
      authority_changed_s_ && sample.time_s - *authority_changed_s_ < handover_s_ + kSameTime_s;
  if (const auto mean_mps3 = averaged_jerk_.Add(sample.time_s, sample.host_acceleration_mps2)) {
    Raise(metrics_.max_abs_jerk_1s_mps3, *mean_mps3);
    if (in_handover) Raise(metrics_.max_handover_jerk_1s_mps3, *mean_mps3);
  }
  if (!previous_ || previous_->step == 0) return;
  const double jerk_mps3 = (sample.host_acceleration_mps2 - previous_->host_acceleration_mps2) /
                           (sample.time_s - previous_->time_s);
  Raise(metrics_.max_abs_jerk_mps3, std::abs(jerk_mps3));
  squared_jerk_m2ps6_.Add(jerk_mps3 * jerk_mps3);
  if (in_handover) Raise(metrics_.max_handover_jerk_mps3, std::abs(jerk_mps3));
}

void MetricsAccumulator::AddSensing(const Sample& sample) {
  Raise(metrics_.max_doc, sample.doc);
  if (!sample.fog_present) {
    Lower(metrics_.min_conflict_clear_m, sample.conflict_m);
    Raise(metrics_.max_conflict_clear_m, sample.conflict_m);
  }
  const double error = sample.fused_distance_m - sample.host_gap_m;
  squared_fusion_error_m2_.Add(error * error);
}

RunMetrics MetricsAccumulator::Result() const {
  RunMetrics result = metrics_;
  const FogEffect fog_effect = fog_effect_.Result();
  result.mean_compromised_safety_fog_m = fog_effect.mean_compromised_safety_m;
  result.max_slow_down_fog_mps = fog_effect.slow_down_mps;
  const CompromisedSafetySums& until_recovery = compromised_safety_until_recovery_m_.sums();
  result.max_compromised_safety_until_recovery_m = until_recovery.max_m;
  result.mean_compromised_safety_until_recovery_m = until_recovery.mean_m.Value();
  if (const auto share = human_in_clear_air_.Value()) result.rhe_pct = kPercent * *share;
  result.rms_jerk_mps3 = Root(squared_jerk_m2ps6_.Value());
  result.rms_fusion_error_m = Root(squared_fusion_error_m2_.Value());
  result.host = host_.Result();
  result.follower = follower_.Result();
  result.detection = detection_.Result();
  if (metrics_.duration_s > 0) {
    result.transfers_pmin =
        kSecondsPerMinute * static_cast<double>(metrics_.transfers) / metrics_.duration_s;
  }
  return result;
}

RunMetrics Measure(std::span<const Sample> samples, const Scenario& scenario) {
  MetricsAccumulator accumulator(scenario);
  for (const Sample& sample : samples) accumulator.Add(sample);
  return accumulator.Result();
}

}  // namespace fogline::metrics
