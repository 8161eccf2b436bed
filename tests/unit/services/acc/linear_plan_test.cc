#include "services/acc/linear_plan.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/sections/control.h"
#include "services/acc/acc_program.h"

namespace fogline::acc {
namespace {

Eigen::MatrixX4d GainOfTwoSteps() {
  Eigen::MatrixX4d gain(2, 4);
  gain << 1, 2, -3, 0.5,  //
      -2, 1, 1, 0.25;
  return gain;
}

TEST(LinearPlanTest, IsTheGainTimesTheSituation) {
  const LinearPlan plan(GainOfTwoSteps());
  const Eigen::Vector4d p(1, 10, 100, 1000);
  Eigen::VectorXd controls;
  plan.Compute(p, controls);
  ASSERT_EQ(controls.size(), 2);
  EXPECT_EQ(controls(0), 1 + 20 - 300 + 500);
  EXPECT_EQ(controls(1), -2 + 10 + 100 + 250);
  EXPECT_EQ(plan.First(p), controls(0));
}

// The largest elements of the columns of |K| are 2, 2, 3 and 0.5, where K is the gain. The changes
// of the control have a gain, too. Its first row, for u_0 - u_{-1}, is (1, 2, -3, -0.5), because
// u_{-1} is the last element of the situation p. Its second row, for u_1 - u_0, is
// (-3, -1, 4, -0.25).
TEST(LinearPlanTest, BoundsAreTheLargestElementsOfTheColumns) {
  const LinearPlan plan(GainOfTwoSteps());
  const Eigen::Vector4d p(1, -10, 100, -1000);
  EXPECT_EQ(plan.ControlBound(p), 2 + 20 + 300 + 500);
  EXPECT_EQ(plan.ChangeBound(p), 3 + 20 + 400 + 500);
}

TEST(LinearPlanTest, BoundsOfASituationThatIsNotANumberAreNotNumbers) {
  const LinearPlan plan(GainOfTwoSteps());
  for (int i = 0; i < 4; ++i) {
    Eigen::Vector4d p(1, 1, 1, 1);
    p(i) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(plan.ControlBound(p))) << i;
    EXPECT_TRUE(std::isnan(plan.ChangeBound(p))) << i;
  }
}

TEST(LinearPlanTest, NoBoundThatIsNotANumberProvesAnything) {
  const AccSection section;
  const AccProgram program(section, 0.1);
  const AccSituation standing{.state = {0, 0, 0}, .speed_mps = 20, .previous_control = 0};
  EXPECT_TRUE(program.IsCertainlyWithinLimits(standing, 0, 0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(program.IsCertainlyWithinLimits(standing, nan, 0));
  EXPECT_FALSE(program.IsCertainlyWithinLimits(standing, 0, nan));
}

}  // namespace
}  // namespace fogline::acc
