#include "tools/watch/announced.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace fogline::watch {
namespace {

// The largest number of runs that are listed. The number is small, because most of the window is
// for the traffic. A machine rarely has more runs. Further announcements may be forged.
constexpr std::size_t kMaxLines = 8;

}  // namespace

std::vector<Line> AnnouncedLines(const std::vector<runtime::Announcement>& runs, bool followed) {
  std::vector<Line> lines;
  for (const runtime::Announcement& run : runs) {
    if (lines.size() == kMaxLines) {
      lines.push_back({fmt::format("{} more runs are announced", runs.size() - kMaxLines)});
      break;
    }
    const bool shown = followed && &run == runs.data();
    lines.push_back({(shown ? "" : "also announced: ") + run.Text()});
  }
  return lines;
}

nlohmann::ordered_json AnnouncedJson(const std::vector<runtime::Announcement>& runs,
                                     bool followed) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const runtime::Announcement& run : runs) {
    nlohmann::ordered_json entry{{"run_id", run.run_id},
                                 {"lcm_url", run.url},
                                 {"scenario", run.scenario},
                                 {"host", run.host},
                                 {"pid", run.pid},
                                 {"awaited", nlohmann::ordered_json::array()},
                                 {"followed", followed && &run == runs.data()}};
    for (const Role role : run.awaited) entry["awaited"].push_back(NameOf(role));
    list.push_back(std::move(entry));
  }
  return list;
}

nlohmann::ordered_json WaitingJson(const std::vector<runtime::WaitingRole>& roles) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const runtime::WaitingRole& role : roles) {
    list.push_back({{"role", role.role},
                    {"host", role.host},
                    {"pid", role.pid},
                    {"version", role.version},
                    {"lcm_url", role.url},
                    {"waiting_s", role.waiting_s},
                    {"same_types", role.same_types}});
  }
  return list;
}

}  // namespace fogline::watch
