#include "tools/watch/senders/senders_report.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/text.h"

namespace fogline::watch {
namespace {

constexpr const char* kRow = " {:<21}{:>10}{:>8}{:>8}{:>7}{:>7}{:>8}  {}";

std::string Joined(const std::vector<std::string>& channels) {
  std::string text;
  for (const std::string& channel : channels) {
    text += (text.empty() ? "" : ", ") + Printable(channel);
  }
  return text;
}

Line SenderLine(const SenderView& sender) {
  std::string channels = Joined(sender.channels);
  if (sender.more_channels) channels += ", ...";
  const SenderSequence::Counts& counts = sender.counts;
  return {
      fmt::format(kRow, sender.address, counts.received, counts.lost, counts.missed_here,
                  counts.late, counts.duplicates, fmt::format("{:.1f}", sender.age_s), channels),
      counts.lost > 0 ? Line::Style::kBad : Line::Style::kPlain};
}

}  // namespace

std::vector<Line> SenderLines(const SendersView& view) {
  if (view.senders.empty()) return {};
  std::vector<Line> lines{{},
                          {"senders, by LCM's own numbers", Line::Style::kHeading},
                          {fmt::format(kRow, "sender", "messages", "lost", "here", "late", "twice",
                                       "age s", "channels"),
                           Line::Style::kHeading}};
  for (const SenderView& sender : view.senders) lines.push_back(SenderLine(sender));
  if (view.own_overflow > 0) {
    lines.push_back({fmt::format("{} packets came faster than top could read them: messages that "
                                 "are missing since then count as \"here\"",
                                 view.own_overflow),
                     Line::Style::kBad});
  }
  if (view.not_lcm > 0) {
    lines.push_back(
        {fmt::format("{} packets were not LCM packets", view.not_lcm), Line::Style::kBad});
  }
  if (view.in_fragments > 0) lines.push_back({FragmentsText(view), Line::Style::kBad});
  if (view.forgotten > 0) {
    lines.push_back(
        {fmt::format("{} senders are not shown, because there were too many", view.forgotten)});
  }
  return lines;
}

std::string FragmentsText(const SendersView& view) {
  if (view.in_fragments == 0) return "";
  return fmt::format("{} messages are larger than a datagram ({}): they are not shown",
                     view.in_fragments, Joined(view.channels_in_fragments));
}

nlohmann::ordered_json SendersJson(const SendersView& view) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const SenderView& sender : view.senders) {
    const SenderSequence::Counts& counts = sender.counts;
    json.push_back({{"address", sender.address},
                    {"received", counts.received},
                    {"lost", counts.lost},
                    {"missed_here", counts.missed_here},
                    {"late", counts.late},
                    {"duplicates", counts.duplicates},
                    {"stray", counts.stray},
                    {"restarts", counts.restarts},
                    {"age_s", sender.age_s},
                    {"channels", sender.channels},
                    {"more_channels", sender.more_channels}});
  }
  return json;
}

}  // namespace fogline::watch
