#include "services/models/vehicle/actuator.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kRounding = 1e-12;  // relative to a force of 1, over some hundred steps

// The force after `duration_s`. A demand of 1 comes at time 0 to an actuator at rest.
double StepResponse(double delay_s, double lag_s, double step_s, double duration_s) {
  models::Actuator actuator(delay_s, lag_s, step_s);
  const int steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i < steps; ++i) actuator.Step(1);
  return actuator.force_n();
}

TEST(ActuatorTest, IsAt63PercentAfterDelayAndTimeConstant) {
  EXPECT_NEAR(StepResponse(0.2, 0.5, 0.1, 0.7), 1 - std::exp(-1), kRounding);
  EXPECT_NEAR(StepResponse(0.2, 0.5, 0.1, 0.7), 0.632, 0.0005);
}

TEST(ActuatorTest, DoesNothingBeforeTheDelayIsOver) {
  EXPECT_EQ(StepResponse(0.2, 0.5, 0.1, 0.2), 0);
  EXPECT_GT(StepResponse(0.2, 0.5, 0.1, 0.3), 0);
}

TEST(ActuatorTest, TakesADelayThatIsNoWholeNumberOfSteps) {
  EXPECT_NEAR(StepResponse(0.13, 0.47, 0.1, 0.6), 1 - std::exp(-1), kRounding);
  EXPECT_NEAR(StepResponse(0.07, 0.2, 0.1, 0.3), 1 - std::exp(-0.23 / 0.2), kRounding);
}

TEST(ActuatorTest, ComesToTheSameForceWithAnyStep) {
  const double coarse = StepResponse(0.15, 0.3, 0.1, 1.0);
  EXPECT_NEAR(StepResponse(0.15, 0.3, 0.05, 1.0), coarse, kRounding);
  EXPECT_NEAR(StepResponse(0.15, 0.3, 0.01, 1.0), coarse, kRounding);
}

TEST(ActuatorTest, ReportsTheMeanOverTheStep) {
  // Without delay, the mean force over a step h is 1 - (tau / h)(1 - e^(-h / tau)), with the lag
  // tau. This is e^-1 for h = tau.
  models::Actuator lag(0, 0.1, 0.1);
  EXPECT_NEAR(lag.Step(1), std::exp(-1), kRounding);
  // Without lag, the demand takes effect at 0.03 s of a step of 0.1 s.
  models::Actuator delay(0.03, 0, 0.1);
  EXPECT_NEAR(delay.Step(1), 0.7, kRounding);
  EXPECT_EQ(delay.force_n(), 1);
}

TEST(ActuatorTest, StaysWhereItHasSettled) {
  models::Actuator actuator(0.25, 0.4, 0.1);
  actuator.Settle(3);
  EXPECT_NEAR(actuator.Step(3), 3, kRounding);
  EXPECT_EQ(actuator.force_n(), 3);
}

TEST(ActuatorTest, RefusesWhatIsNegativeOrLongerThanItsMemory) {
  EXPECT_THROW(models::Actuator(-0.1, 0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(models::Actuator(0.1, -0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(models::Actuator(0.1, 0.1, 0), std::invalid_argument);
  EXPECT_NO_THROW(models::Actuator(0.254, 0.1, 0.001));
  EXPECT_THROW(models::Actuator(0.256, 0.1, 0.001), std::invalid_argument);
}

}  // namespace
}  // namespace fogline
