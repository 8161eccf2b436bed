// Measures of a run, computed from its samples alone, in one pass and constant memory. A run has
// the same measures, whether they are computed during the run or later from its log.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenario/sections/scenario.h"
#include "services/metrics/averaged_jerk.h"
#include "services/metrics/detection.h"
#include "services/metrics/fog_effect.h"
#include "services/metrics/running.h"
#include "services/metrics/sample.h"
#include "services/metrics/surrogate.h"
#include "services/metrics/track/track_judge.h"
#include "services/metrics/track/until_recovery.h"

namespace fogline::metrics {

/// Measures of one run. The values of a step count for the time until the next step. "Fog" is the
/// fog window; "clear air" is every step outside this window. A field is nullopt if the run has no
/// step that is relevant for the measure.
struct RunMetrics {
  /// Number of samples.
  std::int64_t steps = 0;
  /// Time from the first sample to the last, s.
  double duration_s = 0;

  /// Smallest true gap from the host to the preceding car, m.
  std::optional<double> min_host_gap_m;
  /// Smallest true gap from the first following car to the host, m.
  std::optional<double> min_follower_gap_m;
  /// Surrogate measures of safety (surrogate.h), such as the time to collision: of the host behind
  /// the preceding car, and of the first following car behind the host.
  PairMetrics host;
  PairMetrics follower;
  /// Largest compromised safety CS, m (Sourav & Cheng 2024; see CompromisedSafety).
  std::optional<double> max_compromised_safety_m;
  /// Mean of CS over the steps in fog, m.
  std::optional<double> mean_compromised_safety_fog_m;
  /// The largest CS and the mean CS, m, from the first step in fog to the last step that is in fog
  /// or has a wrong track (UntilRecovery). nullopt without fog.
  std::optional<double> max_compromised_safety_until_recovery_m;
  std::optional<double> mean_compromised_safety_until_recovery_m;
  /// Largest drop of the host's speed in fog below its speed when the fog began, m/s.
  std::optional<double> max_slow_down_fog_mps;
  /// First collision: truth_t::COLLISION_NONE, _HOST or _FOLLOWER.
  std::int8_t collision = truth_t::COLLISION_NONE;
  /// Simulated time of the first collision, s.
  std::optional<double> collision_time_s;

  /// Redundant human engagement: share of the steps in clear air in which the human is engaged, %.
  /// This definition is our interpretation. The literal meaning of the words of Sourav & Cheng 2024
  /// cannot give the 0 % that they print beside an SI of 80.79 %. Engaged means lambda_H > 0, as
  /// HumanIsEngaged() in services/host_modes.h. In traded control an engaged human drives. In
  /// shared control, an engaged human may have only a small part of the authority.
  std::optional<double> rhe_pct;
  /// Time during which the human is engaged, s. This time ends when the last step begins, because
  /// the command of the last step is never carried out.
  double human_time_s = 0;
  /// Number of transfers, in either direction. A transfer is a change of HumanDrives(lambda_H)
  /// (services/host_modes.h) from one step to the next. `fogline events` lists the same transfers,
  /// in the same steps.
  std::int64_t transfers = 0;
  /// Transfers per minute of the run, 1/min; nullopt for a run without duration.
  std::optional<double> transfers_pmin;
  /// Least time between two transfers, s; nullopt with fewer than two transfers.
  std::optional<double> min_dwell_s;
  /// Largest change of the commanded acceleration from the step before a transfer to the step of
  /// the transfer, m/s2; 0 without a transfer.
  double max_handover_jump_mps2 = 0;
  /// Largest |jerk| of the host within `handover_s` after a change of the authorities, m/s3;
  /// nullopt without a change. For a ramp of the authorities, the interval lasts from the ramp's
  /// first step until `handover_s` after the ramp's last step.
  std::optional<double> max_handover_jerk_mps3;
  /// Largest |jerk| of the host in the same intervals, averaged over 1 s (AveragedJerk), m/s3. The
  /// averaged second may begin before the change.
  std::optional<double> max_handover_jerk_1s_mps3;
  /// Time in which the wrong side drives, time from the LiDAR's deception to the alarm, and false
  /// alarms.
  DetectionMetrics detection;

  /// Largest applied |acceleration| of the host, m/s2. Step 0 has no applied acceleration.
  std::optional<double> max_abs_acceleration_mps2;
  /// Largest |jerk| of the host, m/s3: the change of the applied acceleration from one step to the
  /// next, divided by the time between them. So the jerk of a jump of the acceleration is larger if
  /// the steps are shorter.
  std::optional<double> max_abs_jerk_mps3;
  /// Largest |jerk| of the host, averaged over 1 s as in ISO 15622, m/s3 (AveragedJerk): the
  /// largest change of the applied acceleration within 1 s. This value does not depend on the
  /// length of a step.
  std::optional<double> max_abs_jerk_1s_mps3;
  /// Root of the mean square of the jerk from one step to the next, m/s3.
  std::optional<double> rms_jerk_mps3;

