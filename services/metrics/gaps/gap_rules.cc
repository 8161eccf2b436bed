#include "services/metrics/gaps/gap_rules.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace fogline::metrics {
namespace {

using Channels = std::bitset<kNumChannels>;

template <class... M>
Channels Of() {
  Channels channels;
  (channels.set(IndexOf<M>()), ...);
  return channels;
}

/// The steps that a measure needs.
enum class Needs : std::uint8_t {
  // The steps in the log are enough if they give the measure a value. If they give no value, the
  // log must have every step, because a missing step might give a value.
  kAnyStep,
  // The steps in the log are enough if they give the measure a value. If they give no value, the
  // log must have the last step, because the last step repeats a value of an earlier step.
  kLaterStep,
  kEveryStep,
  kEveryStepFromTheBeginning
};

struct GapRule {
  std::string_view measure;
  Channels channels;  // the channels from which the measure is computed
  Needs needs = Needs::kAnyStep;
};

const std::array kGapRules = [] {
  using enum Needs;
  const Channels truth = Of<truth_t>();
  const Channels command = Of<truth_t, arbitration_t>();
  const Channels deception = Of<truth_t, arbitration_t, lidar_t>();
  const Channels recovery = Of<truth_t, track_t, follower_command_t>();
  const Channels follower = Of<truth_t, follower_command_t>();
  return std::to_array<GapRule>({
      {"steps", truth},
      {"duration_s", truth},
      {"min_host_gap_m", truth},
      {"min_follower_gap_m", truth},
      {"max_compromised_safety_m", follower},
      {"mean_compromised_safety_fog_m", follower},
      {"max_compromised_safety_until_recovery_m", recovery, kEveryStepFromTheBeginning},
      {"mean_compromised_safety_until_recovery_m", recovery, kEveryStepFromTheBeginning},
      {"max_slow_down_fog_mps", truth, kEveryStepFromTheBeginning},
      {"min_host_ttc_s", truth},
      {"host_tet_s", truth, kEveryStep},
      {"host_tit_s2", truth, kEveryStep},
      {"min_host_time_gap_s", truth},
      {"max_host_drac_mps2", truth},
      {"min_host_picud_m", truth},
      {"min_host_rss_margin_m", truth},
      {"min_host_rss_margin_ad_rss_m", truth},
      {"host_cpi", truth, kEveryStep},
      {"min_follower_ttc_s", truth},
      {"follower_tet_s", truth, kEveryStep},
      {"follower_tit_s2", truth, kEveryStep},
      {"min_follower_time_gap_s", truth},
      {"max_follower_drac_mps2", truth},
      {"min_follower_picud_m", truth},
      {"min_follower_rss_margin_m", truth},
      {"min_follower_rss_margin_ad_rss_m", truth},
      {"follower_cpi", truth, kEveryStep},
      {"collision", truth, kLaterStep},
      {"collision_time_s", truth, kLaterStep},
      {"rhe_pct", command, kEveryStep},
      {"human_time_s", command, kEveryStep},
      {"transfers", command, kEveryStep},
      {"transfers_pmin", command, kEveryStep},
      {"min_dwell_s", command, kEveryStep},
      {"max_handover_jump_mps2", command, kEveryStep},
      {"max_handover_jerk_mps3", command, kEveryStep},
      {"max_handover_jerk_1s_mps3", command, kEveryStep},
      {"wrong_human_s", deception, kEveryStep},
      {"wrong_automation_s", Of<truth_t, arbitration_t, track_t>(), kEveryStep},
      {"deception_to_alarm_s", deception, kEveryStepFromTheBeginning},
      {"false_alarms_ph", deception, kEveryStep},
      {"max_abs_acceleration_mps2", truth},
      {"max_abs_jerk_mps3", truth, kEveryStep},
      {"max_abs_jerk_1s_mps3", truth, kEveryStep},
      {"rms_jerk_mps3", truth, kEveryStep},
      {"max_doc", command},
      {"min_conflict_clear_m", command},
      {"max_conflict_clear_m", command},
      {"rms_fusion_error_m", Of<truth_t, track_t>()},
      {"minimal_risk_s", command, kEveryStep},
  });
}();

}  // namespace

bool IsKnown(std::string_view measure, bool has_value, const Lack& lack) {
  const auto* rule = std::ranges::find(kGapRules, measure, &GapRule::measure);
  if (rule == kGapRules.end()) return lack == Lack();
  if ((rule->channels & lack.every).any()) return false;
  const bool lacks_a_step = (rule->channels & lack.channels).any();
  switch (rule->needs) {
    case Needs::kAnyStep:
      return has_value || !(lacks_a_step || lack.beginning);
    case Needs::kLaterStep:
      return has_value || !lack.last;
    case Needs::kEveryStep:
      return !lacks_a_step;
    case Needs::kEveryStepFromTheBeginning:
      return !(lacks_a_step || lack.beginning);
  }
  return false;
}

bool AreTakeOversKnown(const Lack& lack) {
  const Channels needed = Of<truth_t, arbitration_t, track_t, driver_command_t>();
  return (needed & lack.channels).none() && !lack.every[IndexOf<arbitration_t>()];
}

bool AreAllTakeOversKnown(const Lack& lack) {
  return AreTakeOversKnown(lack) && !lack.beginning && !lack.beginning_of_request && !lack.end;
}

}  // namespace fogline::metrics
