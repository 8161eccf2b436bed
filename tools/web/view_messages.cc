#include "tools/web/view_messages.h"

#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tools/web/types/decode.h"
#include "tools/web/types/description.h"
#include "tools/web/types/little_endian.h"

namespace fogline::web {
namespace {

using Json = nlohmann::ordered_json;

/// A JSON document as text. Bytes that are not valid UTF-8 are replaced, because a name from the
/// network may have such bytes.
std::string Printed(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json ChannelJson(const KnownChannel& channel) {
  return {{"id", channel.id},
          {"name", channel.name},
          {"type", channel.type.empty() ? Json(nullptr) : Json(channel.type)}};
}

Json RolesJson() {
  Json roles = Json::array();
  for (const RoleInfo& info : kRoles) roles.push_back(info.name);
  return roles;
}

Json EventJson(const RunEvent& event) {
  return {
      {"step", event.step}, {"time_s", event.time_s}, {"kind", event.kind}, {"text", event.text}};
}

std::string BeginFrame(FrameKind kind) { return {static_cast<char>(kind)}; }

}  // namespace

std::string HelloText(const std::optional<LiveFacts>& live,
                      const std::vector<KnownChannel>& others) {
  Json json{{"op", "hello"},
            {"version", FOGLINE_VERSION},
            {"mode", live ? "live" : "log"},
            {"types", TypesJson(FoglineTypes())},
            {"fingerprints", FingerprintsJson(FoglineTypes())},
            {"channels", ChannelsJson()},
            {"roles", RolesJson()},
            {"url", live ? Json(live->url) : Json(nullptr)},
            {"follows", live && live->follows},
            {"waits_for_person", live && live->waits_for_person}};
  for (const KnownChannel& channel : others) json["channels"].push_back(ChannelJson(channel));
  return Printed(json);
}

std::string ChannelText(const KnownChannel& channel) {
  Json json{{"op", "channel"}};
  json.update(ChannelJson(channel));
  return Printed(json);
}

std::string RunText(const RunFacts& run) {
  const Json scenario = Json::parse(run.scenario_text, nullptr, false);
  if (!scenario.is_object()) return "";
  const auto value = [&scenario](const char* name) {
    const auto found = scenario.find(name);
    return found == scenario.end() ? Json(nullptr) : *found;
  };
  return Printed({{"op", "run"},
                  {"run_id", std::to_string(run.run_id)},
                  {"title", value("title")},
                  {"scenario", scenario},
                  {"step_s", value("step_s")},
                  {"steps", value("steps")},
                  {"realtime", run.realtime},
                  {"pace", run.pace}});
}

std::string LogText(const std::filesystem::path& file, const LogIndex& index) {
  Json json{{"op", "log"},
            {"file", file.filename().string()},
            {"first_step", index.first_step()},
            {"last_step", index.last_step()},
            {"complete", index.run().complete},
            {"note", index.run().note},
            {"events", Json::array()},
            {"events_left_out", index.events_left_out()}};
  for (const RunEvent& event : index.events()) json["events"].push_back(EventJson(event));
  return Printed(json);
}

std::string EventText(const RunEvent& event) {
  Json json{{"op", "event"}, {"number", event.number}};
  json.update(EventJson(event));
  return Printed(json);
}

std::string HistoryText(RequestId id, std::int64_t messages) {
  return Printed({{"op", "history"}, {"id", id}, {"messages", messages}});
}

std::string ErrorText(std::optional<RequestId> id, std::string_view message) {
  return Printed({{"op", "error"}, {"id", id ? Json(*id) : Json(nullptr)}, {"message", message}});
}

std::string MessagesFrame(std::string_view messages) {
  std::string frame = BeginFrame(FrameKind::kMessages);
  frame += messages;
  return frame;
}

std::string StepsFrame(const StepsRequest& request, const LogIndex& index) {
  std::string frame = BeginFrame(FrameKind::kSteps);
  PutLittleEndian(request.id, frame);
  for (std::int64_t step = request.from; step <= request.to; ++step) {
    for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
      const runtime::Bytes bytes = index.Message(step, channel);
      if (bytes.empty()) continue;
      PutLittleEndian(static_cast<ChannelId>(channel), frame);
      PutLittleEndian(step, frame);
      PutLittleEndian(static_cast<std::uint32_t>(bytes.size()), frame);
      frame.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
  }
  return frame;
}

std::string SeriesFrame(RequestId id, const Series& series) {
  std::string frame = BeginFrame(FrameKind::kSeries);
  PutLittleEndian(id, frame);
  frame += static_cast<char>(series.whole ? 1 : 0);
  PutLittleEndian(static_cast<std::uint32_t>(series.value.size()), frame);
  for (const double time_s : series.time_s) PutLittleEndian(time_s, frame);
  for (const double value : series.value) PutLittleEndian(value, frame);
  return frame;
}

}  // namespace fogline::web
