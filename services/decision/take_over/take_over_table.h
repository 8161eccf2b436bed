// The state machine of a request to take over, as one table.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fogline/arbitration_t.hpp"

namespace fogline::take_over {

enum class TakeOverState : std::uint8_t {
  kAutomated,
  kDemand,        // the driver is asked
  kUrgentDemand,  // the driver is asked urgently
  kHandover,      // the driver has acknowledged, but may not be ready yet
  kRecovering,    // the driver has been driving for less than recovery_s
  kManual,
  kMrmComfort,    // minimal risk manoeuvre, first stage
  kMrmEmergency,  // minimal risk manoeuvre, second stage
  kMrmDone,       // the car stands until the end of the run
  kMrmFailed,     // the brake has not stopped the car in time; the manoeuvre continues
};

/// Conditions that can change the state in a step. Several conditions may be true in one step. The
/// first row of the table that applies then decides.
enum class TakeOverEvent : std::uint8_t {
  kWanted,        // the policy wants the human to drive
  kCalm,          // the policy does not want the human; a person must also give the authority back
  kEscalation,    // escalation_s after the request
  kAcknowledged,  // the driver has answered within lead_s
  kReady,         // the driver has answered, maybe late; readiness is at least required_readiness
  kDeadline,      // lead_s after the request
  kSevere,        // time to collision with the tracked car is below severe_ttc_s
  kRecovered,     // recovery_s after the transfer
  kStandstill,
  kOverdue,   // the stage of the manoeuvre has not stopped the car in time (kOverdueFactor)
  kOverride,  // the driver overrides by the brake (TakeOver)
  kGone,      // the person has left the seat (readiness 0), and may come back
};

/// The events of a step, one bit each.
using TakeOverEvents = std::uint16_t;
constexpr TakeOverEvents Bit(TakeOverEvent event) {
  return static_cast<TakeOverEvents>(1U << static_cast<unsigned>(event));
}

enum class TakeOverGuard : std::uint8_t {
  kAny,
  kFresh,  // there has been no minimal risk manoeuvre in this run
};

/// The side that has authority. The authority determines the acceleration that is applied.
enum class Authority : std::uint8_t {
  kAutomation,  // the automation's offer
  kEasing,      // the automation's offer, but at most a ramp that falls to -slow_down_mps2
  kHuman,       // the human's offer
  kComfort,     // no side: the manoeuvre with comfort_deceleration_mps2
  kHard,        // no side: the manoeuvre with emergency_deceleration_mps2
};

struct TakeOverRow {
  TakeOverState state;
  TakeOverEvent event;
  TakeOverGuard guard;
  TakeOverState next;
  Authority authority;  // from this step on
  std::string_view logged;
};

// clang-format off
namespace internal {
using enum TakeOverState;
using enum TakeOverEvent;
using enum TakeOverGuard;
using enum Authority;
using Row = TakeOverRow;

/// The rows of a state are tried in this order. If no row applies, state and authority do not
/// change. Sources, by paragraph of UN R157:
///   - A request to take over ends only when the automation is deactivated or the manoeuvre begins
///     (5.4.4). A change of the policy's engagement request does not end the request to take over.
///   - If the driver has not taken over, the manoeuvre begins lead_s after the request (5.4.4.1).
///     The manoeuvre begins earlier only in a severe situation (5.4.4.1.1).
///   - A driver who takes over late ends the manoeuvre in either stage, if the car still moves
///     (5.5.2, 5.5.3). The reason is that a driver who is present and able may always drive. SUMO's
///     ToC device has the same rule.
///   - After any manoeuvre, the automation is not activated again before the next run cycle
///     (5.5.5). The rule also applies if the driver has ended the manoeuvre. A car at standstill
///     does not drive off, because driving off (5.5.4) belongs to a new run.
///   - The manoeuvre never returns from its second stage to its first stage (Autoware's
///     mrm_handler).
///   - A driver who brakes harder than the car overrides without delay, with or without a request
///     (6.3). A car that stands after a manoeuvre stays locked.
inline constexpr std::array kTakeOverTable{
    //  state          event          guard   next           authority    logged
    Row{kAutomated,    kOverride,     kAny,   kRecovering,   kHuman,      "transfer to the human"},
    Row{kAutomated,    kWanted,       kAny,   kDemand,       kEasing,     "request to take over"},

    Row{kDemand,       kOverride,     kAny,   kRecovering,   kHuman,      "transfer to the human"},
    Row{kDemand,       kSevere,       kAny,   kMrmEmergency, kHard,       "manoeuvre: emergency stop"},
    Row{kDemand,       kAcknowledged, kAny,   kHandover,     kEasing,     "acknowledgement"},
    Row{kDemand,       kDeadline,     kAny,   kMrmComfort,   kComfort,    "manoeuvre: comfortable stop"},
    Row{kDemand,       kEscalation,   kAny,   kUrgentDemand, kEasing,     "urgent request to take over"},

    Row{kUrgentDemand, kOverride,     kAny,   kRecovering,   kHuman,      "transfer to the human"},
    Row{kUrgentDemand, kSevere,       kAny,   kMrmEmergency, kHard,       "manoeuvre: emergency stop"},
    Row{kUrgentDemand, kAcknowledged, kAny,   kHandover,     kEasing,     "acknowledgement"},
    Row{kUrgentDemand, kDeadline,     kAny,   kMrmComfort,   kComfort,    "manoeuvre: comfortable stop"},

    Row{kHandover,     kOverride,     kAny,   kRecovering,   kHuman,      "transfer to the human"},
    Row{kHandover,     kReady,        kAny,   kRecovering,   kHuman,      "transfer to the human"},
    Row{kHandover,     kSevere,       kAny,   kMrmEmergency, kHard,       "manoeuvre: emergency stop"},
    Row{kHandover,     kDeadline,     kAny,   kMrmComfort,   kComfort,    "manoeuvre: comfortable stop"},

    Row{kRecovering,   kGone,         kAny,   kMrmComfort,   kComfort,    "manoeuvre: comfortable stop"},
    Row{kRecovering,   kRecovered,    kAny,   kManual,       kHuman,      "human recovered"},

    Row{kManual,       kGone,         kAny,   kMrmComfort,   kComfort,    "manoeuvre: comfortable stop"},
    Row{kManual,       kCalm,         kFresh, kAutomated,    kAutomation, "transfer to the automation"},

    Row{kMrmComfort,   kStandstill,   kAny,   kMrmDone,      kHard,       "standstill, locked"},
    Row{kMrmComfort,   kReady,        kAny,   kRecovering,   kHuman,      "human ends manoeuvre"},
    Row{kMrmComfort,   kOverride,     kAny,   kRecovering,   kHuman,      "human ends manoeuvre"},
    Row{kMrmComfort,   kSevere,       kAny,   kMrmEmergency, kHard,       "manoeuvre: emergency stop"},
    Row{kMrmComfort,   kOverdue,      kAny,   kMrmEmergency, kHard,       "manoeuvre: emergency stop"},

    Row{kMrmEmergency, kStandstill,   kAny,   kMrmDone,      kHard,       "standstill, locked"},
    Row{kMrmEmergency, kReady,        kAny,   kRecovering,   kHuman,      "human ends manoeuvre"},
    Row{kMrmEmergency, kOverride,     kAny,   kRecovering,   kHuman,      "human ends manoeuvre"},
    Row{kMrmEmergency, kOverdue,      kAny,   kMrmFailed,    kHard,       "manoeuvre fails"},

    Row{kMrmFailed,    kStandstill,   kAny,   kMrmDone,      kHard,       "standstill, locked"},
    Row{kMrmFailed,    kReady,        kAny,   kRecovering,   kHuman,      "human ends manoeuvre"},
    Row{kMrmFailed,    kOverride,     kAny,   kRecovering,   kHuman,      "human ends manoeuvre"},
};
}  // namespace internal
// clang-format on

using internal::kTakeOverTable;

/// The row that applies in `state`; nullptr if the state does not change.
/// @param manoeuvred whether there has been a minimal risk manoeuvre in this run
constexpr const TakeOverRow* TakeOverRowOf(TakeOverState state, TakeOverEvents events,
                                           bool manoeuvred) {
  const auto* row = std::ranges::find_if(kTakeOverTable, [&](const TakeOverRow& r) {
    return r.state == state && (events & Bit(r.event)) != 0 &&
           (r.guard == TakeOverGuard::kAny || !manoeuvred);
  });
  return row == kTakeOverTable.end() ? nullptr : row;
}

/// Name of a state, and the mode of HOST_COMMAND that represents this state.
struct TakeOverStateInfo {
  TakeOverState state;
  std::int8_t mode;
  std::string_view name;
};

inline constexpr std::array kTakeOverStates{
    TakeOverStateInfo{TakeOverState::kAutomated, arbitration_t::AUTOMATION, "AUTOMATED"},
    TakeOverStateInfo{TakeOverState::kDemand, arbitration_t::REQUEST, "DEMAND"},
    TakeOverStateInfo{TakeOverState::kUrgentDemand, arbitration_t::REQUEST_URGENT, "DEMAND_URGENT"},
    TakeOverStateInfo{TakeOverState::kHandover, arbitration_t::HANDOVER, "HANDOVER"},
    TakeOverStateInfo{TakeOverState::kRecovering, arbitration_t::RECOVERING, "RECOVERING"},
    TakeOverStateInfo{TakeOverState::kManual, arbitration_t::HUMAN, "MANUAL"},
    TakeOverStateInfo{TakeOverState::kMrmComfort, arbitration_t::MRM_COMFORT, "MRM_COMFORT"},
    TakeOverStateInfo{TakeOverState::kMrmEmergency, arbitration_t::MRM_EMERGENCY, "MRM_EMERGENCY"},
    TakeOverStateInfo{TakeOverState::kMrmDone, arbitration_t::MRM_DONE, "MRM_DONE"},
    TakeOverStateInfo{TakeOverState::kMrmFailed, arbitration_t::MRM_FAILED, "MRM_FAILED"},
};

constexpr const TakeOverStateInfo& InfoOf(TakeOverState state) {
  return kTakeOverStates[static_cast<std::size_t>(state)];
}

/// The authority in a state. All rows that lead to this state have this authority.
constexpr Authority AuthorityOf(TakeOverState state) {
  return std::ranges::find(kTakeOverTable, state, &TakeOverRow::next)->authority;
}

static_assert(
    [] {
      for (std::size_t i = 0; i < kTakeOverStates.size(); ++i) {
        const TakeOverState state = kTakeOverStates[i].state;
        if (state != static_cast<TakeOverState>(i)) return false;
        if (std::ranges::count(kTakeOverTable, state, &TakeOverRow::next) == 0) return false;
      }
      return true;
    }(),
    "kTakeOverStates has each state at its place, and kTakeOverTable leads to each");

static_assert(
    [] {
      const auto same_change = [](const TakeOverRow& a, const TakeOverRow& b) {
        return a.state == b.state ? a.next == b.next : false;
      };
      for (const TakeOverRow& a : kTakeOverTable) {
        if (a.authority != AuthorityOf(a.next)) return false;
        for (const TakeOverRow& b : kTakeOverTable) {
          if (same_change(a, b) && a.logged != b.logged) return false;
        }
      }
      return true;
    }(),
    "a state has one authority for all changes to it, and a change of state has one log entry");

}  // namespace fogline::take_over