  /// Largest Degree of Conflict, in [0, 1].
  std::optional<double> max_doc;
  /// Smallest and largest conflict z in clear air, m. z is an average over a window of steps. Steps
  /// after the fog count as clear air, even if their window still contains steps in fog.
  std::optional<double> min_conflict_clear_m;
  std::optional<double> max_conflict_clear_m;
  /// Root of the mean square of fused distance minus true gap over the steps with a track, m.
  std::optional<double> rms_fusion_error_m;
  /// Time in a minimal risk manoeuvre, in which neither automation nor human drives, s.
  double minimal_risk_s = 0;
};

/// Calls `visit(name, value, unit, description)` for every measure in order; `name` contains the
/// unit. `value` is std::int64_t or std::optional<double>. The other arguments are
/// std::string_view. JSON, tables and reports use these calls.
template <class Visitor>
void VisitMetrics(const RunMetrics& m, Visitor&& visit);

/// The effect of the fog on a run, taken from the run's measures.
FogEffect FogEffectOf(const RunMetrics& measures);

/// Compromised safety of a step, m, of the first following car behind the host (surrogate.h). NaN
/// without a following car.
double CompromisedSafety(const Sample& sample);

/// Collects the measures of a run, sample by sample, in order of steps.
class MetricsAccumulator {
 public:
  /// Collects the measures of a run of this scenario. Uses the section `measures`, the offsets of
  /// the sensors, and the noise that the filter assumes.
  explicit MetricsAccumulator(const Scenario& scenario);
  /// Collects the measures of a run of a scenario with the defaults.
  MetricsAccumulator() : MetricsAccumulator(Scenario{}) {}

  void Add(const Sample& sample);

  /// Measures of the samples so far.
  RunMetrics Result() const;

 private:
  struct CompromisedSafetySums {
    std::optional<double> max_m;
    Mean mean_m;
  };

  void AddStep(const Sample& sample);
  void AddSafety(const Sample& sample);
  void AddPairs(const Sample& sample);
  void AddAuthority(const Sample& sample);
  void AddTransfer(const Sample& sample);
  void AddMotion(const Sample& sample);
  void AddSensing(const Sample& sample);

