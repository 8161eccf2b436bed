// Which measures of a run are known although its log lacks messages.
#pragma once

#include <bitset>
#include <optional>
#include <string_view>
#include <type_traits>

#include "services/graph.h"

namespace fogline::metrics {

/// The messages that the log of a run lacks.
struct Lack {
  std::bitset<kNumChannels> channels;  // the channels that lack a message after the first step
  std::bitset<kNumChannels> every;     // the channels without a message in any step with TRUTH
  bool beginning = false;              // whether the first steps are missing
  bool end = false;                    // whether the log ends before the end of the run
  // Whether TRUTH messages are missing, and the last TRUTH of the run is one of them.
  bool last = false;
  // Whether a request to take over may have been open before the first HOST_COMMAND of the log.
  bool beginning_of_request = false;

  friend bool operator==(const Lack&, const Lack&) = default;
};

/// Whether a measure (a name of VisitMetrics()) is known. The table in gap_rules.cc says from which
/// channels a measure is computed, and which steps it needs:
/// - Sums over time, counts, shares of time, and differences between steps need every step. Such a
///   measure is unknown if a message of its channels is missing. A measure that depends on the
///   beginning of the run is also unknown if this beginning is missing.
/// - Extremes and means are computed from the steps that the log has. Such a measure is unknown if
///   the log has no message of one of its channels, or if the measure has no value and a missing
///   step might give it a value.
/// - The measures of a collision are unknown if they have no value and the last TRUTH is missing.
///   The last TRUTH is sufficient, because every TRUTH after a collision repeats the collision.
///
/// A measure that the table does not have is known only if nothing is missing.
bool IsKnown(std::string_view measure, bool has_value, const Lack& lack);

/// The same for a value that VisitMetrics() gives.
template <class V>
bool IsKnown(std::string_view measure, const V& value,
             const Lack& lack) requires(!std::is_same_v<V, bool>) {
  if constexpr (std::is_same_v<V, std::optional<double>>) {
    return IsKnown(measure, value.has_value(), lack);
  } else {
    return IsKnown(measure, value != 0, lack);
  }
}

/// Whether the measures of requests to take over are known. These measures need every TRUTH,
/// HOST_COMMAND, TRACK and DRIVER_COMMAND from the first step of the log on. If the log lacks the
/// beginning of a request, the measures of this request are unknown, and those of later requests
/// are known.
bool AreTakeOversKnown(const Lack& lack);

/// Whether the measures of requests are known, and the log has every step in which a request can
/// begin. So the number of requests is known, too, except those that emergency braking hides.
bool AreAllTakeOversKnown(const Lack& lack);

}  // namespace fogline::metrics
