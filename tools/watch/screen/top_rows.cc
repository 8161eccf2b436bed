#include "tools/watch/screen/top_rows.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "tools/watch/announced.h"
#include "tools/watch/health_text.h"
#include "tools/watch/role_cell.h"
#include "tools/watch/screen/field_lines.h"
#include "tools/watch/senders/senders_report.h"

namespace fogline::watch {
namespace {

using Style = Line::Style;

constexpr double kThousand = 1e3;

std::string KeyOf(const RunView& run, const RoleView& role) {
  return fmt::format("role {} {}", run.run_id, role.status.instance);
}
std::string KeyOf(const RunView& run, const ChannelView& channel) {
  return fmt::format("channel {} {}", run.run_id, channel.channel);
}

/// Pointers to the elements, in the order `order`. Column 0 is the natural order, which is the
/// order of `all`. For another column, the element with the largest `number` comes first. With
/// `order.reversed`, the order is the opposite one.
template <class T>
std::vector<const T*> Sorted(const std::vector<T>& all, const TableOrder& order,
                             const std::function<double(const T&)>& number) {
  std::vector<const T*> sorted;
  for (const T& one : all) sorted.push_back(&one);
  if (order.column > 0) {
    std::ranges::stable_sort(sorted, std::greater{}, [&](const T* one) { return number(*one); });
  }
  if (order.reversed) std::ranges::reverse(sorted);
  return sorted;
}

double RoleNumber(const RoleView& role, std::size_t column) {
  switch (column) {
    case 1:
      return static_cast<double>(role.status.header.step);
    case 2:
      return role.cpu_percent.value_or(0);
    default:
      return role.age_s;
  }
}

double ChannelNumber(const ChannelView& channel, std::size_t column) {
  switch (column) {
    case 1:
      return channel.arrivals.rate_hz;
    case 2:
      return channel.arrivals.bandwidth_bytes_per_s;
    case 3:
      return channel.arrivals.age_s;
    case 4:
      return channel.steps ? static_cast<double>(channel.steps->newest) : -1;
    default:
      return channel.steps ? static_cast<double>(channel.steps->lost) : -1;
  }
}

double SenderNumber(const SenderView& sender, std::size_t column) {
  return static_cast<double>(column == 1 ? sender.counts.received : sender.counts.lost);
}

constexpr const char* kRoleColumns = " {}{:<8}{:>6}{:>6}{:>6}  {}";

TopRow RoleRow(const RunView& run, const RoleView& role) {
  const std::string remarks = RemarksText(role, run.realtime);
  return {.line = {fmt::format(kRoleColumns, RoleCell(Printable(role.status.role)),
                               StateName(role.status.state), role.status.header.step,
                               role.cpu_percent ? fmt::format("{:.1f}", *role.cpu_percent) : "-",
                               fmt::format("{:.1f}", role.age_s), remarks.empty() ? "ok" : remarks),
                   IsUnwell(role) ? Style::kBad : Style::kPlain},
          .table = Table::kRoles,
          .key = KeyOf(run, role)};
}

constexpr const char* kChannelColumns = " {:<17}{:>9}{:>9}{:>8}{:>7}{:>7}{:>6}{:>7}{:>6}";

TopRow ChannelRow(const ChannelView& channel, std::string key) {
  const auto step = [&channel](std::int64_t StepSequence::Counts::*count) {
    return channel.steps ? std::to_string((*channel.steps).*count) : std::string("-");
  };
  const ArrivalView& arrivals = channel.arrivals;
  const bool bad = !channel.undecodable.empty() || (channel.steps && channel.steps->lost > 0);
  return {
      .line = {fmt::format(kChannelColumns, Printable(channel.channel), arrivals.messages,
                           fmt::format("{:.1f}", arrivals.rate_hz),
                           fmt::format("{:.1f}", arrivals.bandwidth_bytes_per_s / kThousand),
                           fmt::format("{:.1f}", arrivals.age_s),
                           step(&StepSequence::Counts::newest), step(&StepSequence::Counts::lost),
                           channel.NumUndecodable(), step(&StepSequence::Counts::late)),
               bad ? Style::kBad : Style::kPlain},
      .table = Table::kChannels,
      .key = std::move(key)};
}

TopRow Heading(Table table, std::string text) {
  return {.line = {std::move(text), Style::kHeading}, .table = table, .key = ""};
}

TopRow HeadingOfChannels() {
  return Heading(Table::kChannels, fmt::format(kChannelColumns, "channel", "messages", "rate/s",
                                               "kB/s", "age s", "step", "lost", "undec.", "late"));
}

std::string RunText(const RunView& run) {
  std::string text = fmt::format("run {}", run.run_id);
  if (run.step >= 0) text += fmt::format("  step {}", run.step);
  if (run.phase) {
    text += fmt::format("  {}  {}", PhaseName(*run.phase), SpeedText(run));
  }
  const std::string drives = WhoDrives(run);
  return drives.empty() ? text : text + "  " + drives;
}

const TableOrder& OrderOf(Table table, const TableOrders& orders) {
  return orders[static_cast<std::size_t>(table)];
}

void AddRun(const RunView& run, const TableOrders& orders, std::vector<TopRow>& rows) {
  rows.push_back(Heading(Table::kNone, RunText(run)));
  if (!run.roles.empty()) {
    rows.push_back(Heading(Table::kRoles, fmt::format(kRoleColumns, RoleCell("role"), "state",
                                                      "step", "CPU %", "age s", "diagnosis")));
  }
  const TableOrder& by = OrderOf(Table::kRoles, orders);
  for (const RoleView* role : Sorted<RoleView>(
           run.roles, by, [&](const RoleView& one) { return RoleNumber(one, by.column); })) {
    rows.push_back(RoleRow(run, *role));
  }
  if (!run.channels.empty()) rows.push_back(HeadingOfChannels());
  const TableOrder& sort = OrderOf(Table::kChannels, orders);
  for (const ChannelView* channel : Sorted<ChannelView>(
           run.channels, sort,
           [&](const ChannelView& one) { return ChannelNumber(one, sort.column); })) {
    rows.push_back(ChannelRow(*channel, KeyOf(run, *channel)));
  }
}

void AddOthers(const TopView& view, const TableOrders& orders, std::vector<TopRow>& rows) {
  if (view.traffic.others.empty()) return;
  rows.push_back(Heading(Table::kNone, "of no run"));
  rows.push_back(HeadingOfChannels());
  const TableOrder& sort = OrderOf(Table::kChannels, orders);
  for (const ChannelView* channel : Sorted<ChannelView>(
           view.traffic.others, sort,
           [&](const ChannelView& one) { return ChannelNumber(one, sort.column); })) {
    rows.push_back(ChannelRow(*channel, "other " + channel->channel));
  }
}

void AddWaiting(const TopView& view, std::vector<TopRow>& rows) {
  if (view.waiting.empty()) return;
  constexpr const char* kWaitingColumns = " {}{:<24}{:<11}{:>7}  {}";
  rows.push_back(Heading(Table::kWaiting, fmt::format(kWaitingColumns, RoleCell("waits"), "process",
                                                      "version", "for s", "network")));
  for (const runtime::WaitingRole& role : view.waiting) {
    rows.push_back({.line = {fmt::format(kWaitingColumns, RoleCell(role.role),
                                         fmt::format("{}@{}", role.pid, role.host), role.version,
                                         fmt::format("{:.0f}", role.waiting_s), role.url),
                             role.same_types ? Style::kPlain : Style::kBad},
                    .table = Table::kWaiting,
                    .key = fmt::format("waiting {}", role.instance)});
  }
}

void AddSenders(const TopView& view, const TableOrders& orders, std::vector<TopRow>& rows) {
  const TableOrder& sort = OrderOf(Table::kSenders, orders);
  SendersView sorted = view.senders;
  sorted.senders.clear();
  for (const SenderView* sender :
       Sorted<SenderView>(view.senders.senders, sort,
                          [&](const SenderView& one) { return SenderNumber(one, sort.column); })) {
    sorted.senders.push_back(*sender);
  }
  std::vector<Line> lines = SenderLines(sorted);
  // The lines are a blank one, two headings, and one for each sender; remarks may follow.
  constexpr std::size_t kHeadings = 3;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const bool is_sender = i >= kHeadings && i - kHeadings < sorted.senders.size();
    rows.push_back({.line = std::move(lines[i]),
                    .table = Table::kSenders,
                    .key = is_sender ? "sender " + sorted.senders[i - kHeadings].address : ""});
  }
}

std::vector<Line> Titled(std::string title, const std::vector<std::string>& texts) {
  std::vector<Line> lines{{std::move(title), Style::kHeading}};
  for (const std::string& text : texts) lines.push_back({text});
  return lines;
}

std::vector<Line> ChannelDetails(const ChannelView& channel, const std::string& of) {
  const ArrivalView& arrivals = channel.arrivals;
  std::string title = fmt::format("{} {} ({})  {:.1f}/s  age {:.1f} s", Printable(channel.channel),
                                  of, channel.type.empty() ? "unknown type" : channel.type,
                                  arrivals.rate_hz, arrivals.age_s);
  if (arrivals.jitter_s) title += fmt::format("  jitter {:.2f} ms", *arrivals.jitter_s * kThousand);
  return Titled(std::move(title), FieldLines(channel.channel, channel.newest));
}

std::vector<Line> RoleDetails(const RunView& run, const RoleView& role) {
  const status_t& status = role.status;
  std::vector<std::string> texts = RemarksOn(role, run.realtime);
  if (texts.empty()) texts.emplace_back("ok");
  for (const std::string& field : FieldLines(status)) texts.push_back(field);
  return Titled(
      fmt::format("{} of run {}: pid {} on {}  {}  step {}", Printable(status.role), run.run_id,
                  status.pid, Printable(status.host), StateName(status.state), status.header.step),
      texts);
}

std::vector<Line> SenderDetails(const SenderView& sender) {
  const SenderSequence::Counts& counts = sender.counts;
  std::vector<std::string> texts;
  const auto add = [&texts](std::string_view name, const auto& value) {
    texts.push_back(fmt::format("{:<24} {}", name, value));
  };
  add("received", counts.received);
  add("lost", counts.lost);
  add("missed here", counts.missed_here);
  add("late", counts.late);
  add("duplicates", counts.duplicates);
  add("stray", counts.stray);
  add("restarts", counts.restarts);
  for (const std::string& channel : sender.channels) add("channel", Printable(channel));
  if (sender.more_channels) texts.emplace_back("and further channels");
  return Titled(fmt::format("sender {}  age {:.1f} s", sender.address, sender.age_s), texts);
}

}  // namespace

