#include "tools/web/seat/seat_told.h"

#include <array>
#include <string_view>

#include <nlohmann/json.hpp>

#include "fogline/arbitration_t.hpp"
#include "fogline/driver_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "services/graph.h"
#include "tools/web/types/description.h"
#include "tools/web/types/lcm_types.h"

namespace fogline::web {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kTold{IndexOf<truth_t>(), IndexOf<driver_command_t>(),
                           IndexOf<arbitration_t>()};
constexpr std::string_view kHeaderType = "header_t";
constexpr std::array kScenarioFields{"/person/key_press_ps", "/person/key_release_ps",
                                     "/person/override_by", "/world/vehicle_length_m",
                                     "/arbitrator/take_over/lead_s"};

/// The fields of TRUTH that the page /drive draws: host and preceding car, the visibility, and the
/// end of the run.
truth_t Shown(const truth_t& message) {
  truth_t shown{};
  shown.header = message.header;
  shown.preceding_position_m = message.preceding_position_m;
  shown.preceding_speed_mps = message.preceding_speed_mps;
  shown.preceding_acceleration_mps2 = message.preceding_acceleration_mps2;
  shown.host_position_m = message.host_position_m;
  shown.host_speed_mps = message.host_speed_mps;
  shown.fog_visibility_m = message.fog_visibility_m;
  shown.collision = message.collision;
  shown.last = message.last;
  return shown;
}

/// The fields of HOST_COMMAND that the page /drive shows.
arbitration_t Shown(const arbitration_t& message) {
  arbitration_t shown{};
  shown.header = message.header;
  shown.lambda_human = message.lambda_human;
  shown.mode = message.mode;
  return shown;
}

/// The fields of DRIVER_COMMAND from which the page /drive measures the latency of an input.
driver_command_t Shown(const driver_command_t& message) {
  driver_command_t shown{};
  shown.header = message.header;
  shown.input_instance = message.input_instance;
  shown.input_sequence = message.input_sequence;
  return shown;
}

template <class Message>
std::optional<std::vector<std::uint8_t>> Reduced(runtime::Bytes bytes) {
  Message message{};
  if (!runtime::Decode(bytes, message)) return std::nullopt;
  std::vector<std::uint8_t> encoded;
  runtime::Encode(Shown(message), encoded);
  return encoded;
}

}  // namespace

std::string SeatHelloText() {
  const Json types = TypesJson(FoglineTypes());
  const Json fingerprints = FingerprintsJson(FoglineTypes());
  const Json channels = ChannelsJson();
  Json json{
      {"op", "hello"},           {"version", FOGLINE_VERSION},     {"mode", "live"},
      {"types", Json::object()}, {"fingerprints", Json::object()}, {"channels", Json::array()}};
  const auto add_type = [&](const std::string& name) {
    json["types"][name] = types.at(name);
    json["fingerprints"][name] = fingerprints.at(name);
  };
  add_type(std::string(kHeaderType));
  for (const std::size_t channel : kTold) {
    json["channels"].push_back(channels.at(channel));
    add_type(channels.at(channel).at("type").get<std::string>());
  }
  return json.dump();
}

std::string SeatRunText(const RunFacts& run) {
  const Json scenario = Json::parse(run.scenario_text, nullptr, false);
  Json shown = Json::object();
  for (const char* field : kScenarioFields) {
    const Json::json_pointer place(field);
    if (scenario.contains(place)) shown[place] = scenario.at(place);
  }
  return Json{{"op", "run"},
              {"run_id", std::to_string(run.run_id)},
              {"scenario", std::move(shown)},
              {"step_s", scenario.value("step_s", Json())},
              {"realtime", run.realtime},
              {"pace", run.pace}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string SeatRequestText(const OpenRequest::Request& request) {
  return Json{{"op", "request"},
              {"since_s", static_cast<double>(request.since_us) / kMicrosPerSecond},
              {"begin_known", request.begin_known}}
      .dump();
}

std::optional<std::vector<std::uint8_t>> ForSeat(std::size_t channel, runtime::Bytes bytes) {
  if (channel == IndexOf<truth_t>()) return Reduced<truth_t>(bytes);
  if (channel == IndexOf<driver_command_t>()) return Reduced<driver_command_t>(bytes);
  if (channel == IndexOf<arbitration_t>()) return Reduced<arbitration_t>(bytes);
  return std::nullopt;
}

}  // namespace fogline::web
