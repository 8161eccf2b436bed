#include "tools/watch/traffic_text.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "tools/watch/health_text.h"
#include "tools/watch/role_cell.h"

namespace fogline::watch {
namespace {

constexpr double kMilli = 1e-3;
constexpr double kKilo = 1e3;
constexpr double kMega = 1e6;
// Number of characters of a scenario's hash that are shown. These characters suffice to distinguish
// two scenarios.
constexpr std::size_t kHashShown = 12;

std::string Number(const std::optional<double>& value, double unit, int decimals) {
  return value ? fmt::format("{:.{}f}", *value / unit, decimals) : "-";
}

/// The name of a message's constant; "?" for an unknown constant.
std::string_view NameIn(std::initializer_list<std::pair<std::int8_t, std::string_view>> names,
                        std::int8_t value) {
  for (const auto& [constant, name] : names) {
    if (constant == value) return name;
  }
  return "?";
}

std::string NameOfUndecodable(const Undecodable& undecodable) {
  std::string text;
  for (const auto& [type, count] : undecodable) {
    text += fmt::format("{}{} of {}", text.empty() ? "undecodable: " : ", ", count,
                        type == "unknown" ? "no known type" : type);
  }
  return text;
}

// The most important columns fit into 80 characters.
constexpr const char* kChannelRow =
    " {:<16}{:>9}{:>8}{:>10}{:>8}{:>7}{:>8}{:>6}{:>7}{:>6}{:>6}  {:<18}  {}";

Line ChannelHeading() {
  return {fmt::format(kChannelRow, "channel", "messages", "rate/s", "jitter ms", "kB/s", "age s",
                      "step", "lost", "undec.", "late", "twice", "type", ""),
          Line::Style::kHeading};
}

Line ChannelLine(const ChannelView& channel) {
  const auto step = [&channel](std::int64_t StepSequence::Counts::*count) {
    return channel.steps ? std::to_string((*channel.steps).*count) : std::string("-");
  };
  const ArrivalView& arrivals = channel.arrivals;
  const bool bad = !channel.undecodable.empty() || (channel.steps && channel.steps->lost > 0);
  return {
      fmt::format(kChannelRow, Printable(channel.channel), arrivals.messages,
                  Number(arrivals.rate_hz, 1, 1), Number(arrivals.jitter_s, kMilli, 2),
                  Number(arrivals.bandwidth_bytes_per_s, kKilo, 1), Number(arrivals.age_s, 1, 1),
                  step(&StepSequence::Counts::newest), step(&StepSequence::Counts::lost),
                  channel.NumUndecodable(), step(&StepSequence::Counts::late),
                  step(&StepSequence::Counts::duplicate), channel.type.empty() ? "?" : channel.type,
                  NameOfUndecodable(channel.undecodable)),
      bad ? Line::Style::kBad : Line::Style::kPlain};
}

constexpr const char* kRoleRow = " {}{:<8}{:>7}{:>7}{:>8}{:>7}{:>7}{:>7}  {:<16}  {}";

Line RoleHeading() {
  return {fmt::format(kRoleRow, RoleCell("role"), "state", "step", "asked", "served", "CPU %", "MB",
                      "age s", "process", ""),
          Line::Style::kHeading};
}

Line RoleLine(const RoleView& role, bool realtime) {
  const status_t& status = role.status;
  return {
      fmt::format(
          kRoleRow, RoleCell(Printable(status.role)), StateName(status.state), status.header.step,
          status.repairs_asked, status.repairs_served, Number(role.cpu_percent, 1, 1),
          Number(static_cast<double>(status.rss_bytes), kMega, 1), Number(role.age_s, 1, 1),
          fmt::format("{}@{}", status.pid, Printable(status.host)), RemarksText(role, realtime)),
      IsUnwell(role) ? Line::Style::kBad : Line::Style::kPlain};
}

Line RunHeading(const RunView& run) {
  std::string text = fmt::format("run {}", run.run_id);
  if (run.step >= 0) text += fmt::format("  step {}", run.step);
  if (run.phase) {
    text += fmt::format("  {}  {}  scenario {}", PhaseName(*run.phase), SpeedText(run),
                        Printable(run.scenario_hash.substr(0, kHashShown)));
  }
  return {text, Line::Style::kHeading};
}

}  // namespace

Line SummaryLine(const TrafficView& view, std::string_view url) {
  double rate_hz = 0;
  double bandwidth_bytes_per_s = 0;
  const auto add = [&](const std::vector<ChannelView>& channels) {
    for (const ChannelView& channel : channels) {
      rate_hz += channel.arrivals.rate_hz;
      bandwidth_bytes_per_s += channel.arrivals.bandwidth_bytes_per_s;
    }
  };
  for (const RunView& run : view.runs) add(run.channels);
  add(view.others);
  return {fmt::format("{}: {} run{}, {:.1f} messages/s, {:.1f} kB/s in the last {:.1f} s", url,
                      view.runs.size(), view.runs.size() == 1 ? "" : "s", rate_hz,
                      bandwidth_bytes_per_s / kKilo, view.interval_s),
          Line::Style::kHeading};
}

std::vector<Line> TrafficLines(const TrafficView& view, std::string_view url) {
  std::vector<Line> lines{SummaryLine(view, url)};
  for (const RunView& run : view.runs) {
    lines.push_back({});
    lines.push_back(RunHeading(run));
    if (!run.channels.empty()) lines.push_back(ChannelHeading());
    for (const ChannelView& channel : run.channels) lines.push_back(ChannelLine(channel));
    if (!run.roles.empty()) lines.push_back(RoleHeading());
    for (const RoleView& role : run.roles) lines.push_back(RoleLine(role, run.realtime));
  }
  if (!view.others.empty()) {
    lines.push_back({});
    lines.push_back({"of no run", Line::Style::kHeading});
    lines.push_back(ChannelHeading());
    for (const ChannelView& channel : view.others) lines.push_back(ChannelLine(channel));
  }
  if (view.runs.empty() && view.others.empty()) {
    lines.push_back({"no messages so far; `fogline doctor` names the runs of this machine"});
  }
  if (view.forgotten > 0) {
    lines.push_back({fmt::format(
        "{} runs, channels or roles are not shown, because there were too many", view.forgotten)});
  }
  return lines;
}

std::string_view StateName(std::int8_t state) {
  return NameIn({{status_t::WAITING, "WAITING"},
                 {status_t::READY, "READY"},
                 {status_t::RUNNING, "RUNNING"},
                 {status_t::DONE, "DONE"},
                 {status_t::FAILED, "FAILED"},
                 {status_t::LEFT, "LEFT"}},
                state);
}

std::string_view PhaseName(std::int8_t phase) {
  return NameIn({{run_t::PREPARE, "PREPARE"}, {run_t::GO, "GO"}, {run_t::STOP, "STOP"}}, phase);
}

}  // namespace fogline::watch
