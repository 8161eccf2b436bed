// Which measures of a run are known although its log lacks messages.
#pragma once

#include <bitset>
#include <string_view>

#include "services/graph.h"

namespace fogline::metrics {

/// The messages that the log of a run lacks.
struct Lack {
  std::bitset<kNumChannels> channels;  // the channels that lack a message after the first step
  bool beginning = false;              // whether the first steps are missing

  bool Any() const { return beginning || channels.any(); }
};

/// Whether a measure (a name of VisitMetrics()) is known. A measure is known if the log has all its
/// messages. Extremes and means over steps are always known: they are computed from the steps that
/// the log has. Sums over time, counts, and differences between steps are unknown if one of their
/// messages is missing. A measure that depends on the beginning of the run is unknown if the
/// beginning is missing.
bool IsKnown(std::string_view measure, const Lack& lack);

/// Whether the measures of requests to take over are known. These measures need every step of the
/// run.
bool AreTakeOversKnown(const Lack& lack);

}  // namespace fogline::metrics