  double handover_s_;
  double step_s_;
  double command_lost_s_;              // the vehicle loses a command that is older
  std::optional<double> commanded_s_;  // time of the last step with a command
  bool stops_ = false;                 // whether the vehicle has lost the command
  PairAccumulator host_;
  PairAccumulator follower_;
  DetectionAccumulator detection_;
  RunMetrics metrics_;  // measures that Add() computes; Result() adds the others
  TrackJudge track_;
  FogEffectAccumulator fog_effect_;
  UntilRecovery<CompromisedSafetySums> compromised_safety_until_recovery_m_;
  AveragedJerk averaged_jerk_;
  Mean squared_jerk_m2ps6_;
  Mean squared_fusion_error_m2_;
  Mean human_in_clear_air_;  // 1 or 0 in each step
  double first_time_s_ = 0;
  std::optional<double> authority_changed_s_;  // time of the last change
  std::optional<double> transferred_s_;        // time of the last transfer
  std::optional<Sample> previous_;
};

/// Measures of a whole run of a scenario.
RunMetrics Measure(std::span<const Sample> samples, const Scenario& scenario = {});

template <class Visitor>
void VisitMetrics(const RunMetrics& m, Visitor&& visit) {
  const auto count = [&](std::string_view name, std::int64_t value, std::string_view unit,
                         std::string_view description) { visit(name, value, unit, description); };
  const auto number = [&](std::string_view name, std::optional<double> value, std::string_view unit,
                          std::string_view description) { visit(name, value, unit, description); };
  count("steps", m.steps, "", "samples of the run");
  number("duration_s", m.duration_s, "s", "time from the first sample to the last");
  number("min_host_gap_m", m.min_host_gap_m, "m", "host: smallest gap to the car ahead");
  number("min_follower_gap_m", m.min_follower_gap_m, "m",
         "following car: smallest gap to the car ahead");
  number("max_compromised_safety_m", m.max_compromised_safety_m, "m",
         "largest shortfall of the following car's safe distance");
  number("mean_compromised_safety_fog_m", m.mean_compromised_safety_fog_m, "m",
         "mean shortfall of the following car's safe distance in fog");
  number("max_compromised_safety_until_recovery_m", m.max_compromised_safety_until_recovery_m, "m",
         "largest shortfall from the beginning of the fog until the track has recovered");
  number("mean_compromised_safety_until_recovery_m", m.mean_compromised_safety_until_recovery_m,
         "m", "mean shortfall from the beginning of the fog until the track has recovered");
  number("max_slow_down_fog_mps", m.max_slow_down_fog_mps, "m/s",
         "largest drop of the host's speed in fog below its speed when the fog began");
  const auto pair = [&](const std::string& car, const std::array<std::string_view, 9>& names,
                        const PairMetrics& of) {
    number(names[0], of.min_ttc_s, "s", car + ": smallest time to collision (Hayward 1972)");
    number(names[1], of.tet_s, "s",
           car + ": time with a time to collision of at most TTC* (Minderhoud & Bovy 2001)");
    number(names[2], of.tit_s2, "s2",
           car + ": integral of TTC* - TTC over that time (Minderhoud & Bovy 2001)");
    number(names[3], of.min_time_gap_s, "s", car + ": smallest time gap, bumper to bumper");
    number(names[4], of.max_drac_mps2, "m/s2",
           car + ": largest deceleration rate to avoid a crash (Cooper & Ferguson 1976)");
    number(names[5], of.min_picud_m, "m",
           car + ": smallest gap left if both cars braked urgently, PICUD (Uno et al. 2002)");
    number(names[6], of.min_rss_margin_m, "m",
           car + ": smallest gap minus RSS safe distance (Shalev-Shwartz et al. 2017)");
    number(names[7], of.min_rss_margin_ad_rss_m, "m",
           car + ": the same margin with the parameters that ad-rss-lib suggests");
    number(names[8], of.cpi, "",
           car + ": crash potential index, in [0, 1] (Cunto & Saccomanno 2008)");
  };
  pair("host",
       {"min_host_ttc_s", "host_tet_s", "host_tit_s2", "min_host_time_gap_s", "max_host_drac_mps2",
        "min_host_picud_m", "min_host_rss_margin_m", "min_host_rss_margin_ad_rss_m", "host_cpi"},
       m.host);
  pair("following car",
       {"min_follower_ttc_s", "follower_tet_s", "follower_tit_s2", "min_follower_time_gap_s",
        "max_follower_drac_mps2", "min_follower_picud_m", "min_follower_rss_margin_m",
        "min_follower_rss_margin_ad_rss_m", "follower_cpi"},
       m.follower);
  count("collision", m.collision, "", "first collision: 0 none, 1 of the host, 2 of a follower");
  number("collision_time_s", m.collision_time_s, "s", "time of the first collision");
  number("rhe_pct", m.rhe_pct, "%",
         "redundant human engagement: share of clear air in which the human is engaged");
  number("human_time_s", m.human_time_s, "s", "time during which the human is engaged");
  count("transfers", m.transfers, "", "hand-overs in either direction");
  number("transfers_pmin", m.transfers_pmin, "1/min", "hand-overs per minute");
  number("min_dwell_s", m.min_dwell_s, "s", "smallest time between two hand-overs");
  number("max_handover_jump_mps2", m.max_handover_jump_mps2, "m/s2",
         "largest jump of the commanded acceleration at a hand-over");
  number("max_handover_jerk_mps3", m.max_handover_jerk_mps3, "m/s3",
         "largest jerk of the host within measures.handover_s after a change of the authorities");
  number("max_handover_jerk_1s_mps3", m.max_handover_jerk_1s_mps3, "m/s3",
         "the same, averaged over 1 s (ISO 15622)");
  number("wrong_human_s", m.detection.wrong_human_s, "s",
         "time, weighted by authority, in which the human drives although the LiDAR is right");
  number("wrong_automation_s", m.detection.wrong_automation_s, "s",
         "time, weighted by authority, in which the automation drives on a wrong track");
  number("deception_to_alarm_s", m.detection.deception_to_alarm_s, "s",
         "time from the first step with a LiDAR error above measures.lidar_tolerance_m until DoC "
         ">= threshold; 0 if DoC had reached it before");
  number("false_alarms_ph", m.detection.false_alarms_ph, "1/h",
         "alarms that begin in clear air, per hour of clear air");
  number("max_abs_acceleration_mps2", m.max_abs_acceleration_mps2, "m/s2",
         "largest acceleration or braking of the host");
  number("max_abs_jerk_mps3", m.max_abs_jerk_mps3, "m/s3", "largest jerk of the host");
  number("max_abs_jerk_1s_mps3", m.max_abs_jerk_1s_mps3, "m/s3",
         "largest jerk of the host, averaged over 1 s (ISO 15622)");
  number("rms_jerk_mps3", m.rms_jerk_mps3, "m/s3", "root mean square of the host's jerk");
  number("max_doc", m.max_doc, "", "largest Degree of Conflict");
  number("min_conflict_clear_m", m.min_conflict_clear_m, "m", "smallest conflict z in clear air");
  number("max_conflict_clear_m", m.max_conflict_clear_m, "m", "largest conflict z in clear air");
  number("rms_fusion_error_m", m.rms_fusion_error_m, "m",
         "root mean square of fused distance minus true gap");
  number("minimal_risk_s", m.minimal_risk_s, "s",
         "time in a minimal risk manoeuvre, in which neither automation nor human drives");
}

}  // namespace fogline::metrics
