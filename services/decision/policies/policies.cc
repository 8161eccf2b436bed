#include "services/decision/policies/policies.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "scenario/sections/decision.h"
#include "services/decision/policies/adaptive.h"
#include "services/decision/policies/availability.h"
#include "services/decision/policies/bayes.h"
#include "services/decision/policies/blend.h"
#include "services/decision/policies/isolate.h"
#include "services/decision/policies/none.h"
#include "services/decision/policies/oracle.h"
#include "services/decision/policies/traded.h"
#include "services/decision/policies/traded_isolating.h"

namespace fogline::policies {
namespace {

// One row for each policy, in the order of scenario/sections/decision.h.
// clang-format off
constexpr std::array kPolicies{
    RowFor<None>("none"),
    RowFor<Traded>("traded"),
    RowFor<Isolate>("isolate"),
    RowFor<Oracle>("oracle"),
    RowFor<Blend>("blend"),
    RowFor<Adaptive>("adaptive"),
    RowFor<Bayes>("bayes"),
    RowFor<Availability>("availability"),
    RowFor<TradedIsolating>("traded_isolating"),
};
// clang-format on

static_assert(
    std::ranges::equal(kPolicies, ChoiceNames<Policy>::kNames, {}, &PolicyRow::name),
    "each policy has a line in scenario/sections/decision.h and a row here, in the same order");

}  // namespace

std::span<const PolicyRow> Policies() { return kPolicies; }

const PolicyRow& RowOf(Policy policy) { return kPolicies[static_cast<std::size_t>(policy)]; }

}  // namespace fogline::policies
