// Table of the rule that decides which side drives the host if inputs of the arbitrator have
// failed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "services/input_state.h"

namespace fogline::arbitrator {

/// Availability of the automation or of the human, from best to worst. The values are bits, so that
/// a row of the table can name several values.
enum Offer : std::uint8_t {
  kThere = 1,   // usable; while the input is STALE, its last value is used
  kNotYet = 2,  // has not arrived yet, and is not overdue
  kGone = 4,    // LOST
};

constexpr Offer OfferOf(InputState state) {
  if (Usable(state)) return kThere;
  return state == InputState::kLost ? kGone : kNotYet;
}

/// The side that should drive according to the regular decision: the automation (kCalm) or the
/// human (kDisputed). The values are bits, so that a row of the table can name both values
/// (kAnyConflict).
enum Conflict : std::uint8_t { kCalm = 1, kDisputed = 2, kAnyConflict = kCalm | kDisputed };

enum class Decision : std::uint8_t {
  kRegular,      // both sides can drive: the decision is as in lockstep
  kAutomation,   // the human cannot drive, and there is no conflict
  kHuman,        // the automation cannot drive
  kHold,         // an input has not arrived yet, so the last command is repeated
  kMinimalRisk,  // the human has failed, and the automation has failed or is disputed
};

struct FailsafeRow {
  std::uint8_t automation;
  std::uint8_t human;
  std::uint8_t conflict;
  Decision decision;
};

// clang-format off
inline constexpr std::array kFailsafeTable{
    //          automation  human    conflict      decision
    FailsafeRow{kThere,     kThere,  kAnyConflict, Decision::kRegular},
    FailsafeRow{kThere,     kNotYet, kCalm,        Decision::kAutomation},
    FailsafeRow{kThere,     kNotYet, kDisputed,    Decision::kHold},
    FailsafeRow{kThere,     kGone,   kCalm,        Decision::kAutomation},
    FailsafeRow{kThere,     kGone,   kDisputed,    Decision::kMinimalRisk},
    FailsafeRow{kNotYet,    kThere,  kAnyConflict, Decision::kHuman},
    FailsafeRow{kNotYet,    kNotYet, kAnyConflict, Decision::kHold},
    FailsafeRow{kNotYet,    kGone,   kAnyConflict, Decision::kHold},
    FailsafeRow{kGone,      kThere,  kAnyConflict, Decision::kHuman},
    FailsafeRow{kGone,      kNotYet, kAnyConflict, Decision::kHold},
    FailsafeRow{kGone,      kGone,   kAnyConflict, Decision::kMinimalRisk},
};
// clang-format on

/// Whether the row applies to this case.
constexpr bool Applies(const FailsafeRow& row, Offer automation, Offer human, Conflict conflict) {
  return (row.automation & automation) != 0 && (row.human & human) != 0 &&
         (row.conflict & conflict) != 0;
}

/// The decision of the row that applies; exactly one row applies.
constexpr Decision Decide(Offer automation, Offer human, Conflict conflict) {
  return std::ranges::find_if(
             kFailsafeTable,
             [&](const FailsafeRow& row) { return Applies(row, automation, human, conflict); })
      ->decision;
}

static_assert(
    [] {
      for (const Offer automation : {kThere, kNotYet, kGone}) {
        for (const Offer human : {kThere, kNotYet, kGone}) {
          for (const Conflict conflict : {kCalm, kDisputed}) {
            if (std::ranges::count_if(kFailsafeTable, [&](const FailsafeRow& row) {
                  return Applies(row, automation, human, conflict);
                }) != 1) {
              return false;
            }
          }
        }
      }
      return true;
    }(),
    "exactly one row of kFailsafeTable applies to each case");

/// Text for STATUS that describes the fallback (the decision that replaces the regular decision);
/// "" if there is no fallback.
constexpr std::string_view FallbackText(Decision decision) {
  switch (decision) {
    case Decision::kRegular:
      return "";
    case Decision::kAutomation:
      return "the automation drives alone";
    case Decision::kHuman:
      return "the human drives";
    case Decision::kHold:
      return "the last command holds";
    case Decision::kMinimalRisk:
      return "minimal risk manoeuvre";
  }
  return "";
}

}  // namespace fogline::arbitrator
