// The parser of tcpq streams, for the relay and for its clients. Input: a byte, which is odd for a
// stream from a relay, and the stream.
#include <algorithm>
#include <functional>

#include "services/runtime/wire/tcpq_frame.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

constexpr runtime::tcpq::Limits kLimits{.channel = 63, .pattern = 100, .payload = 200};
// A frame has type, length, channel, length and payload.
constexpr std::size_t kLargestFrame = 4 + 4 + kLimits.channel + 4 + kLimits.payload;
constexpr std::size_t kHello = 8;

struct Reading {
  bool greeted = false;
  std::vector<Input> frames;
  std::string error;

  friend bool operator==(const Reading&, const Reading&) = default;
};

void DemandFaithful(const runtime::tcpq::Frame& frame) {
  Input again;
  runtime::tcpq::AppendFrame(frame.type, frame.name, frame.payload, again);
  Demand(std::ranges::equal(again, frame.wire), "a frame says what came");
  Demand(frame.wire.size() <= kLargestFrame, "no frame is larger than the limits");
}

/// Reads a stream that arrives in pieces. @param piece gives the number of bytes that arrive next
Reading Read(std::uint32_t magic, runtime::Bytes stream,
             const std::function<std::size_t()>& piece) {
  Reading reading;
  runtime::tcpq::FrameParser parser(magic, kLimits);
  std::size_t held = 0;
  while (!stream.empty()) {
    const std::size_t size = std::min(piece(), stream.size());
    parser.Append(stream.first(size));
    stream = stream.subspan(size);
    held += size;
    if (parser.Greeted() && !reading.greeted) {
      reading.greeted = true;
      held -= kHello;
    }
    while (const auto frame = parser.Next()) {
      DemandFaithful(*frame);
      reading.frames.emplace_back(frame->wire.begin(), frame->wire.end());
      held -= frame->wire.size();
    }
    Demand(!parser.error().empty() || held < kLargestFrame, "no more than a frame is waited for");
  }
  reading.error = parser.error();
  Demand(Printable(reading.error), "an error can be printed");
  if (!reading.error.empty()) {
    Input sound;
    runtime::tcpq::AppendHello(magic, sound);
    runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kSubscribe, ".*", {}, sound);
    parser.Append(sound);
    Demand(!parser.Next() && parser.error() == reading.error, "there is no way back");
  }
  return reading;
}

void DemandSameInAnyPieces(std::uint32_t magic, runtime::Bytes stream) {
  const Reading whole = Read(magic, stream, [&stream] { return stream.size(); });
  Demand(Read(magic, stream, [] { return std::size_t{1}; }) == whole, "bytes may come one by one");
  std::size_t at = 0;
  const auto uneven = [&] { return std::size_t{1} + stream[at++ % stream.size()] % 32; };
  Demand(Read(magic, stream, uneven) == whole, "bytes may come in pieces");
  if (!whole.frames.empty()) Took();
}

}  // namespace

std::vector<Input> Seeds() {
  const Input truth = Encoded(Sample<ego_t>(1));
  Input client{0};
  runtime::tcpq::AppendHello(runtime::tcpq::kClientMagic, client);
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kSubscribe, "HOST_.*", {}, client);
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kPublish, "HOST_EGO", truth, client);
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kUnsubscribe, "HOST_.*", {}, client);
  Input relay{1};
  runtime::tcpq::AppendHello(runtime::tcpq::kRelayMagic, relay);
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kPublish, "HOST_EGO", truth, relay);
  runtime::tcpq::AppendFrame(runtime::tcpq::FrameType::kPublish, "", {}, relay);
  return {client, relay};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline;
  if (size == 0) return 0;
  fuzz::DemandSameInAnyPieces(
      data[0] % 2 == 1 ? runtime::tcpq::kRelayMagic : runtime::tcpq::kClientMagic,
      {data + 1, size - 1});
  return 0;
}
