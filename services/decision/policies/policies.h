// The table of policies. Scenario files, processes, studies and tests use it.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

#include "services/decision/policies/policy.h"

namespace fogline::policies {

struct PolicyRow {
  std::string_view name;  // name in the scenario (scenario/sections/decision.h)
  bool selects_sensors;   // whether the policy selects sensors in the fusion
  Rule rule;              // how the policy decides in the arbitrator
  bool uses_threshold;    // whether the scenario's threshold affects the decisions
  bool needs_true_gap;
  bool needs_surroundings;
  bool shares;
  std::unique_ptr<EngagementPolicy> (*make)(const Scenario& scenario);
};

/// The row of policy class P; the constants and functions of P give all columns except the name.
template <class P>
constexpr PolicyRow RowFor(std::string_view name) {
  constexpr bool kSelectsSensors =
      !std::is_same_v<decltype(&P::SelectSensors), decltype(&EngagementPolicy::SelectSensors)>;
  return {.name = name,
          .selects_sensors = kSelectsSensors,
          .rule = P::kRule,
          .uses_threshold = P::kUsesThreshold && P::kRule != Rule::kNever,
          .needs_true_gap = P::kNeedsTrueGap,
          .needs_surroundings = P::kNeedsSurroundings,
          .shares = P::kShares,
          .make = [](const Scenario& scenario) -> std::unique_ptr<EngagementPolicy> {
            return std::make_unique<P>(scenario);
          }};
}

/// All policies. The value of a `Policy` is the index of its row.
std::span<const PolicyRow> Policies();

/// The row of this policy.
const PolicyRow& RowOf(Policy policy);

}  // namespace fogline::policies
