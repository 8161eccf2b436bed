// The accuracy that the filter reports must be correct. The runs follow exactly the model that the
// filter assumes. Over many runs, the filter's errors and innovations must have the covariances
// that the filter reports (Bar-Shalom, Li & Kirubarajan 2001, section 5.4).
#include <array>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>

#include "services/fusion/fusion.h"
#include "tests/property/services/fusion/lead_simulation.h"

namespace fogline {
namespace {

constexpr int kSeeds = 100;
constexpr std::size_t kSteps = 100;

// Sums over the seeds for each step.
struct Ensemble {
  std::vector<double> nees = std::vector<double>(kSteps);    // sum of error' P^-1 error, P reported
  std::vector<double> nis = std::vector<double>(kSteps);     // sum of innovation^2 / variance
  std::vector<double> values = std::vector<double>(kSteps);  // number of terms in nis
  std::vector<Eigen::Vector3d> error =
      std::vector<Eigen::Vector3d>(kSteps, Eigen::Vector3d::Zero());
  std::vector<Eigen::Vector3d> variance =
      std::vector<Eigen::Vector3d>(kSteps, Eigen::Vector3d::Zero());
};

// A scenario in which the position of the car ahead varies by about 15 m in kSteps steps. The car
// stays ahead of the host, and so near that the lateral offsets of the sensors have an effect.
Scenario GentleScenario() {
  Scenario scenario;
  scenario.fusion.jerk_density_m2ps5 = 0.02;
  scenario.fusion.initial_acceleration_std_mps2 = 0.2;
  return scenario;
}

// @param world the scenario that the simulated car follows
// @param believed the scenario that the filter assumes
Ensemble Simulate(const Scenario& world, const Scenario& believed, double dropout = 0) {
  Ensemble sums;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    testing::LeadSimulation lead(world, seed);
    lead.set_dropout(dropout);
    fusion::Fusion fusion(believed);
    for (std::size_t k = 0; k < kSteps; ++k) {
      const testing::LeadStep step = lead.Step();
      const track_t& track = fusion.Step(step.ego, step.radar, step.lidar);
      if (!track.valid) continue;
      const Eigen::Vector3d error = Eigen::Vector3d(track.state) - step.truth;
      const Eigen::Matrix3d p = Eigen::Map<const Eigen::Matrix3d>(track.covariance[0]);
      sums.nees[k] += error.dot(p.llt().solve(error));
      sums.error[k] += error;
      sums.variance[k] += p.diagonal();
      for (int i = 0; i < 3; ++i) {
        if (k == 0 || track.usage[i] != track_t::USED) continue;
        sums.nis[k] += track.innovation[i] * track.innovation[i] / track.innovation_variance[i];
        ++sums.values[k];
      }
    }
  }
  return sums;
}

// Whether a chi-square variable lies outside its two-sided 95 % bounds.
bool Outside(double value, double degrees_of_freedom) {
  const boost::math::chi_squared chi2(degrees_of_freedom);
  return value < quantile(chi2, 0.025) || value > quantile(chi2, 0.975);
}

int NeesOutside(const Ensemble& sums) {
  int outside = 0;
  for (std::size_t k = 1; k < kSteps; ++k) outside += Outside(sums.nees[k], 3.0 * kSeeds);
  return outside;
}

int NisOutside(const Ensemble& sums) {
  int outside = 0;
  for (std::size_t k = 1; k < kSteps; ++k) outside += Outside(sums.nis[k], sums.values[k]);
  return outside;
}

// Innovations of different steps are independent, so the number of steps outside the bounds is
// binomial. The test allows at most the 99.9 % quantile of this number.
constexpr double kOutsideChance = 0.05;
int MostOutside() {
  return static_cast<int>(quantile(boost::math::binomial(kSteps - 1, kOutsideChance), 0.999));
}

// Errors of neighbouring steps are correlated, so one unlucky period counts several times. The test
// therefore allows twice MostOutside(): a quarter of all steps.
int MostNeesOutside() { return 2 * MostOutside(); }

double Mean(const std::vector<double>& sums) {
  double total = 0;
  for (std::size_t k = 1; k < kSteps; ++k) total += sums[k];
  return total / (kSeeds * static_cast<double>(kSteps - 1));
}

struct Case {
  const char* name;
  double radar_offset_m;
  double lidar_offset_m;
  double dropout;
};

class ConsistencyTest : public ::testing::TestWithParam<Case> {
 protected:
  static Scenario World() {
    Scenario scenario = GentleScenario();
    scenario.radar.lateral_offset_m = GetParam().radar_offset_m;
    scenario.lidar.lateral_offset_m = GetParam().lidar_offset_m;
    return scenario;
  }
};

TEST_P(ConsistencyTest, ErrorsHaveTheReportedCovariance) {
  const Ensemble sums = Simulate(World(), World(), GetParam().dropout);
  EXPECT_LE(NeesOutside(sums), MostNeesOutside());
  // The expected mean is 3, the dimension of the state. From one group of a hundred seeds to
  // another, the mean varies with a standard deviation of 0.06. It would be 0.025 if the errors of
  // all steps were independent. The tolerance is about three times 0.06.
  EXPECT_NEAR(Mean(sums.nees), 3.0, 0.2);
}

TEST_P(ConsistencyTest, InnovationsHaveTheReportedVariance) {
  const Ensemble sums = Simulate(World(), World(), GetParam().dropout);
  EXPECT_LE(NisOutside(sums), MostOutside());
  double nis = 0;
  double values = 0;
  for (std::size_t k = 1; k < kSteps; ++k) {
    nis += sums.nis[k];
    values += sums.values[k];
  }
  EXPECT_FALSE(Outside(nis, values)) << nis / values << " per value instead of 1";
}

TEST_P(ConsistencyTest, EstimateIsUnbiased) {
  const Ensemble sums = Simulate(World(), World(), GetParam().dropout);
  for (int component = 0; component < 3; ++component) {
    int outside = 0;
    for (std::size_t k = 1; k < kSteps; ++k) {
      // The sum of the errors is normal; its variance is the sum of the variances.
      const double z_squared =
          sums.error[k][component] * sums.error[k][component] / sums.variance[k][component];
      outside += Outside(z_squared, 1);
    }
    EXPECT_LE(outside, MostNeesOutside()) << "component " << component;
  }
}

INSTANTIATE_TEST_SUITE_P(Geometries, ConsistencyTest,
                         ::testing::Values(Case{"AheadOfTheSensors", 0, 0, 0},
                                           Case{"BesideTheLane", 3.0, -2.0, 0},
                                           Case{"WithDropouts", 0, 0, 0.4}),
                         [](const auto& test) { return test.param.name; });

TEST(ConsistencyBoundsTest, UncoverAFilterThatBelievesInASteadierCar) {
  const Scenario world = GentleScenario();
  Scenario believed = world;
  believed.fusion.jerk_density_m2ps5 = world.fusion.jerk_density_m2ps5 / 10;
  const Ensemble sums = Simulate(world, believed);
  EXPECT_GT(NeesOutside(sums), static_cast<int>(kSteps / 2));
  EXPECT_GT(NisOutside(sums), MostOutside());
}

TEST(ConsistencyBoundsTest, UncoverAFilterThatKnowsNoLateralOffset) {
  const Scenario believed = GentleScenario();
  Scenario world = believed;
  world.lidar.lateral_offset_m = -2.0;
  EXPECT_GT(NisOutside(Simulate(world, believed)), MostOutside());
}

TEST(ConsistencyBoundsTest, UncoverAFilterThatBelievesInWorseSensors) {
  const Scenario world = GentleScenario();
  Scenario believed = world;
  believed.fusion.lidar_range_std_m = 1.5 * world.fusion.lidar_range_std_m;
  EXPECT_GT(NisOutside(Simulate(world, believed)), MostOutside());
}

}  // namespace
}  // namespace fogline
