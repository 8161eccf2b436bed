// Which measures of a run are known although its log lacks messages.
#pragma once

#include <bitset>
#include <string_view>

#include "services/graph.h"

namespace fogline::metrics {

/// What the log of a run lacks.
struct Lack {
  std::bitset<kNumChannels> channels;  // the channels that lack a message after the first step
  bool beginning = false;              // whether the first steps are missing

  bool Any() const { return beginning || channels.any(); }
};

/// Whether a measure (a name of VisitMetrics()) is known. A measure whose messages are all there is
/// known. Extremes and means over steps are known, too: they are those of the steps that are there.
/// Unknown are sums over time, counts, and differences between steps, if one of their messages is
/// missing, and what depends on the beginning of the run, if the beginning is missing.
bool IsKnown(std::string_view measure, const Lack& lack);

/// Whether the measures of requests to take over are known. They need every step of the run.
bool AreTakeOversKnown(const Lack& lack);

}  // namespace fogline::metrics
