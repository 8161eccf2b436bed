// The senders of a network, as text for people and as JSON for programs.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/watch/senders/senders.h"
#include "tools/watch/traffic_text.h"

namespace fogline::watch {

/// The senders as a table; empty if the view has no senders. Text from the network is made safe, as
/// in TrafficLines().
std::vector<Line> SenderLines(const SendersView& view);

/// A text about messages that are refused because they are larger than a datagram, such as "3
/// messages are larger than a datagram (CAMERA): they are not shown"; "" if there are no such
/// messages. Text from the network is made safe.
std::string FragmentsText(const SendersView& view);

/// Each sender as an object with `address`, `received`, `lost`, `missed_here`, `late`,
/// `duplicates`, `stray`, `restarts`, `age_s`, `channels`, `more_channels`.
nlohmann::ordered_json SendersJson(const SendersView& view);

}  // namespace fogline::watch
