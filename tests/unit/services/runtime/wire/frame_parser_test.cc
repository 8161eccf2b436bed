// The parser of tcpq's byte stream, for a stream with any cuts and any contents.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "services/runtime/wire/tcpq_frame.h"

namespace fogline::runtime::tcpq {
namespace {

using Buffer = std::vector<std::uint8_t>;

struct Kept {
  FrameType type;
  std::string name;
  Buffer payload;
  Buffer wire;
  bool operator==(const Kept&) const = default;
};

Buffer Ramp(std::size_t size) {
  Buffer payload(size);
  std::iota(payload.begin(), payload.end(), std::uint8_t{0});
  return payload;
}

Buffer Hello(std::uint32_t magic = kClientMagic) {
  Buffer stream;
  AppendHello(magic, stream);
  return stream;
}

/// The bytes that a client sends; they begin with its greeting.
Buffer ClientStream() {
  Buffer stream = Hello();
  AppendFrame(FrameType::kSubscribe, "TRUTH|HOST_.*", {}, stream);
  AppendFrame(FrameType::kPublish, "TRUTH", Ramp(300), stream);
  AppendFrame(FrameType::kPublish, "EMPTY", {}, stream);
  AppendFrame(FrameType::kUnsubscribe, "TRUTH|HOST_.*", {}, stream);
  AppendFrame(FrameType::kPublish, "LONG", Ramp(5000), stream);
  return stream;
}

void TakeAll(FrameParser& parser, std::vector<Kept>& frames) {
  while (const auto frame = parser.Next()) {
    frames.push_back({frame->type, std::string(frame->name),
                      Buffer(frame->payload.begin(), frame->payload.end()),
                      Buffer(frame->wire.begin(), frame->wire.end())});
  }
}

/// The error of a parser that gets this stream in one piece.
std::string ErrorOf(const Buffer& stream, const Limits& limits = {}) {
  FrameParser parser(kClientMagic, limits);
  parser.Append(stream);
  std::vector<Kept> frames;
  TakeAll(parser, frames);
  return parser.error();
}

/// A stream with a frame header that consists of these words.
Buffer Claim(std::initializer_list<std::uint32_t> words, std::string_view name = "") {
  Buffer stream = Hello();
  for (const std::uint32_t word : words) {
    for (const int shift : {24, 16, 8, 0}) {
      stream.push_back(static_cast<std::uint8_t>(word >> shift));
    }
  }
  stream.insert(stream.end(), name.begin(), name.end());
  return stream;
}

TEST(FrameParserTest, GivesBackWhatWasSent) {
  FrameParser parser(kClientMagic, {});
  parser.Append(ClientStream());
  std::vector<Kept> frames;
  TakeAll(parser, frames);
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[0].type, FrameType::kSubscribe);
  EXPECT_EQ(frames[0].name, "TRUTH|HOST_.*");
  EXPECT_EQ(frames[1].name, "TRUTH");
  EXPECT_EQ(frames[1].payload, Ramp(300));
  EXPECT_EQ(frames[2].name, "EMPTY");
  EXPECT_TRUE(frames[2].payload.empty());
  EXPECT_EQ(frames[3].type, FrameType::kUnsubscribe);
  EXPECT_EQ(frames[4].payload, Ramp(5000));
  EXPECT_EQ(parser.error(), "");
}

TEST(FrameParserTest, HasTheWireFormatOfLcm) {
  // GIVEN the bytes that LCM's client sends for two bytes on channel "AB"
  const Buffer expected{0x28, 0x76, 0x17, 0xfb, 0,   0,   1, 0, 0, 0, 0,    1,
                        0,    0,    0,    2,    'A', 'B', 0, 0, 0, 2, 0xfe, 0x01};
  Buffer stream = Hello();
  AppendFrame(FrameType::kPublish, "AB", Buffer{0xfe, 0x01}, stream);
  EXPECT_EQ(stream, expected);
}

TEST(FrameParserTest, KeepsTheWireBytesOfAFrame) {
  FrameParser parser(kClientMagic, {});
  const Buffer stream = ClientStream();
  parser.Append(stream);
  std::vector<Kept> frames;
  TakeAll(parser, frames);
  Buffer joined = Hello();
  for (const Kept& frame : frames) {
    joined.insert(joined.end(), frame.wire.begin(), frame.wire.end());
  }
  EXPECT_EQ(joined, stream);
}

TEST(FrameParserTest, DoesNotCareHowTheStreamIsCut) {
  const Buffer stream = ClientStream();
  FrameParser whole(kClientMagic, {});
  whole.Append(stream);
  std::vector<Kept> expected;
  TakeAll(whole, expected);
  for (const std::size_t piece : {1U, 2U, 3U, 5U, 7U, 64U, 1000U}) {
    FrameParser parser(kClientMagic, {});
    std::vector<Kept> frames;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      parser.Append(runtime::Bytes(stream).subspan(at, std::min(piece, stream.size() - at)));
      TakeAll(parser, frames);
    }
    EXPECT_TRUE(frames == expected) << "in pieces of " << piece;
    EXPECT_EQ(parser.error(), "");
  }
}

