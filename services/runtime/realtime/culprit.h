// Finds the role that is to blame for lost inputs. If a role stops publishing, all roles that
// depend on this role stop publishing, too. So the channel that a role misses first is rarely a
// channel of the failed role.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <string>

#include "services/graph.h"

namespace fogline::runtime {

/// Channels by their index in kChannels.
using ChannelSet = std::bitset<kNumChannels>;

/// The lost inputs that each role reports, by the role's index in kRoles. The set of a silent role
/// is empty, even if the role reported lost inputs before.
using LostByRole = std::array<ChannelSet, kRoles.size()>;

struct Culprit {
  Role role;            // role that stopped publishing
  std::size_t channel;  // the lost channel of this role, an index in kChannels

  bool operator==(const Culprit&) const = default;
};

/// Blames the producer of the first lost input. The inputs are in the order of the graph table,
/// which is the order in which the channels are computed in a step. If this producer has reported
/// lost inputs itself, the blame passes to the producer of the first of these inputs, and so on. If
/// the blame would pass to a channel that was blamed before, the current producer keeps the blame.
/// @return nullopt if `lost` is empty
std::optional<Culprit> FindCulprit(const ChannelSet& lost, const LostByRole& reported);

/// Returns a text such as "lidar (LIDAR lost)".
std::string Text(const Culprit& culprit);

}  // namespace fogline::runtime
