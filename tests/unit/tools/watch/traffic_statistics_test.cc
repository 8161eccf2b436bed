#include "tools/watch/traffic_statistics.h"

#include <limits>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/runtime/wire/message_signer.h"
#include "tests/unit/tools/watch/now.h"

namespace fogline {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr std::int64_t kRun = 4711;

template <class M>
std::vector<std::uint8_t> Encoded(const M& message) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  return bytes;
}

std::vector<std::uint8_t> Radar(std::int64_t run_id, std::int64_t step) {
  radar_t radar{};
  radar.header = {.run_id = run_id, .step = step, .utime = 100'000 * step};
  return Encoded(radar);
}

status_t Status(const std::string& role, std::int64_t instance, std::int64_t sequence) {
  status_t status{};
  status.header = {.run_id = kRun, .step = 12, .utime = 0};
  status.role = role;
  status.host = "lab";
  status.instance = instance;
  status.sequence = sequence;
  status.state = status_t::RUNNING;
  return status;
}

class TrafficStatisticsTest : public testing::Test {
 protected:
  void Add(std::string_view channel, const std::vector<std::uint8_t>& bytes, int at_ms = 0) {
    statistics_.Add(channel, bytes, kNow + milliseconds(at_ms));
  }
  watch::TrafficView Observe(int at_ms) { return statistics_.Observe(kNow + milliseconds(at_ms)); }

  watch::TrafficStatistics statistics_{kNow};
};

TEST_F(TrafficStatisticsTest, ShowsRunsApart) {
  for (int step = 0; step < 10; ++step) Add("RADAR", Radar(kRun, step), 100 * step);
  for (int step = 0; step < 5; ++step) Add("RADAR", Radar(kRun + 1, 2 * step), 900);
  const watch::TrafficView view = Observe(1000);
  ASSERT_EQ(view.runs.size(), 2U);
  EXPECT_EQ(view.runs[0].run_id, kRun);
  EXPECT_EQ(view.runs[0].step, 9);
  ASSERT_EQ(view.runs[0].channels.size(), 1U);
  EXPECT_EQ(view.runs[0].channels[0].channel, "RADAR");
  EXPECT_EQ(view.runs[0].channels[0].type, "radar_t");
  EXPECT_DOUBLE_EQ(view.runs[0].channels[0].arrivals.rate_hz, 10);
  EXPECT_EQ(view.runs[0].channels[0].steps->missing, 0);
  EXPECT_EQ(view.runs[1].run_id, kRun + 1);
  EXPECT_DOUBLE_EQ(view.runs[1].channels[0].arrivals.rate_hz, 5);
  EXPECT_EQ(view.runs[1].channels[0].steps->missing, 4);
  EXPECT_TRUE(view.others.empty());
}

TEST_F(TrafficStatisticsTest, TakesAnyProcessorTimeThatAMessageMayHave) {
  // GIVEN two readings with a difference that does not fit into 64 bits
  status_t status = Status("radar", 1, 1);
  status.cpu_ms = std::numeric_limits<std::int64_t>::min();
  Add("STATUS", Encoded(status));
  status.sequence = 2;
  status.cpu_ms = std::numeric_limits<std::int64_t>::max();
  Add("STATUS", Encoded(status), 500);
  const watch::TrafficView view = Observe(1000);
  ASSERT_EQ(view.runs[0].roles.size(), 1U);
  EXPECT_GT(view.runs[0].roles[0].cpu_percent.value_or(0), 1e18);
}

TEST_F(TrafficStatisticsTest, CountsNamesThatItDoesNotKnow) {
  for (int i = 0; i < 100; ++i) Add(fmt::format("NAME{}", i), {1});
  Add("NAME99", {1});
  EXPECT_EQ(statistics_.unknown_names(), 100);
  EXPECT_EQ(Observe(1000).others.size(), watch::TrafficStatistics::kMaxOthers);
}

TEST_F(TrafficStatisticsTest, ShowsSignedMessagesWithoutAKey) {
  runtime::MessageSigner signer(runtime::SigningKey(runtime::SigningKey::Secret{}), std::nullopt);
  const runtime::Bytes radar = signer.Sign("RADAR", Radar(kRun, 3));
  Add("RADAR", {radar.begin(), radar.end()});
  const watch::TrafficView view = Observe(1000);
  ASSERT_EQ(view.runs.size(), 1U);
  EXPECT_EQ(view.runs[0].step, 3);
  EXPECT_EQ(view.runs[0].channels[0].NumUndecodable(), 0);
}

TEST_F(TrafficStatisticsTest, NamesTheTypeOfWhatItCannotDecode) {
  lidar_t lidar{};
  lidar.header = {.run_id = kRun, .step = 1, .utime = 0};
  std::vector<std::uint8_t> cut = Radar(kRun, 2);
  cut.pop_back();
  Add("RADAR", Radar(kRun, 0));
  Add("RADAR", Encoded(lidar));  // a lidar_t whose header names this run
  Add("RADAR", cut);
  Add("RADAR", {1, 2, 3});  // too short to name a run
  const watch::TrafficView view = Observe(1000);
  ASSERT_EQ(view.runs.size(), 1U);
  const watch::ChannelView& radar = view.runs[0].channels[0];
  EXPECT_EQ(radar.arrivals.messages, 3);
  EXPECT_EQ(radar.NumUndecodable(), 2);
  EXPECT_THAT(radar.undecodable, ElementsAre(Pair("lidar_t", 1), Pair("radar_t", 1)));
  EXPECT_EQ(radar.steps->newest, 0);
  ASSERT_EQ(view.others.size(), 1U);
  EXPECT_EQ(view.others[0].channel, "RADAR");
  EXPECT_THAT(view.others[0].undecodable, ElementsAre(Pair("unknown", 1)));
}

TEST_F(TrafficStatisticsTest, ListsChannelsThatItDoesNotKnow) {
  Add("CAMERA", {1, 2, 3}, 100);
  Add("CAMERA", {}, 300);
  Add("RADAR_AGAIN", Radar(kRun, 0), 500);
  const watch::TrafficView view = Observe(1000);
  EXPECT_TRUE(view.runs.empty());
  ASSERT_EQ(view.others.size(), 2U);
  EXPECT_EQ(view.others[0].channel, "CAMERA");
  EXPECT_EQ(view.others[0].type, "");
  EXPECT_DOUBLE_EQ(view.others[0].arrivals.rate_hz, 2);
  EXPECT_EQ(view.others[0].NumUndecodable(), 0);
  EXPECT_FALSE(view.others[0].steps);
  EXPECT_EQ(view.others[1].type, "radar_t");
}

TEST_F(TrafficStatisticsTest, KnowsPhaseAndPaceFromRun) {
  run_t run{};
  run.header = {.run_id = kRun, .step = 0, .utime = 0};
  run.phase = run_t::GO;
  run.pace = 2;
  run.scenario_hash = "abc";
  Add("RUN", Encoded(run));
  const watch::TrafficView view = Observe(1000);
  ASSERT_EQ(view.runs.size(), 1U);
  EXPECT_EQ(view.runs[0].phase, std::optional<std::int8_t>(run_t::GO));
  EXPECT_EQ(view.runs[0].pace, 2);
  EXPECT_EQ(view.runs[0].scenario_hash, "abc");
}

TEST_F(TrafficStatisticsTest, ComputesProcessorUseFromTwoReadings) {
  // GIVEN 50 ms of processor time within 200 ms
  status_t status = Status("fusion", 1, 1);
  status.cpu_ms = 1000;
  Add("STATUS", Encoded(status), 100);
  EXPECT_FALSE(Observe(200).runs.at(0).roles.at(0).cpu_percent);
  status.sequence = 2;
  status.cpu_ms = 1050;
  Add("STATUS", Encoded(status), 300);
  EXPECT_DOUBLE_EQ(Observe(400).runs.at(0).roles.at(0).cpu_percent.value(), 25);
  // WHEN no new reading comes THEN the last value stays
  EXPECT_DOUBLE_EQ(Observe(500).runs.at(0).roles.at(0).cpu_percent.value(), 25);
}

TEST_F(TrafficStatisticsTest, CallsARoleSilentAfterASecond) {
  Add("STATUS", Encoded(Status("fusion", 1, 1)), 0);
  EXPECT_FALSE(Observe(1000).runs.at(0).roles.at(0).silent);
  EXPECT_TRUE(Observe(1001).runs.at(0).roles.at(0).silent);
  // A repeated old STATUS is not a sign of life.
  Add("STATUS", Encoded(Status("fusion", 1, 1)), 1100);
  EXPECT_TRUE(Observe(1200).runs.at(0).roles.at(0).silent);
  Add("STATUS", Encoded(Status("fusion", 1, 2)), 1300);
  EXPECT_FALSE(Observe(1400).runs.at(0).roles.at(0).silent);
}

TEST_F(TrafficStatisticsTest, KeepsRolesInTheOrderOfTheGraphAndInstancesApart) {
  Add("STATUS", Encoded(Status("recorder", 3, 1)), 0);
  Add("STATUS", Encoded(Status("world", 1, 1)), 0);
  Add("STATUS", Encoded(Status("recorder", 4, 1)), 500);
  const auto roles = Observe(1000).runs.at(0).roles;
  ASSERT_EQ(roles.size(), 3U);
  EXPECT_EQ(roles[0].status.role, "world");
  EXPECT_EQ(roles[1].status.instance, 3);
  EXPECT_EQ(roles[2].status.instance, 4);
  // The statistics forget a process some time after another process has replaced it. They do not
  // forget the last process of a role.
  const auto later = Observe(60'000).runs.at(0).roles;
  ASSERT_EQ(later.size(), 2U);
  EXPECT_EQ(later[0].status.role, "world");
  EXPECT_EQ(later[1].status.instance, 4);
}

TEST_F(TrafficStatisticsTest, RemembersNoMoreThanItsBoundsWhateverArrives) {
  for (int i = 0; i < 1000; ++i) {
    Add("RADAR", Radar(kRun, i), i);
    Add("RADAR", Radar(100'000 + i, 0), i);
    Add("CHANNEL_" + std::to_string(i), {}, i);
    Add("STATUS", Encoded(Status("world", i, 1)), i);
  }
  const watch::TrafficView view = Observe(1000);
  EXPECT_EQ(view.runs.size(), watch::TrafficStatistics::kMaxRuns);
  EXPECT_EQ(view.others.size(), watch::TrafficStatistics::kMaxOthers);
  EXPECT_EQ(view.forgotten, (1001 - static_cast<int>(watch::TrafficStatistics::kMaxRuns)) +
                                (1000 - static_cast<int>(watch::TrafficStatistics::kMaxOthers)) +
                                (1000 - static_cast<int>(watch::TrafficStatistics::kMaxRoles)));
  // The run that sends all the time is still in the view, with all its messages.
  const auto run = std::ranges::find(view.runs, kRun, &watch::RunView::run_id);
  ASSERT_NE(run, view.runs.end());
  EXPECT_EQ(run->channels.at(0).arrivals.messages, 1000);
  EXPECT_EQ(run->roles.size(), watch::TrafficStatistics::kMaxRoles);
}

}  // namespace
}  // namespace fogline
