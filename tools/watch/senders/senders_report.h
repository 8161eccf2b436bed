// The senders of a network, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/watch/senders/senders.h"
#include "tools/watch/traffic_text.h"

namespace fogline::watch {

/// A table; no lines if nothing has been sent. Text from the network is safe, as in TrafficLines().
std::vector<Line> SenderLines(const SendersView& view);

/// The messages that are not taken because they are larger than a datagram, such as "3 messages are
/// larger than a datagram (CAMERA): they are not shown"; "" if there is nothing. Text from the
/// network is safe.
std::string FragmentsText(const SendersView& view);

/// Each sender as an object with `address`, `received`, `lost`, `missed_here`, `late`,
/// `duplicates`, `stray`, `restarts`, `age_s`, `channels`, `more_channels`.
nlohmann::ordered_json SendersJson(const SendersView& view);

}  // namespace fogline::watch
