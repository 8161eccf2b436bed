// The times of a request to take over.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "services/decision/take_over/take_over_table.h"

namespace fogline::take_over {

/// An input of the driver is effective if it changes the command by at least this number, in m/s2.
/// Our choice: 0.1 % of g. This is half of the jump of the command at a transfer in the paper's
/// experiment. No brake or engine has a finer setting.
inline constexpr double kEffectiveInput_mps2 = 0.01;

/// Whether the driver's offer changes the command by at least kEffectiveInput_mps2. The change is
/// the driver's share times the difference between the driver's offer and the last command before
/// the driver had a share.
inline bool IsEffective(double lambda_human, double human_mps2, double before_mps2) {
  return std::abs(lambda_human * (human_mps2 - before_mps2)) >= kEffectiveInput_mps2;
}

/// The times of one request, as steps. A field is empty if its event has not happened. In the state
/// machine, `transferred` is the step in which the driver gets a share of the authority, and
/// `effective` stays empty. TakeOverLog computes both fields from the authorities and commands
/// (take_over_log.h).
struct TakeOverRequest {
  std::int64_t requested = 0;
  std::optional<std::int64_t> escalated;
  std::optional<std::int64_t> acknowledged;
  std::optional<std::int64_t> transferred;
  std::optional<std::int64_t> effective;  // first effective input
  std::optional<std::int64_t> manoeuvre;  // beginning of the manoeuvre
  std::optional<std::int64_t> standstill;

  /// Records that the state has changed to `state` in this step.
  void Enter(TakeOverState state, std::int64_t step) {
    using enum TakeOverState;
    if (state == kUrgentDemand) escalated = step;
    // A driver who takes over during the manoeuvre also answers the request.
    if (!acknowledged && (state == kHandover || state == kRecovering)) acknowledged = step;
    if (state == kRecovering) transferred = step;
    if (!manoeuvre && (state == kMrmComfort || state == kMrmEmergency)) manoeuvre = step;
    if (state == kMrmDone) standstill = step;
  }

  friend bool operator==(const TakeOverRequest&, const TakeOverRequest&) = default;
};

}  // namespace fogline::take_over
