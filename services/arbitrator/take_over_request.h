// When what became of a request to take over.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "services/arbitrator/take_over_table.h"

namespace fogline {

/// Least change of the command by the driver alone by which an input counts as effective, in m/s2.
/// Chosen: 0.1 % of g, half of the jump at a transfer in the paper's experiment. No brake or engine
/// is set more finely.
inline constexpr double kEffectiveInput_mps2 = 0.01;

/// Whether what a driver offers makes itself felt: by his share of it, against the command before
/// he had one.
inline bool IsEffective(double lambda_human, double human_mps2, double before_mps2) {
  return std::abs(lambda_human * (human_mps2 - before_mps2)) >= kEffectiveInput_mps2;
}

/// The times of one request, as steps. What is empty has not been. To the state machine the driver
/// is there when he gets his share of the wheel (`transferred`), and it does not ask what he does
/// with it; a log tells from the authorities (take_over_log.h).
struct TakeOverRequest {
  std::int64_t requested = 0;
  std::optional<std::int64_t> escalated;
  std::optional<std::int64_t> acknowledged;
  std::optional<std::int64_t> transferred;
  std::optional<std::int64_t> effective;  // first effective input
  std::optional<std::int64_t> manoeuvre;  // begins
  std::optional<std::int64_t> standstill;

  /// The state changes in this step.
  void Enter(TakeOverState state, std::int64_t step) {
    using enum TakeOverState;
    if (state == kUrgentDemand) escalated = step;
    // Who comes during the manoeuvre answers by taking over.
    if (!acknowledged && (state == kHandover || state == kRecovering)) acknowledged = step;
    if (state == kRecovering) transferred = step;
    if (!manoeuvre && (state == kMrmComfort || state == kMrmEmergency)) manoeuvre = step;
    if (state == kMrmDone) standstill = step;
  }

  friend bool operator==(const TakeOverRequest&, const TakeOverRequest&) = default;
};

}  // namespace fogline
