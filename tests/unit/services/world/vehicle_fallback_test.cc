#include "services/world/vehicle_fallback.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/services/world/commands.h"

namespace fogline {
namespace {

constexpr InputState kAwaited = InputState::kAwaited;

Scenario SomeScenario() {
  Scenario scenario;
  scenario.minimal_risk = {.deceleration_mps2 = 3, .jerk_mps3 = 2};
  return scenario;
}

truth_t Driving() {
  truth_t truth{};
  truth.header = {.run_id = 3, .step = 12, .utime = 1'200'000};
  truth.host_speed_mps = 20;
  truth.host_acceleration_mps2 = 0.5;
  truth.num_followers = 1;
  truth.follower_speed_mps = {21};
  truth.follower_acceleration_mps2 = {-0.5};
  return truth;
}

class VehicleFallbackTest : public testing::Test {
 protected:
  double Host(InputState state, const arbitration_t* command) {
    fallback_.Step(now_, {state, command}, {kOk, &follower_});
    return fallback_.host().acceleration_mps2;
  }
  double Follower(InputState state, const follower_command_t* command) {
    fallback_.Step(now_, {kOk, &host_}, {state, command});
    return fallback_.followers().acceleration_mps2.at(0);
  }
  static arbitration_t MinimalRiskCommand(double acceleration_mps2) {
    arbitration_t command = HostCommand(acceleration_mps2);
    command.mode = arbitration_t::MINIMAL_RISK;
    return command;
  }

