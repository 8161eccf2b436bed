#include "services/decision/policies/policies.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "services/decision/policies/adaptive.h"
#include "services/decision/policies/availability.h"
#include "services/decision/policies/bayes.h"
#include "services/decision/policies/blend.h"
#include "services/decision/policies/isolate.h"
#include "services/decision/policies/none.h"
#include "services/decision/policies/oracle.h"
#include "services/decision/policies/traded.h"

namespace fogline::policies {
namespace {

// One row for each policy. Scenario files, their schema and every list of policies have this order.
constexpr std::array kPolicies{
    RowFor<None>("none", "lambda_A = 1 throughout: no traded control"),
    RowFor<Traded>("traded", "the human drives while DoC >= threshold"),
    RowFor<Isolate>("isolate", "the automation drives, without the sensor that is to blame"),
    RowFor<Oracle>("oracle", "the automation drives, on the sensor that is nearer to the truth"),
    RowFor<Blend>("blend", "both drive, the human in proportion to the conflict"),
    RowFor<Adaptive>("adaptive", "as traded, with a threshold that moves with the situation"),
    RowFor<Bayes>("bayes", "as traded, with the threshold of least expected cost"),
    RowFor<Availability>("availability",
                         "as isolate, and as traded if the driver can be there in time"),
};

// The rows that have an enumerator.
static_assert(kPolicies[static_cast<std::size_t>(Policy::kNone)].name == "none");
static_assert(kPolicies[static_cast<std::size_t>(Policy::kTraded)].name == "traded");

template <auto kMember>
consteval auto Column() {
  std::array<std::string_view, kPolicies.size()> column;
  std::ranges::transform(kPolicies, column.begin(), kMember);
  return column;
}

constexpr auto kNameColumn = Column<&PolicyRow::name>();
constexpr auto kDocColumn = Column<&PolicyRow::doc>();

}  // namespace

std::span<const PolicyRow> Policies() { return kPolicies; }

const PolicyRow& RowOf(Policy policy) { return kPolicies[static_cast<std::size_t>(policy)]; }

std::optional<Policy> FindPolicy(std::string_view name) {
  const auto found = std::ranges::find(kPolicies, name, &PolicyRow::name);
  if (found == kPolicies.end()) return std::nullopt;
  return static_cast<Policy>(found - kPolicies.begin());
}

}  // namespace fogline::policies

namespace fogline {

constinit const std::span<const std::string_view> ChoiceNames<Policy>::kNames =
    policies::kNameColumn;
constinit const std::span<const std::string_view> ChoiceNames<Policy>::kDocs = policies::kDocColumn;

}  // namespace fogline
