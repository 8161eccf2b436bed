#include "services/fusion/ekf.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/fusion/fusion.h"
#include "services/fusion/line_of_sight.h"
#include "tests/property/services/fusion/lead_simulation.h"

namespace fogline {
namespace {

Eigen::Matrix3d CovarianceOf(const track_t& track) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(track.covariance[0]);
}

// A random number from 10^low to 10^high, uniform in the exponent.
double Magnitude(const Random& random, std::uint32_t index, double low, double high) {
  return std::pow(10.0, low + (high - low) * random.Uniform2(0, index)[0]);
}

TEST(EkfPropertyTest, CovarianceStaysSymmetricAndPositiveDefinite) {
  for (int seed = 1; seed <= 200; ++seed) {
    // GIVEN a filter with parameters from the whole range of a scenario, and sensors that often
    // fail
    const Random random(seed, Stream::kLidar);
    Scenario scenario;
    scenario.step_s = Magnitude(random, 0, -3, 0);
    scenario.fusion.jerk_density_m2ps5 = Magnitude(random, 1, -6, 3);
    scenario.fusion.radar_range_std_m = Magnitude(random, 2, -4, 1);
    scenario.fusion.radar_range_rate_std_mps = Magnitude(random, 3, -4, 1);
    scenario.fusion.lidar_range_std_m = Magnitude(random, 4, -4, 1);
    scenario.radar.lateral_offset_m = 3 * random.Normal2(0, 5)[0] / 3;
    scenario.lidar.lateral_offset_m = 3 * random.Normal2(0, 5)[1] / 3;
    testing::LeadSimulation lead(scenario, seed);
    lead.set_dropout(random.Uniform2(0, 6)[0]);
    fusion::Fusion fusion(scenario);
    for (int k = 0; k < 300; ++k) {
      const testing::LeadStep step = lead.Step();
      // WHEN the filter has made a step
      const track_t& track = fusion.Step(step.ego, step.radar, step.lidar);
      if (!track.valid) continue;
      // THEN the covariance is symmetric and positive definite
      const Eigen::Matrix3d p = CovarianceOf(track);
      ASSERT_EQ(p, p.transpose()) << "seed " << seed << ", step " << k;
      ASSERT_EQ(p.llt().info(), Eigen::Success) << "seed " << seed << ", step " << k << "\n" << p;
    }
  }
}

// The host's own motion is known, so it must not change the estimate of the other car's motion.
TEST(EkfPropertyTest, BrakingOfTheHostLeavesTheEstimateOfThePrecedingCarAlone) {
  const Scenario scenario;
  const double t = scenario.step_s;
  testing::LeadSimulation lead(scenario, 1);
  fusion::Fusion steady(scenario);
  fusion::Fusion braking(scenario);
  double distance_shift = 0;
  double speed_shift = 0;
  for (int k = 0; k < 300; ++k) {
    const testing::LeadStep step = lead.Step();
    const double extra = k == 0 ? 0 : (k % 60 < 30 ? -6.0 : 2.0);
    distance_shift += speed_shift * t - extra * t * t / 2;
    speed_shift -= extra * t;
    testing::LeadStep other = step;
    other.ego.acceleration_mps2 += extra;
    other.radar.range_m += distance_shift;
    other.radar.range_rate_mps += speed_shift;
    other.lidar.range_m += distance_shift;
    const track_t& a = steady.Step(step.ego, step.radar, step.lidar);
    const track_t& b = braking.Step(other.ego, other.radar, other.lidar);
    // The tolerance covers the rounding of distances that grow to some 1000 m.
    ASSERT_NEAR(a.state[2] + step.ego.acceleration_mps2, b.state[2] + other.ego.acceleration_mps2,
                1e-8)
        << "step " << k;
    ASSERT_NEAR(a.state[1] + speed_shift, b.state[1], 1e-9) << "step " << k;
    ASSERT_NEAR(a.state[0] + distance_shift, b.state[0], 1e-9) << "step " << k;
  }
}

// Ekf corrects the state three times, by one value each. This must equal the textbook's joint
// correction by all three values.
TEST(EkfPropertyTest, SequentialCorrectionsEqualAJointOne) {
  const Scenario scenario;
  const FusionSection& f = scenario.fusion;
  Eigen::Matrix3d h;
  h << 1, 0, 0, 0, 1, 0, 1, 0, 0;
  const Eigen::Vector3d stds(f.radar_range_std_m, f.radar_range_rate_std_mps, f.lidar_range_std_m);
  const Eigen::Matrix3d r = stds.cwiseAbs2().asDiagonal();
  testing::LeadSimulation lead(scenario, 2);
  fusion::Ekf joint(scenario.step_s, f.jerk_density_m2ps5);  // predicts only; the test corrects it
  fusion::Fusion fusion(scenario);
  for (int k = 0; k < 100; ++k) {
    const testing::LeadStep step = lead.Step();
    const track_t& track = fusion.Step(step.ego, step.radar, step.lidar);
    const double host = step.ego.acceleration_mps2;
    const Eigen::Vector3d own(track.state[0], track.state[1], track.state[2] + host);
    if (k == 0) {
      joint.Start(own, CovarianceOf(track));
      continue;
    }
    joint.Predict(host);
    const Eigen::Matrix3d& p = joint.covariance();
    const Eigen::Vector3d z(step.radar.range_m, step.radar.range_rate_mps, step.lidar.range_m);
    const Eigen::Matrix3d gain = p * h.transpose() * (h * p * h.transpose() + r).inverse();
    const Eigen::Vector3d x = joint.state() + gain * (z - h * joint.state());
    joint.Start(x, (Eigen::Matrix3d::Identity() - gain * h) * p);
    // Both filters compute the same numbers by different operations. 1e-10 is more than 10,000
    // times the rounding of 60 m.
    ASSERT_LT((own - x).cwiseAbs().maxCoeff(), 1e-10) << "step " << k;
    ASSERT_LT((CovarianceOf(track) - joint.covariance()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(EkfPropertyTest, PredictionInTwoHalvesIsThePredictionOfTheWhole) {
  fusion::Ekf whole(0.2, 0.7);
  fusion::Ekf half(0.1, 0.7);
  Eigen::Matrix3d p;
  p << 2, 0.1, 0.3, 0.1, 1, -0.2, 0.3, -0.2, 0.5;
  whole.Start({30, -2, 0.4}, p);
  half.Start({30, -2, 0.4}, p);
  whole.Predict(-1.5);
  half.Predict(-1.5);
  half.Predict(-1.5);
  EXPECT_LT((whole.state() - half.state()).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((whole.covariance() - half.covariance()).cwiseAbs().maxCoeff(), 1e-14);
}

// The covariance after a correction in Joseph's form, with whole 3x3 matrices. The covariance of
// Ekf must have the same bits. So Ekf adds three products in Eigen's order, a + (b + c).
Eigen::Matrix3d JosephForm(const Eigen::Matrix3d& p, const fusion::Ekf::Jacobian& jacobian,
                           double noise_variance) {
  const Eigen::RowVector3d h(jacobian(0), jacobian(1), 0);
  const double variance = jacobian.dot(jacobian * p.topLeftCorner<2, 2>()) + noise_variance;
  const Eigen::Vector3d gain = p.leftCols<2>() * jacobian.transpose() / variance;
  const Eigen::Matrix3d keep = Eigen::Matrix3d::Identity() - gain * h;
  const Eigen::Vector3d noise = gain * noise_variance;
  const Eigen::Matrix3d sum = keep * p * keep.transpose() + noise * gain.transpose();
  return (sum + sum.transpose()) / 2;
}

TEST(EkfPropertyTest, PredictionAndCorrectionLeaveOutOnlyZeros) {
  const Random random(9, Stream::kLidar);
  for (std::uint32_t i = 0; i < 300; ++i) {
    const double t = Magnitude(random, i, -2, 0);
    const double density = Magnitude(random, i + 1, -4, 2);
    fusion::Ekf ekf(t, density);
    ekf.Start({30, 1, 0.1}, Eigen::Vector3d(2, 3, 4).asDiagonal());
    for (std::int64_t k = 0; k < 30; ++k) {
      // The expected covariance and state after the prediction are computed with whole 3x3
      // matrices.
      Eigen::Matrix3d f;
      f << 1, t, t * t / 2, 0, 1, t, 0, 0, 1;
      fusion::Ekf noise_alone(t, density);
      noise_alone.Predict(0);  // from P = 0 the prediction gives the process noise Q
      const Eigen::Matrix3d sum = f * ekf.covariance() * f.transpose() + noise_alone.covariance();
      const Eigen::Vector3d state = f * ekf.state() + Eigen::Vector3d(-t * t / 2, -t, 0) * 0.7;
      ekf.Predict(0.7);
      ASSERT_EQ(ekf.covariance(), (sum + sum.transpose()) / 2) << "draw " << i << " step " << k;
      ASSERT_EQ(ekf.state(), state);

      const auto [a, b] = random.Normal2(k, i);
      for (const fusion::Ekf::Jacobian& jacobian :
           {fusion::Ekf::Jacobian(1, 0), fusion::Ekf::Jacobian(0, 1), fusion::Ekf::Jacobian(a, 0),
            fusion::Ekf::Jacobian(a, b)}) {
        const Eigen::Matrix3d expected = JosephForm(ekf.covariance(), jacobian, 0.04);
        ekf.Correct(jacobian, b, 0.04);
        ASSERT_EQ(ekf.covariance(), expected) << "H = " << jacobian;
      }
    }
  }
}

// The filter keeps the covariance updates that it has computed. It uses an update again for the
// same covariance, Jacobian and noise variance, and must never use it for others. This also holds
// if values are missing, come in another order, or come with another noise.
TEST(EkfPropertyTest, UsesAnUpdateAgainOnlyWhereItIsTheSame) {
  const Random random(10, Stream::kLidar);
  const std::array<fusion::Ekf::Jacobian, 4> jacobians{{{1, 0}, {0, 1}, {0.9, 0.3}, {0.8, 0}}};
  fusion::Ekf ekf(0.1, 1);
  ekf.Start({30, 1, 0.1}, Eigen::Vector3d(2, 3, 4).asDiagonal());
  int repeated = 0;
  for (std::int64_t k = 0; k < 20'000; ++k) {
    const Eigen::Matrix3d before = ekf.covariance();
    // GIVEN a filter that has computed nothing before
    fusion::Ekf fresh(0.1, 1);
    fresh.Start(ekf.state(), before);
    ekf.Predict(-0.3);
    fresh.Predict(-0.3);
    ASSERT_EQ(ekf.covariance(), fresh.covariance());
    // WHEN both filters are corrected by the three usual values, or sometimes by other values
    const bool is_usual = random.Uniform2(k, 0)[0] < 0.99;
    const int values = is_usual ? 3 : static_cast<int>(random.Uniform2(k, 1)[0] * 6);
    for (int i = 0; i < values; ++i) {
      const auto [a, b] = random.Uniform2(k, 2 + static_cast<std::uint32_t>(i));
      const auto& jacobian = is_usual ? jacobians[i % 2] : jacobians[static_cast<int>(a * 4)];
      const double noise_variance = is_usual || b < 0.5 ? 0.04 : 0.01;
      ekf.Correct(jacobian, a - b, noise_variance);
      fresh.Correct(jacobian, a - b, noise_variance);
      // THEN both filters have the same estimate, to the last bit
      ASSERT_EQ(ekf.covariance(), fresh.covariance()) << "step " << k << ", value " << i;
      ASSERT_EQ(ekf.state(), fresh.state()) << "step " << k << ", value " << i;
    }
    if (ekf.covariance() == before) ++repeated;
  }
  EXPECT_GT(repeated, 1000) << "the covariance never repeats, so the test shows nothing";
}

TEST(LineOfSightPropertyTest, JacobiansAreTheSlopes) {
  constexpr double kStep = 1e-5;  // error by truncation kStep^2, by rounding 1e-16 * 100 / kStep
  const Random random(3, Stream::kLidar);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double d = 100 * random.Normal2(0, i)[0] / 2;
    const double y = random.Normal2(1, i)[0];
    const double dv = 5 * random.Normal2(1, i)[1];
    if (std::abs(d) < 0.5) continue;  // the range has a kink at 0
    const fusion::LineOfSight sight(d, y);
    const fusion::LineOfSight nearer(d - kStep, y);
    const fusion::LineOfSight farther(d + kStep, y);
    EXPECT_NEAR(sight.RangeJacobian()[0], (farther.range_m() - nearer.range_m()) / (2 * kStep),
                1e-7);
    EXPECT_NEAR(sight.RangeRateJacobian(dv)[0],
                (farther.RangeRate(dv) - nearer.RangeRate(dv)) / (2 * kStep), 1e-6);
    EXPECT_NEAR(sight.RangeRateJacobian(dv)[1],
                (sight.RangeRate(dv + kStep) - sight.RangeRate(dv - kStep)) / (2 * kStep), 1e-7);
  }
}

TEST(LineOfSightPropertyTest, IsLinearWithoutAnOffset) {
  const Random random(4, Stream::kLidar);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double d = 100 * random.Normal2(0, i)[0];
    const double dv = 10 * random.Normal2(0, i)[1];
    const fusion::LineOfSight sight(d, 0);
    EXPECT_EQ(sight.range_m(), d);
    EXPECT_EQ(sight.RangeRate(dv), dv);
    EXPECT_EQ(sight.RangeJacobian(), fusion::Ekf::Jacobian(1, 0));
    EXPECT_EQ(sight.RangeRateJacobian(dv), fusion::Ekf::Jacobian(0, 1));
  }
}

}  // namespace
}  // namespace fogline