  world::VehicleFallback fallback_{SomeScenario()};
  truth_t now_ = Driving();
  arbitration_t host_ = HostCommand(1.5);
  follower_command_t follower_ = FollowerCommand(-1.5);
};

TEST_F(VehicleFallbackTest, PassesCommandsOnAsTheyAre) {
  host_.lambda_human = 1;
  host_.mode = arbitration_t::HUMAN;
  host_.doc = 0.7;
  follower_.safe_distance_m = {40};
  fallback_.Step(now_, {kOk, &host_}, {kOk, &follower_});
  EXPECT_EQ(fallback_.host().acceleration_mps2, 1.5);
  EXPECT_EQ(fallback_.host().mode, arbitration_t::HUMAN);
  EXPECT_EQ(fallback_.host().lambda_human, 1);
  EXPECT_EQ(fallback_.host().doc, 0.7);
  EXPECT_EQ(fallback_.host().header.step, 12);
  EXPECT_EQ(fallback_.followers().acceleration_mps2[0], -1.5);
  EXPECT_EQ(fallback_.followers().safe_distance_m[0], 40);
  EXPECT_FALSE(fallback_.host_in_minimal_risk());
  EXPECT_FALSE(fallback_.follower_in_minimal_risk());
}

TEST_F(VehicleFallbackTest, HoldsTheLastCommandWhileItIsStale) {
  EXPECT_EQ(Host(kOk, &host_), 1.5);
  EXPECT_EQ(Host(kStale, &host_), 1.5);
  EXPECT_EQ(Follower(kOk, &follower_), -1.5);
  EXPECT_EQ(Follower(kStale, &follower_), -1.5);
}

TEST_F(VehicleFallbackTest, KeepsTheAccelerationOfTheMomentBeforeTheFirstCommand) {
  fallback_.Step(now_, {kAwaited, nullptr}, {kAwaited, nullptr});
  EXPECT_EQ(fallback_.host().acceleration_mps2, 0.5);
  EXPECT_EQ(fallback_.followers().acceleration_mps2.at(0), -0.5);
}

TEST_F(VehicleFallbackTest, StopsTheHostWhenItsCommandIsLostAndForGood) {
  Host(kOk, &host_);
  EXPECT_NEAR(Host(kLost, &host_), 0.5 - 0.2, 1e-12);
  EXPECT_EQ(fallback_.host().mode, arbitration_t::MINIMAL_RISK);
  EXPECT_EQ(fallback_.host().lambda_automation, 0);
  EXPECT_EQ(fallback_.host().lambda_human, 0);
  EXPECT_TRUE(fallback_.host_in_minimal_risk());
  EXPECT_TRUE(fallback_.host_stops_by_itself());
  EXPECT_NEAR(Host(kOk, &host_), 0.5 - 0.4, 1e-12);
  EXPECT_EQ(fallback_.host().mode, arbitration_t::MINIMAL_RISK);
}

TEST_F(VehicleFallbackTest, StopsTheFollowerWithoutTheHost) {
  EXPECT_NEAR(Follower(kLost, nullptr), -0.5 - 0.2, 1e-12);
  EXPECT_TRUE(fallback_.follower_in_minimal_risk());
  EXPECT_FALSE(fallback_.host_in_minimal_risk());
  EXPECT_NEAR(Follower(kOk, &follower_), -0.5 - 0.4, 1e-12);
  EXPECT_EQ(fallback_.host().acceleration_mps2, 1.5);
}

TEST_F(VehicleFallbackTest, TakesCommandsForNoCarAsNone) {
  Follower(kOk, &follower_);
  now_.follower_acceleration_mps2 = {-1.5};
  // WHEN messages come in time but contain no command for the car
  const follower_command_t empty{};
  // THEN the last command stays in force for the same time as a stale command, and then the car
  // stops
  EXPECT_EQ(Follower(kOk, &empty), -1.5);
  EXPECT_EQ(fallback_.follower_state(), kStale);
  EXPECT_NEAR(Follower(kOk, &empty), -1.5 - 0.2, 1e-12);
  EXPECT_TRUE(fallback_.follower_in_minimal_risk());
}

TEST_F(VehicleFallbackTest, ForgivesACommandForNoCarWhenTheNextOneIsForIt) {
  const follower_command_t empty{};
  for (int k = 0; k < 20; ++k) {
    Follower(kOk, &empty);
    EXPECT_EQ(Follower(kOk, &follower_), -1.5);
  }
  EXPECT_EQ(fallback_.follower_state(), kOk);
  EXPECT_FALSE(fallback_.follower_in_minimal_risk());
}

TEST_F(VehicleFallbackTest, FollowsTheManoeuvreThatTheArbitratorCommands) {
  const arbitration_t command = MinimalRiskCommand(-1.25);
  EXPECT_EQ(Host(kOk, &command), -1.25);
  EXPECT_EQ(Host(kStale, &command), -1.25);
  EXPECT_TRUE(fallback_.host_in_minimal_risk());
  EXPECT_FALSE(fallback_.host_stops_by_itself());
}

TEST_F(VehicleFallbackTest, GoesOnByItselfWhenTheArbitratorForgetsTheManoeuvre) {
  const arbitration_t command = MinimalRiskCommand(-1.25);
  Host(kOk, &command);
  now_.host_acceleration_mps2 = -1.25;
  EXPECT_NEAR(Host(kOk, &host_), -1.25 - 0.2, 1e-12);
  EXPECT_EQ(fallback_.host().mode, arbitration_t::MINIMAL_RISK);
  EXPECT_TRUE(fallback_.host_stops_by_itself());
}

TEST_F(VehicleFallbackTest, RemembersTheManoeuvreOfADriverWhoDidNotCome) {
  arbitration_t command = MinimalRiskCommand(-1.25);
  command.mode = arbitration_t::MRM_COMFORT;
  EXPECT_EQ(Host(kOk, &command), -1.25);
  EXPECT_FALSE(fallback_.host_in_minimal_risk()) << "the driver may still come";
  Host(kOk, &host_);
  EXPECT_TRUE(fallback_.host_stops_by_itself());
}

TEST_F(VehicleFallbackTest, ObeysADriverWhoComesDuringTheManoeuvre) {
  arbitration_t command = MinimalRiskCommand(-1.25);
  command.mode = arbitration_t::MRM_EMERGENCY;
  Host(kOk, &command);
  host_.mode = arbitration_t::RECOVERING;
  EXPECT_EQ(Host(kOk, &host_), 1.5);
  EXPECT_FALSE(fallback_.host_in_minimal_risk());
  host_.mode = arbitration_t::HUMAN;
  EXPECT_EQ(Host(kOk, &host_), 1.5);
}

// In the step in which the driver takes over, emergency braking may replace the mode RECOVERING.
// Then only the human's authority in the command shows that the driver has taken over.
TEST_F(VehicleFallbackTest, ObeysADriverWhoComesInTheMomentOfEmergencyBraking) {
  for (const bool human : {false, true}) {
    world::VehicleFallback fallback(SomeScenario());
    arbitration_t command = MinimalRiskCommand(-1.25);
    command.mode = arbitration_t::MRM_EMERGENCY;
    fallback.Step(now_, {kOk, &command}, {kOk, &follower_});
    command.mode = arbitration_t::EMERGENCY_BRAKING;
    command.acceleration_mps2 = -9;
    command.lambda_human = human ? 1 : 0;
    fallback.Step(now_, {kOk, &command}, {kOk, &follower_});
    EXPECT_EQ(fallback.host_stops_by_itself(), !human);
    if (human) {
      EXPECT_EQ(fallback.host().acceleration_mps2, -9);
    }
  }
}

TEST_F(VehicleFallbackTest, LetsNoDriverEndTheLockOrAManoeuvreAfterFailure) {
  for (const std::int8_t mode : {arbitration_t::MRM_DONE, arbitration_t::MINIMAL_RISK}) {
    world::VehicleFallback fallback(SomeScenario());
    arbitration_t command = MinimalRiskCommand(0);
    command.mode = mode;
    fallback.Step(now_, {kOk, &command}, {kOk, &follower_});
    host_.mode = arbitration_t::RECOVERING;
    fallback.Step(now_, {kOk, &host_}, {kOk, &follower_});
    EXPECT_TRUE(fallback.host_stops_by_itself()) << static_cast<int>(mode);
  }
}

class SeveralFollowersTest : public testing::Test {
 protected:
  SeveralFollowersTest() {
    Scenario scenario = SomeScenario();
    scenario.followers.count = 3;
    fallback_.emplace(scenario);
    now_.num_followers = 3;
    now_.follower_speed_mps = {21, 20, 19};
    now_.follower_acceleration_mps2 = {-0.5, 0, 0.5};
  }
  const std::vector<double>& Step(InputState state, const follower_command_t* commands) {
    fallback_->Step(now_, {kOk, &host_}, {state, commands});
    return fallback_->followers().acceleration_mps2;
  }

