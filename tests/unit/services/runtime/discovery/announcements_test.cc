#include "services/runtime/discovery/announcements.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <functional>

namespace fogline {
namespace {

constexpr std::int64_t kNow_us = 1'700'000'000'000'000;

beacon_t Beacon(std::int64_t run_id) {
  beacon_t beacon{};
  beacon.header.run_id = run_id;
  beacon.began_us = kNow_us + run_id;
  beacon.url = "udpm://239.255.76.67:7700?ttl=0";
  beacon.scenario = "Nebel über der Straße";
  beacon.host = "lab1";
  beacon.pid = 4711;
  beacon.awaited = {"driver"};
  beacon.num_awaited = 1;
  return beacon;
}

class AnnouncementsTest : public testing::Test {
 protected:
  void Hear(const beacon_t& beacon) {
    std::vector<std::uint8_t> bytes;
    runtime::Encode(beacon, bytes);
    Hear(bytes);
  }
  void Hear(runtime::Bytes bytes) { announcements_.Hear(bytes, now_, kNow_us); }
  std::vector<std::int64_t> Runs() const {
    std::vector<std::int64_t> ids;
    for (const runtime::Announcement& run : announcements_.Current(now_)) ids.push_back(run.run_id);
    return ids;
  }

  runtime::Announcements announcements_{"lab1"};
  TimePoint now_ = Clock::now();
};

TEST_F(AnnouncementsTest, TellOfARunWhatItsBeaconSays) {
  Hear(Beacon(7));
  ASSERT_THAT(Runs(), testing::ElementsAre(7));
  const runtime::Announcement run = announcements_.Current(now_).front();
  EXPECT_EQ(run.url, "udpm://239.255.76.67:7700?ttl=0");
  EXPECT_EQ(run.scenario, "Nebel über der Straße");
  EXPECT_EQ(run.pid, 4711);
  EXPECT_TRUE(run.Awaits(Role::kDriver));
  EXPECT_FALSE(run.Awaits(Role::kAcc));
  EXPECT_EQ(run.Text(),
            "run 7 at udpm://239.255.76.67:7700?ttl=0, scenario Nebel ??ber der Stra??e, announced "
            "by pid 4711 on lab1; it waits for the driver");
}

TEST_F(AnnouncementsTest, BeginWithTheRunThatBeganLast) {
  for (const int run : {5, 9, 7}) Hear(Beacon(run));
  EXPECT_THAT(Runs(), testing::ElementsAre(9, 7, 5));
}

TEST_F(AnnouncementsTest, TellWhatARunWaitsForNow) {
  Hear(Beacon(7));
  beacon_t later = Beacon(7);
  later.awaited.clear();
  later.num_awaited = 0;
  Hear(later);
  EXPECT_THAT(announcements_.Current(now_).front().awaited, testing::IsEmpty());
}

TEST_F(AnnouncementsTest, ForgetARunThatIsOverOrSilent) {
  Hear(Beacon(7));
  Hear(Beacon(8));
  beacon_t last = Beacon(7);
  last.over = 1;
  Hear(last);
  EXPECT_THAT(Runs(), testing::ElementsAre(8));
  now_ += runtime::Announcements::kGone;
  EXPECT_THAT(Runs(), testing::ElementsAre(8));
  now_ += milliseconds(1);
  EXPECT_THAT(Runs(), testing::IsEmpty());
  EXPECT_EQ(announcements_.refused(), 0);
}

TEST_F(AnnouncementsTest, RefuseWhatNoRunnerOfThisMachineCanHaveSaid) {
  const std::vector<std::function<void(beacon_t&)>> wrongs{
      [](beacon_t& b) { b.header.run_id = 0; },
      [](beacon_t& b) { b.header.run_id = -1; },
      [](beacon_t& b) { b.pid = 0; },
      [](beacon_t& b) { b.began_us = 0; },
      [](beacon_t& b) { b.began_us = kNow_us + 60'000'000; },
      [](beacon_t& b) { b.host = "lab2"; },
      [](beacon_t& b) { b.host = ""; },
      [](beacon_t& b) { b.scenario = "\x1b[2J"; },
      [](beacon_t& b) { b.scenario = "\xff"; },
      [](beacon_t& b) { b.scenario = "\xc2\x9b"; },
      [](beacon_t& b) { b.scenario = std::string(runtime::Announcements::kMaxTitle + 1, 'x'); },
      [](beacon_t& b) { b.url = "udpm://10.0.0.1:7700"; },
      [](beacon_t& b) { b.url = "udpm://239.255.76.67:7700?ttl=32"; },
      [](beacon_t& b) { b.url = "tcpq://192.0.2.1:7700"; },
      [](beacon_t& b) { b.url = "udpm://239.255.76.67:7700?ttl=0\n"; },
      [](beacon_t& b) { b.url = "udpm://239.255.76.67:7700'; reboot; '"; },
      [](beacon_t& b) { b.awaited = {"pilot"}; },
      [](beacon_t& b) {
        b.awaited = {"driver", "driver"};
        b.num_awaited = 2;
      },
  };
  std::int64_t refused = 0;
  for (const auto& wrong : wrongs) {
    beacon_t beacon = Beacon(7);
    wrong(beacon);
    Hear(beacon);
    EXPECT_THAT(Runs(), testing::IsEmpty());
    EXPECT_EQ(announcements_.refused(), ++refused);
  }
}

TEST_F(AnnouncementsTest, RefuseBytesThatAreNotExactlyOneBeacon) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(Beacon(7), bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size) Hear(runtime::Bytes(bytes).first(size));
  EXPECT_EQ(announcements_.refused(), std::ssize(bytes));
  bytes.push_back(0);
  Hear(bytes);
  EXPECT_EQ(announcements_.refused(), std::ssize(bytes));
  EXPECT_THAT(Runs(), testing::IsEmpty());
}

TEST_F(AnnouncementsTest, LetNoOtherProcessMoveOrEndARun) {
  Hear(Beacon(7));
  beacon_t elsewhere = Beacon(7);
  elsewhere.url = "udpm://239.255.76.67:7701?ttl=0";
  Hear(elsewhere);
  elsewhere.over = 1;
  Hear(elsewhere);
  beacon_t other_process = Beacon(7);
  other_process.pid = 1;
  other_process.over = 1;
  Hear(other_process);
  EXPECT_EQ(announcements_.refused(), 3);
  ASSERT_THAT(Runs(), testing::ElementsAre(7));
  EXPECT_EQ(announcements_.Current(now_).front().url, Beacon(7).url);
}

TEST_F(AnnouncementsTest, AreBoundedAndHideNoRunThatGoesOnSpeaking) {
  // GIVEN a run that has announced itself twice, and a flood of invented runs
  Hear(Beacon(7));
  now_ += runtime::kBeaconEvery;
  Hear(Beacon(7));
  for (int i = 0; i < 10'000; ++i) Hear(Beacon(1000 + i));
  EXPECT_EQ(Runs().size(), runtime::Announcements::kMax);
  EXPECT_THAT(Runs(), testing::Contains(7));
}

}  // namespace
}  // namespace fogline
