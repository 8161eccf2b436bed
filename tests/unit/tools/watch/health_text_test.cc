#include "tools/watch/health_text.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

namespace fogline::watch {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

RoleView Arbitrator() {
  RoleView role{};
  role.status.role = "arbitrator";
  role.status.state = status_t::RUNNING;
  return role;
}

TEST(HealthTextTest, SaysInLockstepWhatARoleWaitsFor) {
  RoleView role = Arbitrator();
  EXPECT_THAT(RemarksOn(role, false), IsEmpty());
  role.status.waiting_for = "TRACK";
  role.status.waiting_ms = 1200;
  EXPECT_THAT(RemarksOn(role, false), ElementsAre("waits for TRACK for 1.2 s"));
  EXPECT_FALSE(IsUnwell(role));
}

TEST(HealthTextTest, SaysInRealTimeWhatTheRoleDoesAndNotThatItWaits) {
  RoleView role = Arbitrator();
  role.status.waiting_for = "DRIVER_COMMAND";
  role.status.waiting_ms = 1200;
  role.status.fallback = "the automation drives";
  role.status.num_inputs = 2;
  role.status.input = {"TRACK", "DRIVER_COMMAND"};
  role.status.input_state = {status_t::INPUT_OK, status_t::INPUT_LOST};
  role.status.input_age_us = {1000, 1'200'000};
  role.status.input_late = {2, 3};
  role.status.ticks_late = 4;
  role.status.deadline_misses = 12;
  EXPECT_THAT(RemarksOn(role, true),
              ElementsAre("the automation drives", "LOST DRIVER_COMMAND 1.2 s", "4 late steps",
                          "12 missed deadlines", "5 late inputs"));
  EXPECT_TRUE(IsUnwell(role));
}

TEST(HealthTextTest, BeginsWithSilenceAndErrors) {
  RoleView role = Arbitrator();
  role.silent = true;
  role.age_s = 3.25;
  role.status.error = "no\033[2Jtrack";
  role.status.foreign = 7;
  EXPECT_THAT(RemarksOn(role, false),
              ElementsAre("silent for 3.2 s", "no?[2Jtrack", "refused 7 of other runs"));
}

RunView RunWith(const arbitration_t& command) {
  ChannelView channel;
  channel.channel = "HOST_COMMAND";
  runtime::Encode(command, channel.newest);
  RunView run;
  run.channels.push_back(channel);
  return run;
}

TEST(HealthTextTest, SaysWhoDrivesByTheNewestCommand) {
  EXPECT_EQ(WhoDrives({}), "");
  arbitration_t command{};
  command.lambda_automation = 1;
  EXPECT_EQ(WhoDrives(RunWith(command)), "the automation drives");
  command.mode = arbitration_t::REQUEST;
  EXPECT_EQ(WhoDrives(RunWith(command)), "the automation drives, the human is asked");
  command.lambda_automation = 0;
  command.lambda_human = 1;
  command.mode = arbitration_t::HUMAN;
  EXPECT_EQ(WhoDrives(RunWith(command)), "the human drives");
  command.mode = arbitration_t::EMERGENCY_BRAKING;
  EXPECT_EQ(WhoDrives(RunWith(command)), "the human drives, emergency braking");
  command.mode = arbitration_t::MINIMAL_RISK;
  EXPECT_EQ(WhoDrives(RunWith(command)), "a minimal risk manoeuvre");
}

}  // namespace
}  // namespace fogline::watch
