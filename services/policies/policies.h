// THE table of policies: scenario files, processes, studies and tests come from it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "services/policies/policy.h"

namespace fogline {

struct PolicyRow {
  std::string_view name;  // in the scenario, lower_snake, unique
  std::string_view doc;   // in a line
  bool trusts;            // has a say in the fusion
  Rule rule;              // what its say in the arbitrator comes to
  bool uses_threshold;    // the scenario's threshold changes what it decides
  bool needs_true_gap;
  bool needs_surroundings;
  bool shares;
  std::unique_ptr<EngagementPolicy> (*make)(const Scenario& scenario);
};

/// The row of class P, which knows the rest of itself.
template <class P>
constexpr PolicyRow RowFor(std::string_view name, std::string_view doc) {
  constexpr bool kTrusts =
      !std::is_same_v<decltype(&P::TrustIn), decltype(&EngagementPolicy::TrustIn)>;
  return {.name = name,
          .doc = doc,
          .trusts = kTrusts,
          .rule = P::kRule,
          .uses_threshold = P::kUsesThreshold && P::kRule != Rule::kNever,
          .needs_true_gap = P::kNeedsTrueGap,
          .needs_surroundings = P::kNeedsSurroundings,
          .shares = P::kShares,
          .make = [](const Scenario& scenario) -> std::unique_ptr<EngagementPolicy> {
            return std::make_unique<P>(scenario);
          }};
}

/// All policies; `Policy` counts them.
std::span<const PolicyRow> Policies();

/// The scenario's row.
const PolicyRow& RowOf(Policy policy);

/// The policy of that name; nullopt if there is none.
std::optional<Policy> FindPolicy(std::string_view name);

}  // namespace fogline
