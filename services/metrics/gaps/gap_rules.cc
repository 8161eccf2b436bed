#include "services/metrics/gaps/gap_rules.h"

#include <algorithm>
#include <array>
#include <initializer_list>

namespace fogline::metrics {
namespace {

using Channels = std::bitset<kNumChannels>;

template <class... M>
Channels Of() {
  Channels channels;
  (channels.set(IndexOf<M>()), ...);
  return channels;
}

/// A measure that needs every step, the channels that it is computed from, and whether it also
/// needs the beginning of the run.
struct NeedsEveryStep {
  std::string_view measure;
  Channels channels;
  bool from_beginning = false;
};

const std::array kNeedsEveryStep = [] {
  const Channels truth = Of<truth_t>();
  const Channels command = Of<truth_t, arbitration_t>();
  const Channels deception = Of<truth_t, arbitration_t, lidar_t>();
  const Channels recovery = Of<truth_t, track_t, follower_command_t>();
  const Channels follower = Of<truth_t, follower_command_t>();
  return std::to_array<NeedsEveryStep>({
      {"max_compromised_safety_until_recovery_m", recovery, true},
      {"mean_compromised_safety_until_recovery_m", recovery, true},
      {"max_slow_down_fog_mps", truth, true},
      {"host_tet_s", truth},
      {"host_tit_s2", truth},
      {"host_cpi", truth},
      {"follower_tet_s", follower},
      {"follower_tit_s2", follower},
      {"follower_cpi", follower},
      {"rhe_pct", command},
      {"human_time_s", command},
      {"transfers", command},
      {"transfers_pmin", command},
      {"min_dwell_s", command},
      {"max_handover_jump_mps2", command},
      {"max_handover_jerk_mps3", command},
      {"max_handover_jerk_1s_mps3", command},
      {"wrong_human_s", deception},
      {"wrong_automation_s", Of<truth_t, arbitration_t, track_t>()},
      {"deception_to_alarm_s", deception, true},
      {"false_alarms_ph", deception},
      {"max_abs_jerk_mps3", truth},
      {"max_abs_jerk_1s_mps3", truth},
      {"rms_jerk_mps3", truth},
      {"minimal_risk_s", command},
  });
}();

}  // namespace

bool IsKnown(std::string_view measure, const Lack& lack) {
  if (lack.every_truth) return false;
  const auto* row = std::ranges::find(kNeedsEveryStep, measure, &NeedsEveryStep::measure);
  if (row == kNeedsEveryStep.end()) return true;
  return (row->channels & lack.channels).none() && !(row->from_beginning && lack.beginning);
}

bool AreTakeOversKnown(const Lack& lack) {
  return (Of<truth_t, arbitration_t, track_t, driver_command_t>() & lack.channels).none();
}

}  // namespace fogline::metrics