std::vector<std::string_view> SortColumns(Table table) {
  switch (table) {
    case Table::kRoles:
      return {"role", "step", "CPU", "age"};
    case Table::kChannels:
      return {"channel", "rate", "kB/s", "age", "step", "lost"};
    case Table::kSenders:
      return {"address", "messages", "lost"};
    default:
      return {"role"};
  }
}

std::vector<TopRow> TopRows(const TopView& view, const TableOrders& orders) {
  std::vector<TopRow> rows;
  for (const RunView& run : view.traffic.runs) AddRun(run, orders, rows);
  AddWaiting(view, rows);
  AddOthers(view, orders, rows);
  for (Line& line : AnnouncedLines(view.announced, view.followed)) {
    rows.push_back({.line = std::move(line), .table = Table::kNone, .key = ""});
  }
  AddSenders(view, orders, rows);
  if (view.traffic.runs.empty() && view.traffic.others.empty() && view.waiting.empty()) {
    rows.push_back({.line = {"no messages so far; `fogline doctor` names the runs of this machine"},
                    .table = Table::kNone,
                    .key = ""});
  }
  return rows;
}

std::vector<Line> DetailsOf(const std::string& key, const TopView& view) {
  for (const RunView& run : view.traffic.runs) {
    for (const ChannelView& channel : run.channels) {
      if (KeyOf(run, channel) != key) continue;
      return ChannelDetails(channel, fmt::format("of run {}", run.run_id));
    }
    for (const RoleView& role : run.roles) {
      if (KeyOf(run, role) == key) return RoleDetails(run, role);
    }
  }
  for (const ChannelView& channel : view.traffic.others) {
    if (key == "other " + channel.channel) return ChannelDetails(channel, "of no run");
  }
  for (const SenderView& sender : view.senders.senders) {
    if (key == "sender " + sender.address) return SenderDetails(sender);
  }
  for (const runtime::WaitingRole& role : view.waiting) {
    if (key != fmt::format("waiting {}", role.instance)) continue;
    return Titled(fmt::format("the {} waits for a run", role.role),
                  {"process   " + fmt::format("{}@{}", role.pid, role.host),
                   "version   " + role.version, "network   " + role.url});
  }
  return {};
}

}  // namespace fogline::watch