TEST(FrameParserTest, NamesWhatIsNotTcpq) {
  const std::string http = "GET / HTTP/1.1\r\n\r\n";
  EXPECT_EQ(ErrorOf(Buffer(http.begin(), http.end())),
            "begins with 0x47455420, not with tcpq's 0x287617fb");
  EXPECT_EQ(ErrorOf(Hello(kRelayMagic)), "begins with 0x287617fa, not with tcpq's 0x287617fb");
  EXPECT_EQ(ErrorOf({0x28, 0x76, 0x17, 0xfb, 0, 0, 2, 0}),
            "speaks version 0x0200 of tcpq, not 0x0100");
  EXPECT_EQ(ErrorOf(Claim({4})), "frame of unknown type 4");
  EXPECT_EQ(ErrorOf(Claim({0})), "frame of unknown type 0");
  EXPECT_EQ(ErrorOf(Claim({1, 3}, std::string_view("A\0B", 3))), "a zero byte in \"A?B\"");
}

TEST(FrameParserTest, RefusesWhatIsTooLongBeforeItComes) {
  const Limits limits{.channel = 8, .pattern = 16, .payload = 100};
  EXPECT_EQ(ErrorOf(Claim({1, 9}), limits), "channel name of 9 bytes; at most 8");
  EXPECT_EQ(ErrorOf(Claim({1, 0xffffffff}), limits), "channel name of 4294967295 bytes; at most 8");
  EXPECT_EQ(ErrorOf(Claim({2, 17}), limits), "pattern of 17 bytes; at most 16");
  Buffer large = Claim({1, 3}, "IMG");
  large.insert(large.end(), {0x80, 0, 0, 0});
  EXPECT_EQ(ErrorOf(large, limits), "message of 2147483648 bytes on \"IMG\"; at most 100");
}

TEST(FrameParserTest, TakesFramesAtTheLimits) {
  const Limits limits{.channel = 8, .pattern = 16, .payload = 100};
  Buffer stream = Hello();
  AppendFrame(FrameType::kSubscribe, "0123456789abcdef", {}, stream);
  AppendFrame(FrameType::kPublish, "01234567", Ramp(100), stream);
  EXPECT_EQ(ErrorOf(stream, limits), "");
}

TEST(FrameParserTest, GivesNothingMoreAfterAnError) {
  FrameParser parser(kClientMagic, {});
  parser.Append(Claim({7}));
  EXPECT_FALSE(parser.Next());
  const std::string error = parser.error();
  ASSERT_NE(error, "");
  parser.Append(ClientStream());
  EXPECT_FALSE(parser.Next());
  EXPECT_EQ(parser.error(), error);
}

TEST(FrameParserTest, SurvivesBytesThatAreChangedAtRandom) {
  // The test expects that every frame from the parser is within these limits, and lies within the
  // input.
  const Limits limits{.channel = 63, .pattern = 64, .payload = 6000};
  std::mt19937_64 engine(20'260'101);
  const auto below = [&engine](std::size_t n) { return static_cast<std::size_t>(engine() % n); };
  int refused = 0;
  constexpr int kStreams = 3000;
  for (int i = 0; i < kStreams; ++i) {
    Buffer stream = ClientStream();
    for (std::size_t n = below(4); n > 0; --n) {
      stream[below(below(2) == 0 ? 60 : stream.size())] = static_cast<std::uint8_t>(below(256));
    }
    FrameParser parser(kClientMagic, limits);
    std::size_t taken = 0;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t piece = std::min(1 + below(2000), stream.size() - at);
      parser.Append(runtime::Bytes(stream).subspan(at, piece));
      at += piece;
      while (const auto frame = parser.Next()) {
        taken += frame->wire.size();
        ASSERT_LE(frame->name.size(), 64U);
        ASSERT_LE(frame->payload.size(), limits.payload);
        ASSERT_LE(taken, at);
      }
    }
    if (!parser.error().empty()) ++refused;
  }
  // The test proves nothing if the parser refuses all streams, or none.
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, kStreams);
}

}  // namespace
}  // namespace fogline::runtime::tcpq
