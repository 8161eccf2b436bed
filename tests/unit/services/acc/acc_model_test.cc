#include "services/acc/acc_model.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fogline {
namespace {

AccSection Section(double headway_s, double time_constant_s, double gain) {
  AccSection section;
  section.headway_s = headway_s;
  section.engine_time_constant_s = time_constant_s;
  section.engine_gain = gain;
  return section;
}

// The model's matrices Phi and Gamma for a step of h, in closed form. They follow from the
// integrals of a(t) = e^(-t/T) a(0) - K (1 - e^(-t/T)) u, with the engine's time constant T and
// gain K.
acc::DiscreteAccModel ClosedForm(const AccSection& section, double h) {
  const double tau = section.engine_time_constant_s;
  const double gain = section.engine_gain;
  const double rise = -std::expm1(-h / tau);        // of a, caused by u
  const double speed = h - tau * rise;              // the integral of rise
  const double distance = h * h / 2 - tau * speed;  // the integral of speed
  acc::DiscreteAccModel model;
  model.phi << 1, h, -tau * speed - section.headway_s * tau * rise,  //
      0, 1, -tau * rise,                                             //
      0, 0, 1 - rise;
  model.gamma << gain * (distance + section.headway_s * speed), gain * speed, -gain * rise;
  return model;
}

TEST(AccModelTest, HasTheMatricesOfThePaper) {
  const acc::AccModel model = acc::MakeAccModel(Section(1.5, 0.5, 0.8));
  EXPECT_EQ(model.a, (Eigen::Matrix3d{{0, 1, -1.5}, {0, 0, -1}, {0, 0, -2}}));
  EXPECT_EQ(model.b, Eigen::Vector3d(0, 0, -1.6));
  EXPECT_EQ(model.c, Eigen::RowVector3d(0, 0, 1));
}

TEST(AccModelTest, SettlesAtMinusGainTimesControl) {
  // GIVEN a constant positive control
  const acc::DiscreteAccModel model =
      acc::Discretise(acc::MakeAccModel(Section(1.5, 0.46, 0.732)), 0.1);
  const double control = 2.0;
  // WHEN 10 s have passed, more than twenty time constants
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int k = 0; k < 100; ++k) x = model.phi * x + model.gamma * control;
  // THEN the car decelerates by K u, is slower than the car ahead, and its gap is too large
  EXPECT_NEAR(x(acc::kOwnAcceleration), -0.732 * control, 1e-9);  // e^-21 of the change is missing
  EXPECT_GT(x(acc::kDeltaV), 0);
  EXPECT_GT(x(acc::kDeltaD), 0);
}

// The tolerance covers some roundings of the largest element of Phi.
TEST(AccModelTest, DiscretisationEqualsTheIntegralsWrittenOut) {
  for (const double step_s : {0.001, 0.05, 0.1, 1.0}) {
    for (const double time_constant_s : {0.01, 0.46, 10.0}) {
      for (const double headway_s : {0.0, 1.5, 10.0}) {
        const AccSection section = Section(headway_s, time_constant_s, 0.732);
        const acc::DiscreteAccModel model = acc::Discretise(acc::MakeAccModel(section), step_s);
        const acc::DiscreteAccModel expected = ClosedForm(section, step_s);
        const double tolerance = 1e-13 * (1 + expected.phi.cwiseAbs().maxCoeff());
        EXPECT_LE((model.phi - expected.phi).cwiseAbs().maxCoeff(), tolerance)
            << "h " << step_s << " T_e " << time_constant_s << " T_hw " << headway_s;
        EXPECT_LE((model.gamma - expected.gamma).cwiseAbs().maxCoeff(), tolerance)
            << "h " << step_s << " T_e " << time_constant_s << " T_hw " << headway_s;
      }
    }
  }
}

TEST(AccModelTest, DiscretisationEqualsThePowerSeries) {
  const acc::AccModel model = acc::MakeAccModel(Section(1.5, 0.46, 0.732));
  const double h = 0.1;
  // Phi = sum of (A h)^i / i!, and Gamma = sum of A^i h^(i+1) / (i+1)! B. The elements of A h are
  // below 0.3, so the terms after the 20th are smaller than a rounding.
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d phi = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gamma = Eigen::Vector3d::Zero();
  for (int i = 0; i < 20; ++i) {
    phi += term;
    gamma += term * model.b * (h / (i + 1));
    term = term * model.a * (h / (i + 1));
  }
  const acc::DiscreteAccModel discrete = acc::Discretise(model, h);
  EXPECT_LE((discrete.phi - phi).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((discrete.gamma - gamma).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(AccModelTest, TwoHalfStepsAreOneStep) {
  const acc::AccModel model = acc::MakeAccModel(AccSection{});
  const acc::DiscreteAccModel whole = acc::Discretise(model, 0.1);
  const acc::DiscreteAccModel half = acc::Discretise(model, 0.05);
  EXPECT_LE((half.phi * half.phi - whole.phi).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((half.phi * half.gamma + half.gamma - whole.gamma).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(AccModelTest, SafeDistanceGrowsWithSpeed) {
  const AccSection section = Section(1.5, 0.46, 1.0);
  EXPECT_EQ(acc::SafeDistance(section, 0), section.standstill_m);
  EXPECT_EQ(acc::SafeDistance(section, 20), section.standstill_m + 30);
}

}  // namespace
}  // namespace fogline
