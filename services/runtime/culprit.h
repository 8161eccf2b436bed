// Who is to blame when inputs are lost: a role that falls silent silences all that depend on it, so
// what a role misses first is rarely what failed.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <string>

#include "services/graph.h"

namespace fogline {

/// Channels by their place in kChannels.
using ChannelSet = std::bitset<kNumChannels>;

/// What each role says it has lost, by its place in kRoles. A role that says nothing any more has
/// an empty set, whatever it said before.
using LostByRole = std::array<ChannelSet, kRoles.size()>;

struct Culprit {
  Role role;            // that fell silent
  std::size_t channel;  // by which it shows, a place in kChannels

  bool operator==(const Culprit&) const = default;
};

/// The most upstream of the lost inputs: the first one in the order of the graph table, in which a
/// step can be evaluated. If its producer has itself reported lost inputs, the blame goes on to the
/// first one of these, and so on; within a circle it stays where the circle closes.
/// @return nullopt if nothing is lost
std::optional<Culprit> FindCulprit(const ChannelSet& lost, const LostByRole& reported);

/// "lidar (LIDAR lost)".
std::string Text(const Culprit& culprit);

}  // namespace fogline
