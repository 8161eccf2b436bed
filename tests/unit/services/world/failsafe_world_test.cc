// The world in real time. The tests check the cars in its TRUTH.
#include "services/world/failsafe_world.h"

#include <gtest/gtest.h>

#include "fogline/status_t.hpp"
#include "tests/unit/services/world/commands.h"

namespace fogline {
namespace {

class FailsafeWorldTest : public testing::Test {
 protected:
  FailsafeWorldTest() { truth_ = std::get<truth_t>(world_.Start(7)); }

  void Step(InputState host, InputState follower) {
    truth_ = std::get<truth_t>(
        world_.Step({.host = {host, &host_}, .followers = {follower, &follower_}}));
  }

  const Scenario scenario_;
  const double change_mps2_ = scenario_.minimal_risk.jerk_mps3 * scenario_.step_s;
  world::FailsafeWorld world_{scenario_};
  arbitration_t host_ = HostCommand(0.5);
  follower_command_t follower_ = FollowerCommand(-0.25);
  truth_t truth_;
};

TEST_F(FailsafeWorldTest, MovesTheCarsAsTheyAreCommanded) {
  Step(kOk, kOk);
  EXPECT_EQ(truth_.host_acceleration_mps2, 0.5);
  EXPECT_EQ(truth_.follower_acceleration_mps2.at(0), -0.25);
  EXPECT_EQ(world_.fallback(), "");
  EXPECT_EQ(world_.minimal_risk(), 0);
}

TEST_F(FailsafeWorldTest, SaysThatLastCommandsHold) {
  Step(kOk, kOk);
  Step(kStale, kOk);
  EXPECT_EQ(world_.fallback(), "the host's last command holds");
  EXPECT_EQ(truth_.host_acceleration_mps2, 0.5);
  Step(kOk, kStale);
  EXPECT_EQ(world_.fallback(), "the follower's last command holds");
  EXPECT_EQ(truth_.follower_acceleration_mps2.at(0), -0.25);
  follower_ = {};  // the follower publishes messages without a command
  Step(kOk, kOk);
  EXPECT_EQ(world_.fallback(), "the follower's last command holds");
}

TEST_F(FailsafeWorldTest, StopsEachCarWithoutTheOther) {
  Step(kOk, kOk);
  Step(kLost, kOk);
  EXPECT_NEAR(truth_.host_acceleration_mps2, 0.5 - change_mps2_, 1e-12);
  EXPECT_EQ(truth_.follower_acceleration_mps2.at(0), -0.25);
  EXPECT_EQ(world_.minimal_risk(), status_t::HOST);
  Step(kLost, kLost);
  EXPECT_NEAR(truth_.follower_acceleration_mps2.at(0), -0.25 - change_mps2_, 1e-12);
  EXPECT_EQ(world_.minimal_risk(), status_t::HOST | status_t::FOLLOWER);
  EXPECT_EQ(world_.fallback(),
            "minimal risk manoeuvre of the host; minimal risk manoeuvre of the follower");
}

TEST_F(FailsafeWorldTest, GoesOnWithTheManoeuvreOfThePredecessorOfItsProcess) {
  Step(kOk, kOk);
  Step(kLost, kOk);
  world::FailsafeWorld next(scenario_);
  next.Resume(truth_, world_.minimal_risk());
  const auto& resumed =
      std::get<truth_t>(next.Step({.host = {kOk, &host_}, .followers = {kOk, &follower_}}));
  Step(kOk, kOk);
  EXPECT_EQ(resumed.header.step, truth_.header.step);
  EXPECT_EQ(resumed.host_acceleration_mps2, truth_.host_acceleration_mps2);
  EXPECT_LT(resumed.host_acceleration_mps2, 0.5 - change_mps2_);
  EXPECT_EQ(next.minimal_risk(), status_t::HOST);
}

TEST_F(FailsafeWorldTest, KnowsNothingOfAManoeuvreThatItIsNotToldOf) {
  Step(kLost, kOk);
  world::FailsafeWorld next(scenario_);
  next.Resume(truth_, 0);
  const auto& resumed =
      std::get<truth_t>(next.Step({.host = {kOk, &host_}, .followers = {kOk, &follower_}}));
  EXPECT_EQ(resumed.host_acceleration_mps2, 0.5);
  EXPECT_EQ(next.minimal_risk(), 0);
}

}  // namespace
}  // namespace fogline
