// Several following cars, and the people in them.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/follower/driver_assignment.h"
#include "services/follower/follower.h"
#include "services/follower/person.h"
#include "tests/support/input_errors.h"

namespace fogline {
namespace {

// Cars behind a host at 20 m/s. All cars have this speed, and each car is 33 m behind the car
// ahead.
truth_t Platoon(std::size_t cars) {
  truth_t truth{};
  truth.host_speed_mps = 20;
  truth.num_followers = static_cast<std::int32_t>(cars);
  truth.follower_position_m.assign(cars, 0);
  truth.follower_speed_mps.assign(cars, 20);
  truth.follower_acceleration_mps2.assign(cars, 0);
  truth.follower_gap_m.assign(cars, 33);
  return truth;
}

Scenario WithFollowers(std::int64_t count, FollowerDriver driver) {
  Scenario scenario;
  scenario.followers.count = count;
  scenario.followers.driver = driver;
  return scenario;
}

TEST(TrafficTest, GivesEachCarACommand) {
  follower::Follower follower(WithFollowers(5, FollowerDriver::kAcc));
  const follower_command_t& command = follower.Step(Platoon(5));
  EXPECT_EQ(command.num_followers, 5);
  ASSERT_EQ(command.acceleration_mps2.size(), 5U);
  ASSERT_EQ(command.safe_distance_m.size(), 5U);
  EXPECT_EQ(command.acceleration_mps2, std::vector<double>(5, command.acceleration_mps2[0]));
}

TEST(TrafficTest, LetsEachCarFollowTheOneBeforeIt) {
  for (const FollowerDriver driver : {FollowerDriver::kAcc, FollowerDriver::kHuman}) {
    // GIVEN three cars, of which the second is slower than the others
    follower::Follower follower(WithFollowers(3, driver));
    follower::Follower undisturbed(WithFollowers(3, driver));
    truth_t truth = Platoon(3);
    truth.follower_speed_mps[1] = 17;
    // WHEN the other cars have had time to react
    std::vector<double> now;
    std::vector<double> otherwise;
    for (int k = 0; k < 20; ++k) {
      now = follower.Step(truth).acceleration_mps2;
      otherwise = undisturbed.Step(Platoon(3)).acceleration_mps2;
      ++truth.header.step;
    }
    // THEN the third car brakes for the slower car, and a first car with an ACC does not react to
    // the slower car
    EXPECT_LT(now[2], otherwise[2] - 0.05);
    if (driver == FollowerDriver::kAcc) {
      EXPECT_EQ(now[0], otherwise[0]);
    }
  }
}

TEST(TrafficTest, KeepsItsMessagesMemoryHoweverManyCars) {
  follower::Follower follower(WithFollowers(kMaxFollowers, FollowerDriver::kHuman));
  const truth_t truth = Platoon(static_cast<std::size_t>(kMaxFollowers));
  const double* const data = follower.Step(truth).acceleration_mps2.data();
  for (int k = 0; k < 10; ++k) EXPECT_EQ(follower.Step(truth).acceleration_mps2.data(), data);
}

TEST(PersonTest, HoldsSafeWhatHisStyleHoldsSafe) {
  Scenario scenario = WithFollowers(3, FollowerDriver::kHuman);
  scenario.followers.cars = {{FollowerDriver::kHuman, FollowerStyle::kAggressive},
                             {FollowerDriver::kHuman, FollowerStyle::kNormal},
                             {FollowerDriver::kHuman, FollowerStyle::kCautious}};
  const follower_command_t command = follower::Follower(scenario).Step(Platoon(3));
  // T v + s_0 at v = 20 m/s, with the time gap T and the standstill gap s_0 of each style.
  EXPECT_DOUBLE_EQ(command.safe_distance_m[0], 1.25 * 20 + 1);
  EXPECT_DOUBLE_EQ(command.safe_distance_m[1], 1.45 * 20 + 2);
  EXPECT_DOUBLE_EQ(command.safe_distance_m[2], 1.75 * 20 + 4);
}

TEST(PersonTest, ErrsForHimself) {
  follower::Follower follower(WithFollowers(2, FollowerDriver::kHuman));
  const follower_command_t& command = follower.Step(Platoon(2));
  EXPECT_NE(command.acceleration_mps2[0], command.acceleration_mps2[1])
      << "the same style in the same place";
}

TEST(PersonTest, ErrsInTheSameWayUnderTheSameSeed) {
  Scenario scenario = WithFollowers(2, FollowerDriver::kHuman);
  const auto first = [&] {
    return follower::Follower(scenario).Step(Platoon(2)).acceleration_mps2;
  };
  const std::vector<double> one = first();
  EXPECT_EQ(first(), one);
  scenario.seed = 2;
  EXPECT_NE(first(), one);
}

TEST(PersonTest, BrakesAsHardAsHisSafetyModelAsksInDanger) {
  // GIVEN a car that closes in at 20 m/s on a standing host 30 m ahead: 1.5 s to a collision
  truth_t truth = Platoon(1);
  truth.host_speed_mps = 0;
  truth.follower_gap_m = {30};
  const auto hardest = [&](SafetyModelChoice choice) {
    Scenario scenario = WithFollowers(1, FollowerDriver::kHuman);
    scenario.followers.safety_model = choice;
    follower::Follower follower(scenario);
    double least = 0;
    for (int k = 0; k < 30; ++k) {
      truth.header.step = k;
      least = std::min(least, follower.Step(truth).acceleration_mps2[0]);
    }
    return least;
  };
  // THEN the reference human brakes with 0.774 g. With every model the car brakes at least as hard
  // as without a model.
  EXPECT_LE(hardest(SafetyModelChoice::kReferenceHuman), -7.59);
  EXPECT_LE(hardest(SafetyModelChoice::kRss), hardest(SafetyModelChoice::kNone));
  EXPECT_LE(hardest(SafetyModelChoice::kFuzzy), hardest(SafetyModelChoice::kNone));
}

TEST(PersonTest, IsRefusedWhereHisReactionTimeIsTooManySteps) {
  Scenario scenario = WithFollowers(3, FollowerDriver::kAcc);
  scenario.followers.cars = {{}, {FollowerDriver::kHuman, FollowerStyle::kCautious}};
  scenario.step_s = 0.004;  // the reaction time of 1.1 s is 275 steps
  scenario.follower.horizon_steps = 5;
  EXPECT_EQ(test::ErrorOf([&] { follower::Follower follower(scenario); }),
            "/step_s: 0.004 s is too short for a person in following car 1: human driver: the "
            "reaction time is longer than 254 steps");
}

TEST(DriverAssignmentTest, IsThePapersWithoutASection) {
  const follower::DriverAssignment assignment = follower::AssignmentOf(Scenario(), 0);
  EXPECT_TRUE(assignment.has_acc);
}

TEST(DriverAssignmentTest, TakesTheFirstCarsFromTheListAndTheOthersFromTheSection) {
  Scenario scenario = WithFollowers(4, FollowerDriver::kHuman);
  scenario.followers.style = FollowerStyle::kCautious;
  scenario.followers.cars = {{FollowerDriver::kAcc, FollowerStyle::kNormal},
                             {FollowerDriver::kHuman, FollowerStyle::kAggressive}};
  EXPECT_TRUE(follower::AssignmentOf(scenario, 0).has_acc);
  EXPECT_FALSE(follower::AssignmentOf(scenario, 1).has_acc);
  EXPECT_EQ(follower::AssignmentOf(scenario, 1).style, models::Style::kAggressive);
  EXPECT_EQ(follower::AssignmentOf(scenario, 3).style, models::Style::kCautious);
}

TEST(DriverAssignmentTest, DrawsInProportionToTheShares) {
  Scenario scenario = WithFollowers(kMaxFollowers, FollowerDriver::kDrawn);
  scenario.followers.style = FollowerStyle::kDrawn;
  scenario.followers.acc_share = 0.25;
  scenario.followers.aggressive_share = 3;
  constexpr int kSeeds = 200;
  int acc = 0;
  int aggressive = 0;
  for (scenario.seed = 1; scenario.seed <= kSeeds; ++scenario.seed) {
    for (std::size_t car = 0; car < kMaxFollowers; ++car) {
      const follower::DriverAssignment assignment = follower::AssignmentOf(scenario, car);
      acc += assignment.has_acc ? 1 : 0;
      aggressive += assignment.style == models::Style::kAggressive ? 1 : 0;
    }
  }
  // The expected numbers are a quarter and three fifths of 6,400 cars. Four standard deviations are
  // 139 and 157 cars.
  EXPECT_NEAR(acc, 1600, 139);
  EXPECT_NEAR(aggressive, 3840, 157);
}

TEST(DriverAssignmentTest, DrawsNoDriverOfAKindWithoutAShare) {
  Scenario scenario = WithFollowers(kMaxFollowers, FollowerDriver::kDrawn);
  for (const double share : {0.0, 1.0}) {
    scenario.followers.acc_share = share;
    for (std::size_t car = 0; car < kMaxFollowers; ++car) {
      EXPECT_EQ(follower::AssignmentOf(scenario, car).has_acc, share == 1.0);
    }
  }
}

// ---- fog ---------------------------------------------------------------------------------------

class FogSightOfPeopleTest : public testing::Test {
 protected:
  /// Accelerations of a column of two cars in fog, over 30 steps. The host ahead is 5 m/s slower.
  static std::vector<double> Drive(Scenario scenario, double visibility_m) {
    follower::Follower follower(scenario);
    truth_t truth = Platoon(2);
    truth.host_speed_mps = 15;
    truth.fog_visibility_m = visibility_m;
    std::vector<double> accelerations;
    for (; truth.header.step < 30; ++truth.header.step) {
      const auto& command = follower.Step(truth);
      accelerations.insert(accelerations.end(), command.acceleration_mps2.begin(),
                           command.acceleration_mps2.end());
    }
    return accelerations;
  }
  static Scenario Seeing(Sight sight, FollowerDriver driver = FollowerDriver::kHuman) {
    Scenario scenario = WithFollowers(2, driver);
    scenario.followers.sight = sight;
    return scenario;
  }
};

TEST_F(FogSightOfPeopleTest, IsOffByDefaultAndThenFogChangesNothing) {
  EXPECT_EQ(Scenario().followers.sight, Sight::kPerfect);
  EXPECT_EQ(Drive(Seeing(Sight::kPerfect), 10), Drive(Seeing(Sight::kPerfect), 1e6));
}

TEST_F(FogSightOfPeopleTest, IsThatOfTheHostsDriver) {
  // GIVEN the sight that section `human` sets for the host's driver, and a person who drives like
  // the driver of the first car
  Scenario scenario = Seeing(Sight::kFog);
  scenario.human.fog_sight.contrast = 0.4;
  const models::FogSight sight(scenario.human.fog_sight);
  follower::Person seeing(models::Style::kNormal, std::nullopt, SafetyModelChoice::kNone,
                          Random(scenario.seed, FollowerErrors(0)), scenario.step_s);
  // WHEN the first of the two cars follows the host through fog of 40 m
  const std::vector<double> driven = Drive(scenario, 40);
  // THEN the driver of this car reacts to the situation that this driver sees
  for (std::int64_t k = 0; k < 30; ++k) {
    const models::Situation truth{
        .speed_mps = 20,
        .acceleration_mps2 = 0,
        .ahead = models::CarAhead{.gap_m = 33, .speed_mps = 15, .acceleration_mps2 = 0}};
    EXPECT_EQ(driven[static_cast<std::size_t>(2 * k)],
              seeing.Step(k, sight.Perceive(truth, 40), 40).acceleration_mps2);
  }
  EXPECT_NE(driven, Drive(Seeing(Sight::kPerfect), 40));
}

TEST_F(FogSightOfPeopleTest, LosesTheCarAheadInDenseFogAndAcceleratesAsOnAFreeRoad) {
  const std::vector<double> blind = Drive(Seeing(Sight::kFog), 5);
  const std::vector<double> clear = Drive(Seeing(Sight::kFog), 1e6);
  EXPECT_GT(blind.front(), 0.3);
  EXPECT_LT(clear.front(), -1);
}

TEST_F(FogSightOfPeopleTest, IsAlsoWhatTheSafetyModelSees) {
  Scenario scenario = Seeing(Sight::kFog);
  scenario.followers.safety_model = SafetyModelChoice::kRss;
  EXPECT_GT(Drive(scenario, 5).back(), 0) << "nothing is there to keep a distance from";
  EXPECT_LT(Drive(scenario, 1e6).back(), -5);
}

TEST_F(FogSightOfPeopleTest, IsNoAffairOfAnAcc) {
  EXPECT_EQ(Drive(Seeing(Sight::kFog, FollowerDriver::kAcc), 10),
            Drive(Seeing(Sight::kFog, FollowerDriver::kAcc), 1e6));
}

}  // namespace
}  // namespace fogline
