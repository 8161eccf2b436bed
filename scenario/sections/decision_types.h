// The types with which a scenario chooses its policy and its measures of conflict. decision.h has
// the lists of their values. A program with more policies or measures replaces decision.h, and each
// library file that includes decision.h (tests/integration/extension). So only the few files that
// need a list include decision.h. All other files include only the types.
#pragma once

#include <cstdint>

namespace fogline {

/// Policy for the authority over the host. The value is an index into the list in decision.h, and
/// into the table in services/decision/policies/policies.cc. Only two policies have an enumerator,
/// because other code refers to these two policies.
enum class Policy : std::uint8_t { kNone, kTraded };

/// A measure of conflict. The value is an index into the list in decision.h, and into the first
/// table in services/decision/conflict/conflict_measures.cc.
enum class MeasureChoice : std::uint8_t { kDoc };

/// A measure that tells which sensor is wrong. The value is an index into the list in decision.h,
/// and into the second table in conflict_measures.cc.
enum class BlameChoice : std::uint8_t { kNis };

}  // namespace fogline
