// Which role is to blame when inputs are lost. If a role falls silent, all roles that depend on it
// fall silent, too. So the channel that a role misses first is rarely a channel of the failed role.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <string>

#include "services/graph.h"

namespace fogline::runtime {

/// Channels by their place in kChannels.
using ChannelSet = std::bitset<kNumChannels>;

/// The lost inputs that each role reports, by its place in kRoles. A silent role has an empty set,
/// whatever it reported before.
using LostByRole = std::array<ChannelSet, kRoles.size()>;

struct Culprit {
  Role role;            // role that fell silent
  std::size_t channel;  // the lost channel of this role, a place in kChannels

  bool operator==(const Culprit&) const = default;
};

/// Blames the producer of the first lost input in the order of the graph table, which is an order
/// of evaluation. If this producer has reported lost inputs itself, the blame passes to the
/// producer of the first of these inputs, and so on. In a circle the blame stays at the role where
/// the circle closes.
/// @return nullopt if `lost` is empty
std::optional<Culprit> FindCulprit(const ChannelSet& lost, const LostByRole& reported);

/// "lidar (LIDAR lost)".
std::string Text(const Culprit& culprit);

}  // namespace fogline::runtime
