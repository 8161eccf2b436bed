#include "services/models/driver/human_driver.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "services/models/driver/ornstein_uhlenbeck.h"
#include "tests/unit/services/models/driver/examples.h"

namespace fogline {
namespace {

constexpr double kStep_s = 0.1;
constexpr HumanParameters kPerfect{.reaction_time_s = 0, .gap_error = 0, .approach_error_ps = 0};

Random AnyErrors() { return Random(3, Stream::kHumanErrors); }
models::Following AnyModel() { return models::Following(FollowingModel::kIidm, DriverSection{}); }

models::Situation AcceleratingBehind(double speed_mps, double acceleration_mps2, double gap_m,
                                     double lead_mps) {
  models::Situation situation = Behind(speed_mps, gap_m, lead_mps);
  situation.acceleration_mps2 = acceleration_mps2;
  return situation;
}

TEST(HumanDriverTest, ActsOnWhatHeSawAReactionTimeAgo) {
  HumanParameters late = kPerfect;
  late.reaction_time_s = 0.3;
  late.anticipates = false;
  models::HumanDriver driver(late, AnyModel(), AnyErrors(), kStep_s);
  const models::Situation before = AcceleratingBehind(20, 0, 32, 20);
  const models::Situation after = AcceleratingBehind(20, 0, 20, 15);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(driver.Step(k, before), AnyModel().Acceleration(before));
  for (int k = 5; k < 8; ++k) EXPECT_EQ(driver.Step(k, after), AnyModel().Acceleration(before));
  EXPECT_EQ(driver.Step(8, after), AnyModel().Acceleration(after));
}

TEST(HumanDriverTest, RemembersBetweenStepsInProportion) {
  HumanParameters late = kPerfect;
  late.reaction_time_s = 0.175;
  late.anticipates = false;
  models::HumanDriver driver(late, AnyModel(), AnyErrors(), kStep_s);
  driver.Step(0, AcceleratingBehind(20, 0, 40, 20));
  driver.Step(1, AcceleratingBehind(20, 0, 36, 18));
  // The driver reacts to the situation 0.175 s before step 2, which is at 0.2 s. This time is a
  // quarter of the way from step 0 to step 1.
  EXPECT_NEAR(driver.Step(2, AcceleratingBehind(20, 0, 30, 10)),
              AnyModel().Acceleration(AcceleratingBehind(20, 0, 39, 19.5)), 1e-9);
}

TEST(HumanDriverTest, AnticipatesWhatHasHappenedSince) {
  // GIVEN 1 s of reaction time, a gap that closes at 2 m/s, and a driver who brakes at 1 m/s2
  HumanParameters human = kPerfect;
  human.reaction_time_s = 1;
  models::HumanDriver driver(human, AnyModel(), AnyErrors(), kStep_s);
  // THEN the driver reacts to 19 m/s, 38 m and the unchanged closing speed
  EXPECT_NEAR(driver.Step(0, AcceleratingBehind(20, -1, 40, 18)),
              AnyModel().Acceleration(AcceleratingBehind(19, -1, 38, 17)), 1e-12);
}

TEST(HumanDriverTest, AnticipationOfConstantMotionUndoesTheReactionTime) {
  // For equal constant accelerations the linear extrapolation is exact.
  HumanParameters human = kPerfect;
  human.reaction_time_s = 0.75;
  models::HumanDriver driver(human, AnyModel(), AnyErrors(), kStep_s);
  for (int k = 0; k < 30; ++k) {
    const double t = k * kStep_s;
    const models::Situation now = AcceleratingBehind(20 - 0.5 * t, -0.5, 40 - 2 * t, 18 - 0.5 * t);
    const double acceleration = driver.Step(k, now);
    if (k < 9) continue;
    EXPECT_NEAR(acceleration, AnyModel().Acceleration(now), 1e-9) << k;
  }
}

TEST(HumanDriverTest, NoticesACarThatAppearsALittleLater) {
  HumanParameters late = kPerfect;
  late.reaction_time_s = 0.2;
  models::HumanDriver driver(late, AnyModel(), AnyErrors(), kStep_s);
  const models::Situation free{.speed_mps = 20};
  const models::Situation close = AcceleratingBehind(20, 0, 10, 10);
  EXPECT_GT(driver.Step(0, free), 0);
  EXPECT_GT(driver.Step(1, close), 0);
  EXPECT_GT(driver.Step(2, close), 0);
  EXPECT_LT(driver.Step(3, close), -5);
}

TEST(HumanDriverTest, TheNearerOfTwoStepsDecidesWhetherThereIsACar) {
  // GIVEN a car that appears in step 2, at 0.2 s. WHEN step 3 comes, at 0.3 s, THEN a driver with a
  // reaction time of 0.13 s reacts to the situation at 0.17 s. This is nearer to step 2, so the
  // driver notices the car. With 0.17 s the driver reacts to the situation at 0.13 s, nearer to
  // step 1, and does not notice the car
  for (const auto& [reaction_time_s, notices] : {std::pair{0.13, true}, {0.17, false}}) {
    HumanParameters late = kPerfect;
    late.reaction_time_s = reaction_time_s;
    late.anticipates = false;
    models::HumanDriver driver(late, AnyModel(), AnyErrors(), kStep_s);
    const models::Situation close = AcceleratingBehind(20, 0, 10, 10);
    for (int k = 0; k < 2; ++k) driver.Step(k, {.speed_mps = 20});
    driver.Step(2, close);
    EXPECT_EQ(driver.Step(3, close) < 0, notices) << reaction_time_s;
  }
}

// The gap that the driver sees is the true gap times exp(error). So half the gap and twice the gap
// are equal errors of opposite sign, and no error makes a gap negative.
TEST(HumanDriverTest, ErrsByAFactorOfTheGap) {
  HumanParameters human = kPerfect;
  human.gap_error = 3;
  models::HumanDriver driver(human, AnyModel(), AnyErrors(), kStep_s);
  models::OrnsteinUhlenbeck error(human.error_time_s, kStep_s);
  for (int k = 0; k < 20; ++k) {
    const double factor = std::exp(3 * error.Step(AnyErrors().Normal2(k, 0)[0]));
    EXPECT_EQ(driver.Step(k, AcceleratingBehind(20, 0, 32, 20)),
              AnyModel().Acceleration(AcceleratingBehind(20, 0, 32 * factor, 20)));
  }
}

// The farther away the car ahead is, the larger is the error of its speed.
TEST(HumanDriverTest, ErrsInTheSpeedOfTheCarAheadInProportionToTheGap) {
  HumanParameters human = kPerfect;
  human.approach_error_ps = 0.05;
  for (const double gap_m : {16.0, 64.0}) {
    models::HumanDriver driver(human, AnyModel(), AnyErrors(), kStep_s);
    models::OrnsteinUhlenbeck error(human.error_time_s, kStep_s);
    for (int k = 0; k < 20; ++k) {
      const double seen_mps = 20 - gap_m * 0.05 * error.Step(AnyErrors().Normal2(k, 0)[1]);
      EXPECT_NEAR(driver.Step(k, AcceleratingBehind(20, 0, gap_m, 20)),
                  AnyModel().Acceleration(AcceleratingBehind(20, 0, gap_m, seen_mps)), 1e-12);
    }
  }
}

TEST(HumanDriverTest, MakesTheSameErrorsAgain) {
  models::HumanDriver one(HumanParameters{}, AnyModel(), AnyErrors(), kStep_s);
  models::HumanDriver other(HumanParameters{}, AnyModel(), AnyErrors(), kStep_s);
  models::HumanDriver stranger(HumanParameters{}, AnyModel(), Random(4, Stream::kHumanErrors),
                               kStep_s);
  const models::Situation seen = AcceleratingBehind(20, 0, 32, 20);
  for (int k = 0; k < 20; ++k) {
    const double acceleration = one.Step(k, seen);
    EXPECT_EQ(acceleration, other.Step(k, seen));
    EXPECT_NE(acceleration, stranger.Step(k, seen));
  }
}

TEST(HumanDriverTest, RefusesWhatNoDriverIs) {
  const auto make = [](const HumanParameters& human) {
    return models::HumanDriver(human, AnyModel(), AnyErrors(), kStep_s);
  };
  EXPECT_THROW(make({.reaction_time_s = -0.1}), std::invalid_argument);
  EXPECT_THROW(make({.reaction_time_s = 25.6}), std::invalid_argument);
  EXPECT_THROW(make({.error_time_s = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace fogline
