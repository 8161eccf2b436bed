// Tests that messages are put together from packets in any order.
#include "tools/record/message_assembler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace fogline::record {
namespace {

using Bytes = std::vector<std::uint8_t>;

void Put(std::uint32_t value, std::size_t bytes, Bytes& packet) {
  while (bytes-- > 0) packet.push_back(static_cast<std::uint8_t>(value >> (8 * bytes)));
}

/// The packets of a message in fragments, as LCM sends them.
std::vector<Bytes> Fragments(std::uint32_t number, const Bytes& data, std::size_t size) {
  std::vector<Bytes> packets;
  const std::size_t count = (data.size() + size - 1) / size;
  for (std::size_t i = 0; i < count; ++i) {
    Bytes packet{'L', 'C', '0', '3'};
    Put(number, 4, packet);
    Put(static_cast<std::uint32_t>(data.size()), 4, packet);
    Put(static_cast<std::uint32_t>(i * size), 4, packet);
    Put(static_cast<std::uint32_t>(i), 2, packet);
    Put(static_cast<std::uint32_t>(count), 2, packet);
    if (i == 0) packet.insert(packet.end(), {'C', 'A', 'M', 0});
    const std::size_t end = std::min(data.size(), (i + 1) * size);
    packet.insert(packet.end(), data.begin() + static_cast<std::ptrdiff_t>(i * size),
                  data.begin() + static_cast<std::ptrdiff_t>(end));
    packets.push_back(packet);
  }
  return packets;
}

class MessageAssemblerTest : public testing::Test {
 protected:
  std::optional<Message> Add(const Bytes& packet, std::uint16_t port = 1) {
    return assembler_.Add({.from = {.host = 1, .port = port}, .bytes = packet, .unix_us = 7});
  }
  static Bytes Data(std::size_t size) {
    Bytes data(size);
    for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<std::uint8_t>(i * 7);
    return data;
  }

  MessageAssembler assembler_;
};

TEST_F(MessageAssemblerTest, AShortMessageIsOnePacket) {
  const Bytes packet{'L', 'C', '0', '2', 0, 0, 0, 9, 'A', 'B', 0, 1, 2};
  const auto message = Add(packet);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "AB");
  EXPECT_EQ(message->unix_us, 7);
  EXPECT_EQ(Bytes(message->data.begin(), message->data.end()), (Bytes{1, 2}));
}

TEST_F(MessageAssemblerTest, FragmentsMayComeInAnyOrderTwiceAndBetweenThoseOfOthers) {
  const Bytes data = Data(1000);
  const std::vector<Bytes> packets = Fragments(3, data, 300);
  ASSERT_EQ(packets.size(), 4U);
  EXPECT_FALSE(Add(packets[2]));
  EXPECT_FALSE(Add(packets[2]));
  EXPECT_FALSE(Add(packets[0], 2));
  EXPECT_FALSE(Add(packets[3]));
  EXPECT_FALSE(Add(packets[0]));
  const auto message = Add(packets[1]);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "CAM");
  EXPECT_EQ(Bytes(message->data.begin(), message->data.end()), data);
}

TEST_F(MessageAssemblerTest, RefusesImpossibleFragments) {
  const std::vector<Bytes> packets = Fragments(3, Data(1000), 500);
  Bytes too_far = packets[1];
  too_far[12] = 0x7f;  // the offset of the part
  EXPECT_FALSE(Add(too_far));
  Bytes too_large = packets[1];
  too_large[8] = 0x20;  // the size of the message: 512 MB
  EXPECT_FALSE(Add(too_large));
  EXPECT_FALSE(Add({'L', 'C', '0', '3', 0}));
  EXPECT_FALSE(Add({}));
  EXPECT_FALSE(Add(packets[0]));
  EXPECT_TRUE(Add(packets[1]));
}

TEST_F(MessageAssemblerTest, GivesUpTheOldestMessagesThatWaitForFragments) {
  const Bytes data = Data(1000);
  const std::vector<Bytes> first = Fragments(0, data, 500);
  EXPECT_FALSE(Add(first[0]));
  for (std::uint32_t number = 1; number <= MessageAssembler::kMostPartial; ++number) {
    EXPECT_FALSE(Add(Fragments(number, data, 500)[0]));
  }
  EXPECT_EQ(assembler_.given_up(), 1);
  EXPECT_FALSE(Add(first[1]));                     // its other fragment is forgotten
  EXPECT_TRUE(Add(Fragments(500, data, 500)[1]));  // this one is still remembered
}

}  // namespace
}  // namespace fogline::record
