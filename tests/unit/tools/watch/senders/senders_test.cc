#include "tools/watch/senders/senders.h"

#include <gmock/gmock-more-matchers.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/tools/watch/now.h"
#include "tools/watch/senders/senders_report.h"

namespace fogline::watch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr SenderAddress kWorld{.host = 0x7f000001, .port = 41234};

void Add(Senders& senders, const SenderAddress& from, int number, const std::string& channel,
         TimePoint now = kNow) {
  std::string packet("LC02\0\0\0", 7);
  packet += static_cast<char>(number);
  packet += channel + '\0';
  senders.Add(from, {reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size()}, now);
}

TEST(SendersTest, CountsEachSocketForItself) {
  Senders senders;
  const SenderAddress radar{.host = 0xc0a80002, .port = 7};
  for (const int number : {0, 1, 4}) Add(senders, kWorld, number, "TRUTH");
  for (const int number : {8, 9}) Add(senders, radar, number, "RADAR");
  const SendersView view = senders.View(kNow + milliseconds(2000));
  ASSERT_EQ(view.senders.size(), 2U);
  EXPECT_EQ(view.senders[0].address, "127.0.0.1:41234");
  EXPECT_EQ(view.senders[0].counts, (SenderSequence::Counts{.received = 3, .lost = 2}));
  EXPECT_THAT(view.senders[0].channels, ElementsAre("TRUTH"));
  EXPECT_EQ(view.senders[0].age_s, 2);
  EXPECT_EQ(view.senders[1].address, "192.168.0.2:7");
  EXPECT_EQ(view.senders[1].counts.lost, 0);
}

TEST(SendersTest, ShowsNoSenderOfSelfTestsAndBeaconsOnly) {
  Senders senders;
  Add(senders, kWorld, 0, "LCM_SELF_TEST");
  EXPECT_THAT(senders.View(kNow).senders, IsEmpty());
  Add(senders, kWorld, 1, "CAMERA");
  const SendersView view = senders.View(kNow);
  ASSERT_EQ(view.senders.size(), 1U);
  EXPECT_EQ(view.senders[0].counts.received, 2);
  EXPECT_THAT(view.senders[0].channels, ElementsAre("CAMERA"));
}

TEST(SendersTest, NamesChannelsOfMessagesInFragments) {
  Senders senders;
  Add(senders, kWorld, 0, "TRUTH");
  EXPECT_EQ(FragmentsText(senders.View(kNow)), "");
  for (std::uint8_t fragment = 0; fragment < 3; ++fragment) {
    std::string packet("LC03\0\0\0\1\0\0\x10\0\0\0\0\0\0", 17);
    packet += static_cast<char>(fragment);
    packet += std::string("\0\3", 2);
    if (fragment == 0) packet += std::string("CAM\033ERA\0", 8);
    senders.Add(kWorld, {reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size()},
                kNow);
  }
  const SendersView view = senders.View(kNow);
  EXPECT_EQ(view.in_fragments, 1);
  EXPECT_EQ(view.senders[0].counts.received, 2);
  const std::string text = FragmentsText(view);
  EXPECT_THAT(text, HasSubstr("1 messages are larger than a datagram (CAM"));
  EXPECT_EQ(text.find('\033'), std::string::npos);
}

TEST(SendersTest, RemembersOnlySoManySendersAndChannels) {
  Senders senders;
  for (std::size_t i = 0; i < Senders::kMaxSenders + 3; ++i) {
    Add(senders, {.host = 1, .port = static_cast<std::uint16_t>(i)}, 0, "A",
        kNow + milliseconds(static_cast<int>(i)));
  }
  for (int i = 0; i < 20; ++i) Add(senders, {.host = 1, .port = 99}, i, "A" + std::to_string(i));
  const SendersView view = senders.View(kNow);
  EXPECT_EQ(view.senders.size(), Senders::kMaxSenders);
  EXPECT_EQ(view.forgotten, 3);
  EXPECT_EQ(view.senders.front().address, "0.0.0.1:3");  // the others were silent longest
  const auto many = std::ranges::find(view.senders, "0.0.0.1:99", &SenderView::address);
  EXPECT_EQ(many->channels.size(), Senders::kMaxChannels);
  EXPECT_TRUE(many->more_channels);
}

TEST(SendersTest, CountsPacketsThatAreNoneOfLcm) {
  Senders senders;
  const std::string packet = "GET / HTTP/1.1";
  senders.Add(kWorld, {reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size()}, kNow);
  EXPECT_EQ(senders.View(kNow).not_lcm, 1);
  EXPECT_THAT(senders.View(kNow).senders, IsEmpty());
}

TEST(SendersTest, PassesOwnDropsOnToTheSenders) {
  Senders senders;
  Add(senders, kWorld, 0, "TRUTH");
  senders.AddDropped(2);
  Add(senders, kWorld, 2, "TRUTH");
  EXPECT_EQ(senders.View(kNow).own_overflow, 2);
  EXPECT_EQ(senders.View(kNow).senders[0].counts.missed_here, 1);
}

TEST(SendersReportTest, ShowsLossInBadLinesAndPassesNoControlCharactersOn) {
  Senders senders;
  EXPECT_THAT(SenderLines(senders.View(kNow)), IsEmpty());
  for (const int number : {0, 3}) Add(senders, kWorld, number, "\033[2JTRUTH");
  const std::vector<Line> lines = SenderLines(senders.View(kNow));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[2].text,
            " sender                 messages    lost    here   late  twice   age s  channels");
  EXPECT_EQ(lines[3].text,
            " 127.0.0.1:41234               2       2       0      0      0     0.0  ?[2JTRUTH");
  EXPECT_EQ(lines[3].style, Line::Style::kBad);
}

TEST(SendersReportTest, SaysThatTopItselfWasTooSlow) {
  Senders senders;
  Add(senders, kWorld, 0, "TRUTH");
  senders.AddDropped(17);
  EXPECT_THAT(SenderLines(senders.View(kNow)).back().text, HasSubstr("17 packets came faster"));
}

TEST(SendersReportTest, HasAnObjectForEachSender) {
  Senders senders;
  for (const int number : {0, 3, 3, 2}) Add(senders, kWorld, number, "TRUTH");
  EXPECT_EQ(SendersJson(senders.View(kNow)).dump(),
            R"([{"address":"127.0.0.1:41234","received":3,"lost":1,"missed_here":0,"late":1,)"
            R"("duplicates":1,"stray":0,"restarts":0,"age_s":0.0,"channels":["TRUTH"],)"
            R"("more_channels":false}])");
}

}  // namespace
}  // namespace fogline::watch
