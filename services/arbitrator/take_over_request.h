// When what became of a request to take over.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "services/arbitrator/take_over_table.h"

namespace fogline {

/// Least change of the command since the transfer by which an input counts as effective, in m/s2.
/// Chosen: 0.1 % of g, half of the jump at a transfer in the paper's experiment. No brake or engine
/// is set more finely.
inline constexpr double kEffectiveInput_mps2 = 0.01;

/// Whether a driver's command makes itself felt, by the one before the transfer.
inline bool IsEffective(double command_mps2, double before_transfer_mps2) {
  return std::abs(command_mps2 - before_transfer_mps2) >= kEffectiveInput_mps2;
}

/// The times of one request, as steps. What is empty has not been.
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
