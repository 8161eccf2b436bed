#include "services/runtime/transport/udpm/lcm_packet.h"

#include <gtest/gtest.h>

#include <string>

namespace fogline::runtime {
namespace {

using namespace std::string_literals;
using namespace std::string_view_literals;

std::optional<LcmPacket> Parsed(std::string_view text) {
  return ParsePacket({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(LcmPacketTest, ReadsAShortMessage) {
  const auto packet = Parsed("LC02\x01\x02\x03\x04TRUTH\0data"sv);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->number, 0x01020304U);
  EXPECT_EQ(packet->channel, "TRUTH");
  EXPECT_TRUE(packet->First());
  EXPECT_TRUE(packet->Whole());
  EXPECT_FALSE(packet->is_fragment);
}

TEST(LcmPacketTest, ReadsFragmentsOfALongMessage) {
  const auto first = Parsed("LC03\0\0\0\x07\0\1\0\0\0\0\0\0\0\0\0\3CAMERA\0data"sv);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->number, 7U);
  EXPECT_EQ(first->channel, "CAMERA");
  EXPECT_TRUE(first->First());
  EXPECT_FALSE(first->Whole());
  EXPECT_TRUE(first->is_fragment);
  EXPECT_EQ(first->fragments, 3);
  const auto second = Parsed("LC03\0\0\0\x07\0\1\0\0\0\0\x80\0\0\1\0\3 no channel"sv);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->fragment, 1);
  EXPECT_EQ(second->channel, "");
}

TEST(LcmPacketTest, NeedsOnlyTheHeadOfAPacket) {
  const std::string longest(runtime::kLongestChannel, 'c');
  std::string packet = "LC03\0\0\0\x07\0\1\0\0\0\0\0\0\0\0\0\3"s + longest + "\0"s;
  EXPECT_EQ(packet.size(), kPacketHead);
  EXPECT_EQ(Parsed(packet)->channel, longest);
}

TEST(LcmPacketTest, RefusesWhatLcmDoesNotTake) {
  const std::string too_long(runtime::kLongestChannel + 1, 'c');
  for (const std::string& packet :
       {""s, "LC02\0\0\0"s, "LC01\0\0\0\0A\0"s, "LC02\0\0\0\0A"s,
        "LC02\0\0\0\0"s + too_long + "\0"s, "LC03\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"s,
        "LC03\0\0\0\0\0\0\0\0\0\0\0\0\0\1\0\1A\0"s,     // fragment 1 of 1
        "LC03\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0A\0"s}) {  // of 0 fragments
    EXPECT_FALSE(Parsed(packet)) << packet;
  }
}

}  // namespace
}  // namespace fogline::runtime
