// Properties of the LiDAR's errors and of its beams, over many seeds and steps.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "services/lidar/lidar.h"
#include "services/visibility.h"
#include "tests/support/sensor_errors.h"
#include "tests/unit/services/lidar/crossover_range.h"

namespace fogline {
namespace {

using test::ExpectShare;
using test::ExpectStandardNormalMoments;
using test::ExpectUniform;
using test::kSeeds;
using test::kSteps;

truth_t Target(std::int64_t step, double gap_m = 33.0, double visibility_m = 20000.0) {
  truth_t truth{};
  truth.header.step = step;
  truth.host_gap_m = gap_m;
  truth.fog_visibility_m = visibility_m;
  return truth;
}

std::vector<lidar_t> Measure(Scenario scenario, double gap_m, double visibility_m) {
  std::vector<lidar_t> measurements;
  for (int seed = 0; seed < kSeeds; ++seed) {
    scenario.seed = seed;
    lidar::Lidar lidar(scenario);
    for (int step = 0; step < kSteps; ++step) {
      measurements.push_back(lidar.Step(Target(step, gap_m, visibility_m)));
    }
  }
  return measurements;
}

Scenario Beam() {
  Scenario scenario;
  scenario.fog.model = FogModel::kBeam;
  scenario.fog.visibility_m = 20.0;
  scenario.lidar.range_std_m = 0.0;
  return scenario;
}

TEST(LidarProperty, NoiseHasTheStatedMomentsAroundTheBias) {
  Scenario scenario;
  scenario.lidar.bias_m = -0.2;
  scenario.lidar.range_std_m = 0.03;
  std::vector<double> z;
  for (const lidar_t& lidar : Measure(scenario, 33.0, 20000.0)) {
    z.push_back((lidar.range_m - 32.8) / 0.03);
  }
  ExpectStandardNormalMoments(z);
}

TEST(LidarProperty, BeamNoiseIsWhatItStates) {
  Scenario scenario = Beam();
  scenario.lidar.range_std_m = 0.03;
  std::vector<double> z;
  for (const lidar_t& lidar : Measure(scenario, 100.0, 20000.0)) {
    ASSERT_TRUE(lidar.valid);
    z.push_back((lidar.range_m - 100.0) / lidar.range_std_m);
  }
  ExpectStandardNormalMoments(z);
}

TEST(LidarProperty, DropsOutAtItsRate) {
  for (const double probability : {0.01, 0.3, 0.9}) {
    Scenario scenario;
    scenario.lidar.dropout_probability = probability;
    int dropouts = 0;
    for (const lidar_t& lidar : Measure(scenario, 33.0, 20000.0)) dropouts += lidar.valid ? 0 : 1;
    ExpectShare(dropouts, probability, "dropout");
  }
}

// Probabilities of the outcomes of one beam.
struct Outcomes {
  double none;
  double target;
};

// The log power of the target's echo is t + s X, and the log power of the fog's echo is f + s Y,
// with independent standard normal X and Y. An echo counts if its log power is above 0 and above
// the log power of the other echo. With the density phi and the distribution function Phi of the
// standard normal distribution:
//   no echo  X < -t / s and Y < -f / s
//   target   integral over x > -t / s of  phi(x) Phi((t + s x - f) / s)
Outcomes OutcomesOf(const LidarBeamSection& beam, double gap_m, double visibility_m) {
  const lidar::EchoModel model(beam, ExtinctionOf(20000.0), ExtinctionOf(20.0));
  const lidar::EchoPowers echoes = model.At(gap_m, visibility_m);
  const double s = beam.log_std;
  const double t = echoes.target;
  const double f = echoes.fog;
  const boost::math::normal normal;
  return {.none = cdf(normal, -t / s) * cdf(normal, -f / s),
          .target = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
              [&](double x) { return pdf(normal, x) * cdf(normal, (t + s * x - f) / s); }, -t / s,
              std::max(-t / s, 0.0) + 10.0)};
}

TEST(LidarProperty, ABeamsOutcomesHaveTheirProbabilities) {
  Scenario scenario = Beam();
  scenario.lidar.beam.beams = 1;
  struct Case {
    double gap_m;
    double visibility_m;
  };
  for (const Case& c : {Case{70.0, 250.0}, Case{120.0, 500.0}, Case{30.0, 75.0}}) {
    const Outcomes expected = OutcomesOf(scenario.lidar.beam, c.gap_m, c.visibility_m);
    int none = 0;
    int target = 0;
    for (const lidar_t& lidar : Measure(scenario, c.gap_m, c.visibility_m)) {
      none += !lidar.valid;
      target += lidar.valid && lidar.range_m == c.gap_m;
    }
    EXPECT_GT(expected.target, 0.02) << "the case must be mixed to say something";
    EXPECT_LT(expected.target, 0.98);
    ExpectShare(none, expected.none, "no echo");
    ExpectShare(target, expected.target, "target");
  }
}

TEST(LidarProperty, OfTwoEchoesTheNearerOneCounts) {
  // Two beams report the target if both see it, or if one sees it and the other sees nothing.
  Scenario scenario = Beam();
  scenario.lidar.beam.beams = 2;
  const auto [none, seen] = OutcomesOf(scenario.lidar.beam, 70.0, 250.0);
  int target = 0;
  for (const lidar_t& lidar : Measure(scenario, 70.0, 250.0)) {
    target += lidar.valid && lidar.range_m == 70.0;
  }
  ExpectShare(target, seen * seen + 2.0 * seen * none, "target");
}

TEST(LidarProperty, TheEchoIsThatOfTheMajorityOfBeams) {
  // At the range where one beam has an echo with probability 1/2, a majority of 15 beams has an
  // echo with probability 1/2, too.
  Scenario scenario = Beam();
  scenario.fog.clear_visibility_m = 1e5;
  scenario.lidar.beam.target_reflectivity = scenario.lidar.beam.clear_reflectivity;
  const double range_m =
      test::AttenuatedRange_m(scenario.lidar.beam.clear_range_m, ExtinctionOf(1e5));
  for (const std::int64_t beams : {1, 15, 101}) {
    scenario.lidar.beam.beams = beams;
    int detections = 0;
    for (const lidar_t& lidar : Measure(scenario, range_m, 1e5)) detections += lidar.valid;
    ExpectShare(detections, 0.5, "detection");
  }
  // Half of the beams suffice if their number is even. At least one of two beams has an echo with
  // probability 3/4.
  scenario.lidar.beam.beams = 2;
  int detections = 0;
  for (const lidar_t& lidar : Measure(scenario, range_m, 1e5)) detections += lidar.valid;
  ExpectShare(detections, 0.75, "detection");
}

TEST(LidarProperty, FogScattersByABetaDistribution) {
  Scenario scenario = Beam();
  scenario.lidar.beam.beams = 1;
  scenario.lidar.beam.log_std = 0.01;  // only the fog gives echoes
  const lidar::EchoModel model(scenario.lidar.beam, ExtinctionOf(20000.0), ExtinctionOf(20.0));
  const double peak_m = model.At(60.0, 25.0).fog_range_m;
  const boost::math::beta_distribution beta(2.0, 20.0);
  std::vector<double> shares;
  for (const lidar_t& lidar : Measure(scenario, 60.0, 25.0)) {
    ASSERT_TRUE(lidar.valid);
    shares.push_back(cdf(beta, (lidar.range_m - peak_m) / 10.0));
  }
  ExpectUniform(shares);
}

TEST(LidarProperty, NothingIsEverSeenBehindTheTarget) {
  Scenario scenario = Beam();
  scenario.lidar.beam.beams = 1;
  scenario.lidar.beam.fog_range_scale_m = 100.0;  // the fog's echoes scatter far beyond the target
  lidar::Lidar lidar(scenario);
  for (double gap_m = 0.5; gap_m < 120.0; gap_m *= 1.1) {
    for (double visibility_m = 20.0; visibility_m < 20000.0; visibility_m *= 1.3) {
      for (std::int64_t step = 0; step < 20; ++step) {
        const lidar_t& out = lidar.Step(Target(step, gap_m, visibility_m));
        EXPECT_LE(out.range_m, gap_m);
        EXPECT_GE(out.intensity, 0.0);
        EXPECT_TRUE(std::isfinite(out.intensity));
      }
    }
  }
}

TEST(LidarProperty, DenserFogNeverBringsTheTargetBack) {
  // The draws of a step are the same in any fog. So if the LiDAR does not measure the target in
  // some fog, it does not measure the target in denser fog.
  lidar::Lidar lidar(Beam());
  for (std::int64_t step = 0; step < 100; ++step) {
    bool sees_target = true;
    for (double visibility_m = 20000.0; visibility_m > 20.0; visibility_m *= 0.9) {
      const lidar_t& out = lidar.Step(Target(step, 33.0, visibility_m));
      const bool sees = out.valid && out.range_m == 33.0;
      EXPECT_TRUE(sees_target || !sees) << "step " << step << " visibility " << visibility_m;
      sees_target = sees;
    }
    EXPECT_FALSE(sees_target);
  }
}

// ---- fog model modes ----------------------------------------------------------------------------

Scenario Modes() {
  Scenario scenario;
  scenario.fog.model = FogModel::kModes;
  scenario.fog.visibility_m = 60.0;
  scenario.fog.bias_m = 2.0;
  scenario.fog.modes = {.biased_share = 0.1, .near_echo_share = 0.2, .missing_share = 0.5};
  scenario.lidar.range_std_m = 0.0;
  return scenario;
}

truth_t InModes(std::int64_t step, double gap_m, double level) {
  truth_t truth = Target(step, gap_m, 60.0);
  truth.fog_present = true;
  truth.fog_level = level;
  return truth;
}

TEST(LidarProperty, EachModeHasItsShare) {
  for (const double level : {0.3, 1.0}) {
    for (const double gap_m : {20.0, 28.0, 60.0}) {
      int missing = 0;
      int near_echo = 0;
      int biased = 0;
      for (int seed = 0; seed < kSeeds; ++seed) {
        Scenario scenario = Modes();
        scenario.seed = seed;
        lidar::Lidar lidar(scenario);
        for (int step = 0; step < kSteps; ++step) {
          const lidar_t& out = lidar.Step(InModes(step, gap_m, level));
          missing += !out.valid;
          near_echo += out.valid && out.range_m < 12.0;
          biased += out.valid && out.range_m == gap_m - 2.0;
        }
      }
      const double misses = std::clamp((gap_m - 25.0) / 10.0, 0.0, 1.0);
      if (misses > 0) {
        ExpectShare(missing, level * 0.5 * misses, "missing");
      } else {
        EXPECT_EQ(missing, 0);
      }
      ExpectShare(near_echo, level * 0.2, "near echo");
      ExpectShare(biased, level * 0.1, "biased");
    }
  }
}

TEST(LidarProperty, ANearEchoScattersAsUnderModelBeam) {
  Scenario scenario = Modes();
  scenario.fog.modes = {.near_echo_share = 1, .missing_share = 0};
  const lidar::EchoModel model(scenario.lidar.beam, ExtinctionOf(20000.0), ExtinctionOf(60.0));
  const double peak_m = model.At(60.0, 60.0).fog_range_m;
  EXPECT_GT(peak_m, 3.0);
  EXPECT_LT(peak_m, 4.0);
  const boost::math::beta_distribution beta(2.0, 20.0);
  std::vector<double> shares;
  for (int seed = 0; seed < kSeeds; ++seed) {
    scenario.seed = seed;
    lidar::Lidar lidar(scenario);
    for (int step = 0; step < kSteps; ++step) {
      shares.push_back(cdf(beta, (lidar.Step(InModes(step, 60.0, 1.0)).range_m - peak_m) / 10.0));
    }
  }
  ExpectUniform(shares);
}

// ---- all models ---------------------------------------------------------------------------------

void ExpectThatNoStepDependsOnAnother(Scenario scenario) {
  scenario.lidar.range_std_m = 0.02;
  scenario.lidar.dropout_probability = 0.1;
  lidar::Lidar forwards(scenario);
  std::vector<lidar_t> expected;
  for (int step = 0; step < kSteps; ++step) {
    expected.push_back(forwards.Step(InModes(step, 33.0, 0.8)));
  }
  lidar::Lidar backwards(scenario);
  for (int step = kSteps - 1; step >= 0; --step) {
    backwards.Step(InModes(step * 7, 20.0, 1.0));
    const lidar_t& lidar = backwards.Step(InModes(step, 33.0, 0.8));
    const lidar_t& same = expected[static_cast<std::size_t>(step)];
    EXPECT_EQ(lidar.valid, same.valid);
    EXPECT_EQ(lidar.range_m, same.range_m);
    EXPECT_EQ(lidar.range_std_m, same.range_std_m);
    EXPECT_EQ(lidar.intensity, same.intensity);
  }
}

TEST(LidarProperty, NoStepDependsOnAnother) {
  ExpectThatNoStepDependsOnAnother(Beam());
  ExpectThatNoStepDependsOnAnother(Modes());
}

}  // namespace
}  // namespace fogline
