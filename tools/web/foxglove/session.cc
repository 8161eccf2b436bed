#include "tools/web/foxglove/session.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "tools/web/types/decode.h"
#include "tools/web/types/description.h"
#include "tools/web/types/little_endian.h"

namespace fogline::web::foxglove {
namespace {

using Json = nlohmann::ordered_json;

// The first byte of a binary frame. A value has different meanings in frames of the server and in
// frames of the client.
constexpr char kMessageData = 1;
constexpr unsigned char kClientMessageData = 1;
constexpr unsigned char kClientServiceCall = 2;

// The level of a status.
constexpr int kError = 2;

/// Requests of the protocol, and the capability that each of them needs. This server has none of
/// these capabilities.
constexpr std::array kNotOffered = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"advertise", "clientPublish"},
    {"unadvertise", "clientPublish"},
    {"getParameters", "parameters"},
    {"setParameters", "parameters"},
    {"subscribeParameterUpdates", "parametersSubscribe"},
    {"unsubscribeParameterUpdates", "parametersSubscribe"},
    {"subscribeConnectionGraph", "connectionGraph"},
    {"unsubscribeConnectionGraph", "connectionGraph"},
    {"fetchAsset", "assets"},
});

std::string NotOffered(std::string_view capability) {
  return fmt::format("this server does not have the capability {}: it only shows a run",
                     Quote(capability));
}

Frame TextFrame(const Json& json) {
  return {.binary = false, .bytes = json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

Json ChannelJson(const LcmTypes& types, const Channel& channel) {
  return {{"id", channel.id},
          {"topic", channel.topic},
          {"encoding", "json"},
          {"schemaName", channel.type->FullName()},
          {"schema", SchemaJson(types, *channel.type).dump()},
          {"schemaEncoding", "jsonschema"}};
}

Frame AdvertiseFrame(Json channels) {
  return TextFrame({{"op", "advertise"}, {"channels", std::move(channels)}});
}

/// An id of 32 bits, which is the size in the protocol; nullopt if the value is no such number.
std::optional<std::uint32_t> IdIn(const Json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto id = value.get<std::uint64_t>();
  if (id > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(id);
}

std::optional<std::uint32_t> IdIn(const Json& object, const char* key) {
  const auto value = object.find(key);
  return value == object.end() ? std::nullopt : IdIn(*value);
}

/// The list with this name; nullptr if the request has no such list.
const Json* ListIn(const Json& request, const char* key) {
  const auto list = request.find(key);
  return list != request.end() && list->is_array() ? &*list : nullptr;
}

std::string WhyNotBinary(std::string_view bytes) {
  if (bytes.empty()) return "a binary frame is empty";
  const auto opcode = static_cast<unsigned char>(bytes.front());
  if (opcode == kClientMessageData) return NotOffered("clientPublish");
  if (opcode == kClientServiceCall) return NotOffered("services");
  return fmt::format("no binary frame begins with the byte {}", opcode);
}

/// Joins the errors of several entries of a request: the text has the first error and the number of
/// the others.
class Errors {
 public:
  void Add(std::string error) {
    if (error.empty()) return;
    if (count_++ == 0) first_ = std::move(error);
  }
  std::string Text() const {
    return count_ <= 1 ? first_ : fmt::format("{}; and {} more", first_, count_ - 1);
  }

 private:
  std::string first_;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<Frame> Session::Opened() const {
  Json server{{"op", "serverInfo"},
              {"name", "fogline view"},
              {"capabilities", Json::array()},
              {"supportedEncodings", Json::array()},
              {"metadata", Json::object()}};
  Json channels = Json::array();
  for (const Channel& channel : channels_.all()) {
    channels.push_back(ChannelJson(channels_.types(), channel));
  }
  return {TextFrame(server), AdvertiseFrame(std::move(channels))};
}

Frame Session::Advertised(const Channel& channel) const {
  return AdvertiseFrame(Json::array({ChannelJson(channels_.types(), channel)}));
}

Session::Answer Session::Received(std::string_view bytes, bool binary) {
  std::string error = binary ? WhyNotBinary(bytes) : Text(bytes);
  if (error.empty()) return {};
  return {.frames = {TextFrame({{"op", "status"}, {"level", kError}, {"message", error}})},
          .error = std::move(error)};
}

std::string Session::Text(std::string_view text) {
  const Json request = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!request.is_object()) return "a text frame is no JSON object";
  const auto op = request.find("op");
  if (op == request.end() || !op->is_string()) return "a request has no text \"op\"";
  const auto& name = op->get_ref<const std::string&>();
  if (name == "subscribe") return Subscribe(request);
  if (name == "unsubscribe") return Unsubscribe(request);
  const auto known =
      std::ranges::find(kNotOffered, name, &std::pair<std::string_view, std::string_view>::first);
  if (known != kNotOffered.end()) return NotOffered(known->second);
  return fmt::format("there is no request {}", QuoteShort(name));
}

std::string Session::Subscribe(const Json& request) {
  const Json* list = ListIn(request, "subscriptions");
  if (list == nullptr) return "\"subscribe\" has no list \"subscriptions\"";
  Errors errors;
  for (const Json& entry : *list) {
    const auto id = IdIn(entry, "id");
    const auto channel = IdIn(entry, "channelId");
    errors.Add(id && channel ? Subscribe(*id, *channel)
                             : "a subscription needs the numbers \"id\" and \"channelId\"");
  }
  return errors.Text();
}

std::string Session::Subscribe(std::uint32_t id, std::uint32_t channel) {
  if (channels_.Find(channel) == nullptr) return fmt::format("there is no channel {}", channel);
  if (subscriptions_.contains(channel)) {
    return fmt::format("channel {} has a subscription already", channel);
  }
  const bool used = std::ranges::any_of(
      subscriptions_, [id](const auto& subscription) { return subscription.second == id; });
  if (used) return fmt::format("the subscription {} exists already", id);
  subscriptions_.emplace(channel, id);
  return "";
}

std::string Session::Unsubscribe(const Json& request) {
  const Json* list = ListIn(request, "subscriptionIds");
  if (list == nullptr) return "\"unsubscribe\" has no list \"subscriptionIds\"";
  Errors errors;
  for (const Json& entry : *list) {
    const auto id = IdIn(entry);
    const auto ended = std::erase_if(
        subscriptions_, [&id](const auto& subscription) { return subscription.second == id; });
    if (ended == 0) {
      errors.Add(id ? fmt::format("there is no subscription {}", *id)
                    : "the id of a subscription is no number from 0 to 2^32 - 1");
    }
  }
  return errors.Text();
}

std::optional<Frame> Session::Message(std::uint32_t channel, std::uint64_t time_ns, Bytes message) {
  const auto subscription = subscriptions_.find(channel);
  if (subscription == subscriptions_.end()) return std::nullopt;
  const auto json = DecodeJson(channels_.types(), *channels_.Find(channel)->type, message);
  if (!json) {
    ++undecodable_;
    return std::nullopt;
  }
  Frame frame{.binary = true, .bytes = std::string(1, kMessageData)};
  PutLittleEndian(subscription->second, frame.bytes);
  PutLittleEndian(time_ns, frame.bytes);
  frame.bytes += json->dump();
  return frame;
}

}  // namespace fogline::web::foxglove
