#include <nlohmann/json.hpp>

#include "common/json.h"
#include "services/input_state.h"
#include "tools/watch/traffic_text.h"

namespace fogline::watch {
namespace {

using Json = nlohmann::ordered_json;

Json ChannelJson(const ChannelView& channel) {
  constexpr double kMillisecondsPerSecond = 1e3;
  const ArrivalView& arrivals = channel.arrivals;
  Json json{{"channel", channel.channel},
            {"type", channel.type.empty() ? Json(nullptr) : Json(channel.type)},
            {"messages", arrivals.messages},
            {"rate_hz", arrivals.rate_hz},
            {"jitter_ms", OrNull(arrivals.jitter_s, kMillisecondsPerSecond)},
            {"longest_gap_ms", OrNull(arrivals.longest_gap_s, kMillisecondsPerSecond)},
            {"bandwidth_bytes_per_s", arrivals.bandwidth_bytes_per_s},
            {"age_s", arrivals.age_s},
            {"undecodable", channel.NumUndecodable()},
            {"undecodable_as", Json::object()}};
  for (const auto& [type, count] : channel.undecodable) json["undecodable_as"][type] = count;
  if (channel.steps) {
    json["step"] = channel.steps->newest;
    json["lost"] = channel.steps->lost;
    json["missing"] = channel.steps->missing;
    json["late"] = channel.steps->late;
    json["duplicates"] = channel.steps->duplicate;
    json["stray"] = channel.steps->stray;
  }
  return json;
}

Json RoleJson(const RoleView& role) {
  const status_t& status = role.status;
  Json json{{"role", status.role},
            {"state", StateName(status.state)},
            {"step", status.header.step},
            {"pid", status.pid},
            {"host", status.host},
            {"instance", status.instance},
            {"version", status.version},
            {"age_s", role.age_s},
            {"silent", role.silent},
            {"waiting_for", status.waiting_for},
            {"waiting_ms", status.waiting_ms},
            {"fallback", status.fallback},
            {"inputs", Json::object()},
            {"repairs_asked", status.repairs_asked},
            {"repairs_served", status.repairs_served},
            {"duplicates", status.duplicates},
            {"refused", Json::object()},
            {"sends_failed", status.sends_failed},
            {"send_error", status.send_error},
            {"cpu_percent", OrNull(role.cpu_percent)},
            {"cpu_ms", status.cpu_ms},
            {"rss_bytes", status.rss_bytes},
            {"error", status.error}};
  for (std::size_t i = 0; i < status.input.size(); ++i) {
    json["inputs"][status.input[i]] = NameOf(static_cast<InputState>(status.input_state[i]));
  }
  for (const runtime::RefusalKind& kind : runtime::kRefusals) {
    if (status.*kind.counter != 0) json["refused"][std::string(kind.key)] = status.*kind.counter;
  }
  return json;
}

Json ChannelsJson(const std::vector<ChannelView>& channels) {
  Json json = Json::array();
  for (const ChannelView& channel : channels) json.push_back(ChannelJson(channel));
  return json;
}

Json RunJson(const RunView& run) {
  Json json{{"run_id", run.run_id},
            {"step", run.step},
            {"phase", run.phase ? Json(PhaseName(*run.phase)) : Json(nullptr)},
            {"pace", run.pace},
            {"realtime", run.realtime},
            {"scenario_hash", run.scenario_hash},
            {"channels", ChannelsJson(run.channels)},
            {"roles", Json::array()}};
  for (const RoleView& role : run.roles) json["roles"].push_back(RoleJson(role));
  return json;
}

}  // namespace

Json TrafficJson(const TrafficView& view, std::string_view url) {
  Json json{{"lcm_url", url},
            {"interval_s", view.interval_s},
            {"runs", Json::array()},
            {"others", ChannelsJson(view.others)},
            {"forgotten", view.forgotten}};
  for (const RunView& run : view.runs) json["runs"].push_back(RunJson(run));
  return json;
}

}  // namespace fogline::watch
