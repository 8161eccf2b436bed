// A Foxglove client of `fogline view`. Input: for each event a byte and a datagram. The byte says
// what the datagram is: a text frame (0), a binary frame (1), or a message on a channel (2 and
// above).
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "tests/fuzz/samples.h"
#include "tools/web/foxglove/session.h"

namespace fogline::fuzz {
namespace {

namespace foxglove = web::foxglove;

constexpr std::size_t kMaxEvents = 64;
constexpr std::size_t kMessageHead = 1 + 4 + 8;  // opcode, subscription, time

const foxglove::Channels& Channels() {
  static const foxglove::Channels channels = [] {
    foxglove::Channels all(web::FoglineTypes());
    std::uint32_t id = 0;
    for (const web::LcmStruct& type : web::FoglineTypes().structs()) {
      all.Add({.id = id++, .topic = type.name, .type = &type});
    }
    return all;
  }();
  return channels;
}

void DemandAnswered(foxglove::Session& session, std::string_view bytes, bool binary) {
  const auto [answers, error] = session.Received(bytes, binary);
  Demand(answers.size() <= 1, "a frame has one answer at most");
  Demand(error.empty() == answers.empty(), "what is answered has a reason");
  for (const foxglove::Frame& answer : answers) {
    Demand(!answer.binary && answer.bytes.size() < 1000, "an answer is a short text");
    const nlohmann::json json = nlohmann::json::parse(answer.bytes, nullptr, false);
    Demand(json.is_object() && json["op"] == "status" && json["level"] == 2,
           "an answer is a status of level error");
    Demand(Printable(json["message"].get<std::string>()), "an error can be printed");
  }
}

void DemandMessage(foxglove::Session& session, std::uint32_t channel, runtime::Bytes bytes) {
  const auto frame = session.Message(channel, 1, bytes);
  if (!frame) return;
  Demand(session.Subscribed(), "only a subscriber gets messages");
  Demand(frame->binary && frame->bytes.size() > kMessageHead && frame->bytes.front() == 1,
         "a message has the head of the protocol");
  Demand(nlohmann::json::accept(frame->bytes.substr(kMessageHead)), "a message is valid JSON");
  Took();
}

void DemandSoundSession(runtime::Bytes input) {
  foxglove::Session session(Channels());
  Cutter cutter(input);
  for (std::size_t i = 0; i < kMaxEvents && !cutter.empty(); ++i) {
    const std::uint8_t kind = cutter.Byte();
    const runtime::Bytes bytes = cutter.Datagram();
    if (kind >= 2) {
      DemandMessage(session, kind - 2U, bytes);
    } else {
      const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      DemandAnswered(session, text, kind == 1);
    }
  }
}

void Add(std::uint8_t kind, std::string_view text, Input& input) {
  input.push_back(kind);
  AddDatagram({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, input);
}

}  // namespace

std::vector<Input> Seeds() {
  std::uint32_t ego = 0;
  while (Channels().Find(ego)->topic != "ego_t") ++ego;
  const std::string id = std::to_string(ego);
  Input viewer;
  Add(0, R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":)" + id + "}]}", viewer);
  viewer.push_back(static_cast<std::uint8_t>(2 + ego));
  AddDatagram(Encoded(Sample<ego_t>(1)), viewer);
  Add(0, R"({"op":"unsubscribe","subscriptionIds":[0]})", viewer);
  Input others;
  Add(0, R"({"op":"advertise","channels":[{"id":1,"topic":"HOST_COMMAND"}]})", others);
  Add(0, R"({"op":"setParameters","parameters":[{"name":"a","value":1}]})", others);
  Add(0, R"({"op":"fetchAsset","uri":"package://a","requestId":1})", others);
  Add(1, std::string_view("\1\0\0\0\0{}", 7), others);
  return {viewer, others};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundSession({data, size});
  return 0;
}
