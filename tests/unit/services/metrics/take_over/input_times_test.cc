#include "services/metrics/take_over/input_times.h"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace fogline {
namespace {

using metrics::TakeOverMeasures;

constexpr double kPedal = 0.1;

struct Act {
  double time_s;
  double throttle = 0;
  double brake = 0;
  std::int32_t buttons = 0;
  bool present = true;
  std::int64_t instance = 7;
};

/// The measures of two requests after these inputs. The first request is at 1 s and is judged for 2
/// s. The second request is at 5 s and is judged for 1 s.
std::vector<TakeOverMeasures> After(const std::vector<Act>& acts) {
  std::vector<TakeOverMeasures> requests(2);
  requests[0] = {.requested_s = 1, .judged_s = 2};
  requests[1] = {.requested_s = 5, .judged_s = 1};
  metrics::InputTimes times(requests, kPedal);
  for (const Act& act : acts) {
    driver_input_t input{};
    input.header.utime = static_cast<std::int64_t>(act.time_s * 1e6);
    input.instance = act.instance;
    input.present = act.present ? 1 : 0;
    input.throttle = act.throttle;
    input.brake = act.brake;
    input.buttons = act.buttons;
    times.Add(input);
  }
  return requests;
}

TEST(InputTimesTest, AreThoseOfTheFirstMovementAndOfTheFirstPedalBeyondTheThreshold) {
  const auto requests = After({{.time_s = 0.5, .brake = 0.9},
                               {.time_s = 1.0},
                               {.time_s = 1.5},
                               {.time_s = 1.75, .brake = 0.05},
                               {.time_s = 2.25, .brake = 0.1},
                               {.time_s = 2.5, .brake = 0.9}});
  EXPECT_EQ(requests[0].first_movement_time_s, 0.75);
  EXPECT_EQ(requests[0].pedal_on_time_s, 1.25);
  EXPECT_EQ(requests[1].first_movement_time_s, std::nullopt);
  EXPECT_EQ(requests[1].pedal_on_time_s, std::nullopt);
}

TEST(InputTimesTest, TakeTheReleaseOfAPedalForAMovement) {
  const auto requests = After({{.time_s = 0.5, .throttle = 0.5},
                               {.time_s = 1.25, .throttle = 0.505},
                               {.time_s = 1.5, .throttle = 0.25}});
  EXPECT_EQ(requests[0].first_movement_time_s, 0.5) << "a movement below 1 % is noise";
  EXPECT_EQ(requests[0].pedal_on_time_s, 0.25) << "the foot was already on the pedal";
}

TEST(InputTimesTest, TakeTheButtonForAMovementButNotForAPedal) {
  const auto requests = After({{.time_s = 0.5, .buttons = driver_input_t::GIVE_BACK},
                               {.time_s = 1.5, .buttons = driver_input_t::GIVE_BACK},
                               {.time_s = 2.5, .buttons = driver_input_t::TAKE_OVER}});
  EXPECT_EQ(requests[0].first_movement_time_s, 1.5);
  EXPECT_EQ(requests[0].pedal_on_time_s, std::nullopt);
}

TEST(InputTimesTest, DoNotTakeAButtonThatWasAlreadyDown) {
  const auto requests = After({{.time_s = 0.5, .buttons = driver_input_t::TAKE_OVER},
                               {.time_s = 1.5, .buttons = driver_input_t::TAKE_OVER}});
  EXPECT_EQ(requests[0].first_movement_time_s, std::nullopt);
}

TEST(InputTimesTest, DoNotCountAnInputInTheStepOfTheRequest) {
  const auto requests = After({{.time_s = 1.0, .brake = 1}, {.time_s = 1.5, .brake = 1}});
  EXPECT_EQ(requests[0].first_movement_time_s, std::nullopt) << "the person had not seen it yet";
  EXPECT_EQ(requests[0].pedal_on_time_s, 0.5);
}

TEST(InputTimesTest, DoNotCountAnInputAfterTheJudgedInterval) {
  const auto requests = After({{.time_s = 3.5, .brake = 1}, {.time_s = 6.5, .brake = 0.5}});
  EXPECT_EQ(requests[0].pedal_on_time_s, std::nullopt);
  EXPECT_EQ(requests[1].first_movement_time_s, std::nullopt);
}

TEST(InputTimesTest, BelongToTheLastRequest) {
  const auto requests = After({{.time_s = 0.5}, {.time_s = 5.5, .brake = 0.5}});
  EXPECT_EQ(requests[0].pedal_on_time_s, std::nullopt);
  EXPECT_EQ(requests[1].pedal_on_time_s, 0.5);
  EXPECT_EQ(requests[1].first_movement_time_s, 0.5);
}

TEST(InputTimesTest, DoNotCountPedalsWhileTheSeatIsEmpty) {
  const auto requests = After({{.time_s = 1.5, .brake = 1, .present = false}});
  EXPECT_EQ(requests[0].first_movement_time_s, std::nullopt);
  EXPECT_EQ(requests[0].pedal_on_time_s, std::nullopt);
}

TEST(InputTimesTest, CompareASeatOnlyWithItself) {
  const auto requests = After({{.time_s = 0.5, .throttle = 0.5},
                               {.time_s = 0.5, .instance = 8},
                               {.time_s = 1.5, .throttle = 0.5},
                               {.time_s = 1.5, .instance = 8}});
  EXPECT_EQ(requests[0].first_movement_time_s, std::nullopt);
}

}  // namespace
}  // namespace fogline
