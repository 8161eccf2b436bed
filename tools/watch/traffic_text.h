// A TrafficView as lines of text for people, and as JSON for programs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/watch/traffic_statistics.h"

namespace fogline::watch {

/// One line, without a line feed.
struct Line {
  enum class Style { kPlain, kHeading, kBad, kSelected };
  std::string text;
  Style style = Style::kPlain;
};

/// The view as a table. In text from the network, each byte other than ASCII letters, digits,
/// punctuation and spaces is printed as '?'. So no sender can send commands to the terminal.
std::vector<Line> TrafficLines(const TrafficView& view, std::string_view url);

/// The first line of TrafficLines(): the network, and its traffic in the last interval.
Line SummaryLine(const TrafficView& view, std::string_view url);

nlohmann::ordered_json TrafficJson(const TrafficView& view, std::string_view url);

/// Names of status_t's states and run_t's phases.
std::string_view StateName(std::int8_t state);
std::string_view PhaseName(std::int8_t phase);

}  // namespace fogline::watch
