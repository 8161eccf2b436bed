#include "tools/web/seat/seat_told.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/graph.h"

namespace fogline::web {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

template <class Message>
std::optional<Message> Told(const Message& message) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  const auto told = ForSeat(IndexOf<Message>(), bytes);
  Message decoded{};
  if (!told || !runtime::Decode(*told, decoded)) return std::nullopt;
  return decoded;
}

TEST(SeatToldTest, ACommandOfTheHostHasNoThresholdAndNoConflict) {
  arbitration_t command{};
  command.header = {.run_id = 7, .step = 12, .utime = 240'000};
  command.acceleration_mps2 = -1;
  command.lambda_automation = 0.25;
  command.lambda_human = 0.75;
  command.doc = 0.5;
  command.conflict_m = 3;
  command.threshold = 0.625;
  command.mode = arbitration_t::REQUEST;
  const auto told = Told(command);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->header.run_id, 7);
  EXPECT_EQ(told->header.step, 12);
  EXPECT_EQ(told->header.utime, 240'000);
  EXPECT_EQ(told->lambda_human, 0.75);
  EXPECT_EQ(told->mode, arbitration_t::REQUEST);
  for (const double hidden : {told->acceleration_mps2, told->lambda_automation, told->doc,
                              told->conflict_m, told->threshold}) {
    EXPECT_EQ(hidden, 0);
  }
}

TEST(SeatToldTest, ACommandOfTheDriverNamesItsInput) {
  driver_command_t command{};
  command.header.step = 12;
  command.readiness = 0.5;
  command.input_instance = 99;
  command.input_sequence = 913;
  const auto told = Told(command);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->header.step, 12);
  EXPECT_EQ(told->readiness, 0);
  EXPECT_EQ(told->input_instance, 99);
  EXPECT_EQ(told->input_sequence, 913);
}

TEST(SeatToldTest, TheRoadIsToldAndNothingElse) {
  truth_t truth{};
  truth.host_speed_mps = 20;
  EXPECT_EQ(Told(truth)->host_speed_mps, 20);
  std::vector<std::uint8_t> bytes;
  runtime::Encode(truth, bytes);
  for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
    EXPECT_EQ(ForSeat(channel, bytes).has_value(), channel == IndexOf<truth_t>()) << channel;
  }
  EXPECT_FALSE(Told(trial_t{}));
  EXPECT_FALSE(Told(run_t{}));
}

TEST(SeatToldTest, OfTheRoadOnlyWhatTheWindscreenShowsIsTold) {
  truth_t truth{};
  truth.header = {.run_id = 7, .step = 12, .utime = 240'000};
  truth.preceding_position_m = 60;
  truth.preceding_speed_mps = 19;
  truth.preceding_acceleration_mps2 = -2;
  truth.host_position_m = 20;
  truth.host_speed_mps = 20;
  truth.host_acceleration_mps2 = -1;
  truth.host_gap_m = 35.5;
  truth.num_followers = 1;
  truth.follower_position_m = {-15};
  truth.follower_speed_mps = {20};
  truth.follower_acceleration_mps2 = {0.5};
  truth.follower_gap_m = {30.5};
  truth.fog_present = 1;
  truth.fog_level = 0.75;
  truth.fog_visibility_m = 60;
  truth.collision = truth_t::COLLISION_HOST;
  truth.collision_time_s = 0.24;
  truth.last = 1;
  const auto told = Told(truth);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->header.step, 12);
  EXPECT_EQ(told->preceding_position_m, 60);
  EXPECT_EQ(told->preceding_speed_mps, 19);
  EXPECT_EQ(told->preceding_acceleration_mps2, -2);
  EXPECT_EQ(told->host_position_m, 20);
  EXPECT_EQ(told->fog_visibility_m, 60);
  EXPECT_EQ(told->collision, truth_t::COLLISION_HOST);
  EXPECT_TRUE(told->last);
  for (const double hidden :
       {told->host_acceleration_mps2, told->host_gap_m, told->fog_level, told->collision_time_s}) {
    EXPECT_EQ(hidden, 0);
  }
  EXPECT_FALSE(told->fog_present);
  EXPECT_EQ(told->num_followers, 0);
}

TEST(SeatToldTest, TheFirstFrameDescribesTheChannelsOfTheSeat) {
  const json hello = json::parse(SeatHelloText());
  EXPECT_THAT(hello["channels"], SizeIs(3));
  for (const json& channel : hello["channels"]) {
    EXPECT_TRUE(hello["types"].contains(channel["type"].get<std::string>())) << channel;
    EXPECT_TRUE(hello["fingerprints"].contains(channel["type"].get<std::string>())) << channel;
  }
  EXPECT_THAT(hello["types"], SizeIs(4));  // also the type of the header
}

TEST(SeatToldTest, ARequestHasItsBegin) {
  EXPECT_EQ(json::parse(SeatRequestText({.since_us = 12'340'000, .begin_known = true})),
            json({{"op", "request"}, {"since_s", 12.34}, {"begin_known", true}}));
}

TEST(SeatToldTest, ARunHasOnlyWhatThePageNeeds) {
  const json scenario{{"title", "secret"},
                      {"seed", 4711},
                      {"step_s", 0.02},
                      {"world", {{"vehicle_length_m", 5}, {"host_gap_m", 33}}},
                      {"person",
                       {{"key_press_ps", 2},
                        {"key_release_ps", 3},
                        {"override_by", "brake"},
                        {"override_pedal", 0.3},
                        {"deadman_s", 1}}},
                      {"arbitrator", {{"threshold", 0.4711}, {"take_over", {{"lead_s", 12}}}}}};
  const std::string told = SeatRunText(
      {.run_id = 1LL << 60, .scenario_text = scenario.dump(), .realtime = true, .pace = 1});
  for (const char* hidden :
       {"secret", "4711", "threshold", "host_gap_m", "deadman_s", "override_pedal"}) {
    EXPECT_THAT(told, Not(HasSubstr(hidden)));
  }
  const json run = json::parse(told);
  EXPECT_EQ(run["op"], "run");
  EXPECT_EQ(run["run_id"], std::to_string(1LL << 60));
  EXPECT_EQ(run["step_s"], 0.02);
  EXPECT_EQ(run["pace"], 1);
  EXPECT_EQ(
      run["scenario"],
      json({{"world", {{"vehicle_length_m", 5}}},
            {"person", {{"key_press_ps", 2}, {"key_release_ps", 3}, {"override_by", "brake"}}},
            {"arbitrator", {{"take_over", {{"lead_s", 12}}}}}}));
}

}  // namespace
}  // namespace fogline::web
