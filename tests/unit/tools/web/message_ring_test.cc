#include "tools/web/message_ring.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace fogline::web {
namespace {

/// A message of this size that contains its number.
std::vector<std::uint8_t> Numbered(std::uint32_t number, std::size_t size) {
  std::vector<std::uint8_t> bytes(size, 7);
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
  return bytes;
}

std::uint32_t NumberOf(runtime::Bytes bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
  return number;
}

/// Reads the ring from `place` to the end of the ring. @return the numbers of the messages
std::vector<std::uint32_t> ReadFrom(const MessageRing& ring, std::uint64_t& place) {
  std::vector<std::uint32_t> numbers;
  while (place < ring.end()) {
    std::string_view messages = ring.From(place);
    EXPECT_FALSE(messages.empty());
    place += messages.size();
    while (!messages.empty()) numbers.push_back(NumberOf(TakeRingMessage(messages).bytes));
  }
  return numbers;
}

TEST(MessageRingTest, GivesBackWhatWasAdded) {
  MessageRing ring;
  EXPECT_EQ(ring.From(ring.begin()), "");
  const auto bytes = Numbered(1, 20);
  ring.Add({.channel = 513, .wall_ms = 1234.5, .bytes = bytes});
  std::string_view messages = ring.From(ring.begin());
  EXPECT_EQ(messages.size(), 2 + 8 + 4 + 20U);
  const RingMessage message = TakeRingMessage(messages);
  EXPECT_EQ(message.channel, 513);
  EXPECT_EQ(message.wall_ms, 1234.5);
  EXPECT_EQ(std::vector(message.bytes.begin(), message.bytes.end()), bytes);
  EXPECT_EQ(messages, "");
}

TEST(MessageRingTest, GivesEachReaderAllMessagesInTheirOrder) {
  MessageRing ring;
  std::uint64_t often = 0;
  std::uint64_t seldom = 0;
  std::uint32_t next_often = 0;
  std::uint32_t next_seldom = 0;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    ring.Add({.channel = 1, .wall_ms = 0.01 * i, .bytes = Numbered(i, 4 + i % 1400)});
    if (i % 7 == 0) {
      for (const std::uint32_t number : ReadFrom(ring, often)) EXPECT_EQ(number, next_often++);
    }
    if (i % 5000 == 0) {
      for (const std::uint32_t number : ReadFrom(ring, seldom)) EXPECT_EQ(number, next_seldom++);
    }
  }
  ReadFrom(ring, often);
  EXPECT_EQ(often, ring.end());
}

TEST(MessageRingTest, KeepsNoMoreThan64MiB) {
  MessageRing ring;
  const std::vector<std::uint8_t> bytes(100'000);
  for (int i = 0; i < 1000; ++i) ring.Add({.channel = 1, .wall_ms = 0, .bytes = bytes});
  EXPECT_LE(ring.end() - ring.begin(), MessageRing::kMostBytes);
  EXPECT_GT(ring.end() - ring.begin(), MessageRing::kMostBytes * 9 / 10);
}

TEST(MessageRingTest, ForgetsMessagesOfMoreThanAMinute) {
  MessageRing ring;
  // 1000 messages of 1000 bytes a minute, for three minutes. The ring keeps about the last minute.
  for (std::uint32_t i = 0; i < 3000; ++i) {
    ring.Add({.channel = 1, .wall_ms = 60.0 * i, .bytes = Numbered(i, 1000)});
  }
  std::uint64_t place = ring.begin();
  const auto kept = ReadFrom(ring, place);
  EXPECT_EQ(kept.back(), 2999U);
  EXPECT_GE(kept.size(), 1000U);
  EXPECT_LE(kept.size(), 1000U + 2 * MessageRing::kChunkBytes / 1000);
}

TEST(MessageRingTest, TakesAMessageThatIsLargerThanAChunk) {
  MessageRing ring;
  ring.Add({.channel = 1, .wall_ms = 0, .bytes = Numbered(1, 10)});
  ring.Add({.channel = 1, .wall_ms = 0, .bytes = Numbered(2, 3 * MessageRing::kChunkBytes)});
  ring.Add({.channel = 1, .wall_ms = 0, .bytes = Numbered(3, 10)});
  std::uint64_t place = ring.begin();
  EXPECT_EQ(ReadFrom(ring, place), (std::vector<std::uint32_t>{1, 2, 3}));
}

}  // namespace
}  // namespace fogline::web
