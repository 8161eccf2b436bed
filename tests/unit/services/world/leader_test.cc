#include "services/world/leader.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

LeadSection Lead(LeadProfile profile, double speed_mps) {
  LeadSection lead;
  lead.profile = profile;
  lead.speed_mps = speed_mps;
  return lead;
}

// The speed at a time, for profiles that depend on time alone.
double SpeedAt(const LeadSection& lead, double time_s) {
  return world::Leader(lead).SpeedAt(0, time_s);
}

TEST(LeaderTest, KeepsAConstantSpeed) {
  const LeadSection lead = Lead(LeadProfile::kConstant, 17.0);
  EXPECT_EQ(SpeedAt(lead, 0.0), 17.0);
  EXPECT_EQ(SpeedAt(lead, 1e5), 17.0);
}

TEST(LeaderTest, GoesLinearlyFromBreakpointToBreakpoint) {
  LeadSection lead = Lead(LeadProfile::kBreakpoints, 20.0);
  lead.breakpoints = {{10.0, 20.0}, {5.0, 10.0}, {2.0, 14.0}};
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 0.0), 20.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 10.0), 20.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 12.5), 15.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 15.0), 10.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 16.0), 12.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 17.0), 14.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 1000.0), 14.0) << "the last speed holds on";
}

TEST(LeaderTest, HasExactlyTheSpeedOfABreakpointAtItsTime) {
  // 0.1 + 0.2 is rounded up, so the second phase seems to be longer than its 0.2 s. At 0.1 s, the
  // remaining share of this phase is above 1. An extrapolation to this share would give a negative
  // speed.
  LeadSection lead = Lead(LeadProfile::kBreakpoints, 10.0);
  lead.breakpoints = {{0.1, 0.0}, {0.2, 20.0}};
  EXPECT_EQ(SpeedAt(lead, 0.1), 0.0);
}

TEST(LeaderTest, KeepsItsSpeedWithoutBreakpoints) {
  EXPECT_EQ(SpeedAt(Lead(LeadProfile::kBreakpoints, 20.0), 5.0), 20.0);
}

TEST(LeaderTest, SwaysSinusoidallyFromItsStart) {
  LeadSection lead = Lead(LeadProfile::kSinusoid, 20.0);
  lead.sinusoid = {.amplitude_mps = 2.0, .period_s = 20.0, .start_s = 5.0};
  EXPECT_EQ(SpeedAt(lead, 4.9), 20.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 5.0), 20.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 10.0), 22.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 20.0), 18.0);
}

TEST(LeaderTest, StandsWhereTheSineWouldGoBackwards) {
  LeadSection lead = Lead(LeadProfile::kSinusoid, 1.0);
  lead.sinusoid = {.amplitude_mps = 2.0, .period_s = 20.0};
  EXPECT_EQ(SpeedAt(lead, 15.0), 0.0);
}

TEST(LeaderTest, BrakesHardDownToItsFinalSpeed) {
  LeadSection lead = Lead(LeadProfile::kEmergencyBrake, 20.0);
  lead.emergency_brake = {.start_s = 10.0, .deceleration_mps2 = 6.0, .final_speed_mps = 5.0};
  EXPECT_EQ(SpeedAt(lead, 9.9), 20.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 11.0), 14.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 12.5), 5.0);
  EXPECT_DOUBLE_EQ(SpeedAt(lead, 60.0), 5.0);
}

TEST(LeaderTest, DoesNotSpeedUpToAFinalSpeedAboveItsOwn) {
  LeadSection lead = Lead(LeadProfile::kEmergencyBrake, 3.0);
  lead.emergency_brake = {.start_s = 1.0, .deceleration_mps2 = 6.0, .final_speed_mps = 5.0};
  EXPECT_EQ(SpeedAt(lead, 2.0), 3.0);
}

TEST(LeaderTest, RepeatsARecordingStepByStepAndHoldsItsLastSpeed) {
  LeadSection lead = Lead(LeadProfile::kRecorded, 20.0);
  lead.recorded.speeds_mps = {11.0, 12.0, 10.5};
  const world::Leader leader(lead);
  EXPECT_EQ(leader.SpeedAt(0, 0.0), 11.0);
  EXPECT_EQ(leader.SpeedAt(1, 0.1), 12.0);
  EXPECT_EQ(leader.SpeedAt(2, 0.2), 10.5);
  EXPECT_EQ(leader.SpeedAt(400, 40.0), 10.5);
}

TEST(LeaderTest, RefusesAnEmptyRecording) {
  EXPECT_THROW(world::Leader{Lead(LeadProfile::kRecorded, 20.0)}, std::invalid_argument);
}

}  // namespace
}  // namespace fogline