  std::optional<world::VehicleFallback> fallback_;
  truth_t now_ = Driving();
  arbitration_t host_ = HostCommand(1.5);
  follower_command_t commands_ = FollowerCommands({-1.5, 0.25, 1});
};

TEST_F(SeveralFollowersTest, EachGetItsOwnCommandAndKeepItWhileItIsStale) {
  EXPECT_EQ(Step(kOk, &commands_), commands_.acceleration_mps2);
  EXPECT_EQ(Step(kStale, &commands_), commands_.acceleration_mps2);
  EXPECT_EQ(fallback_->followers().num_followers, 3);
  EXPECT_FALSE(fallback_->follower_in_minimal_risk());
}

TEST_F(SeveralFollowersTest, StopEachFromItsOwnAccelerationWhenTheirCommandsAreLost) {
  Step(kOk, &commands_);
  const std::vector<double> stopping = Step(kLost, &commands_);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(stopping[i], now_.follower_acceleration_mps2[i] - 0.2, 1e-12) << i;
  }
  EXPECT_TRUE(fallback_->follower_in_minimal_risk());
  EXPECT_FALSE(fallback_->host_in_minimal_risk());
}

TEST_F(SeveralFollowersTest, StopOnlyTheCarThatMessagesLeaveOut) {
  Step(kOk, &commands_);
  // WHEN messages come in time but contain no command for the last car
  const follower_command_t two = FollowerCommands({-1, 0.5});
  EXPECT_EQ(Step(kOk, &two), (std::vector<double>{-1, 0.5, 1})) << "its last command holds";
  EXPECT_EQ(fallback_->follower_state(), kStale);
  EXPECT_FALSE(fallback_->follower_in_minimal_risk());
  // THEN this car begins to stop after as many periods as if its messages were lost, and the other
  // cars obey their commands
  const std::vector<double> stopping = Step(kOk, &two);
  EXPECT_EQ(stopping[0], -1);
  EXPECT_EQ(stopping[1], 0.5);
  EXPECT_NEAR(stopping[2], 0.5 - 0.2, 1e-12);
  EXPECT_TRUE(fallback_->follower_in_minimal_risk());
}

TEST_F(SeveralFollowersTest, AllGoOnStoppingBehindAWorldThatWasKilled) {
  fallback_->ResumeFollowers(now_);
  const std::vector<double> stopping = Step(kOk, &commands_);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(stopping[i], now_.follower_acceleration_mps2[i] - 0.2, 1e-12) << i;
  }
}

}  // namespace
}  // namespace fogline
