// Properties of policies::Witness, which computes the filter's prediction of the range from
// messages.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <gtest/gtest.h>

#include "services/decision/policies/conflict_inputs.h"
#include "services/fusion/fusion.h"
#include "tests/property/services/fusion/lead_simulation.h"

namespace fogline {
namespace {

constexpr NoiseAdaptation kRules[]{NoiseAdaptation::kNone, NoiseAdaptation::kInnovation,
                                   NoiseAdaptation::kResidual};
constexpr int kSeeds = 20;
constexpr int kSteps = 200;

Scenario With(NoiseAdaptation rule, double radar_offset_m = 0, double lidar_offset_m = 0) {
  Scenario scenario;
  scenario.fusion.adaptive_noise = rule;
  scenario.radar.lateral_offset_m = radar_offset_m;
  scenario.lidar.lateral_offset_m = lidar_offset_m;
  return scenario;
}

/// Computes the variance of the filter's prediction of the first range in a step (H P- H' in
/// services/fusion/README.md), from the messages so far. This variance is the variance S of the
/// range's innovation minus the noise variance R. R follows the filter's rule for adaptive noise,
/// which uses the innovation d or the residual e. The class uses two formulas. The residual is
/// d R / S, and the variance after the correction is (S - R) R / S. Both formulas hold only if the
/// sensors have no lateral offsets. The rule `innovation` does not need these formulas, so it is
/// also exact with lateral offsets.
class ByRecursion {
 public:
  explicit ByRecursion(const Scenario& scenario)
      : rule_(scenario.fusion.adaptive_noise),
        forgetting_(scenario.fusion.noise_forgetting),
        assumed_{std::pow(scenario.fusion.radar_range_std_m, 2), 0,
                 std::pow(scenario.fusion.lidar_range_std_m, 2)},
        noise_{assumed_[0], 0, assumed_[2]} {}

  double Variance(const track_t& track, std::size_t value) const {
    return track.innovation_variance[value] - noise_[value];
  }
  void Learn(const track_t& track) {
    for (const std::size_t value : {std::size_t{0}, std::size_t{2}}) {
      if (track.usage[value] != track_t::USED || track.innovation[value] == 0) continue;
      const double d = track.innovation[value];
      const double s = track.innovation_variance[value];
      double& r = noise_[value];
      double seen = 0;
      if (rule_ == NoiseAdaptation::kInnovation) seen = d * d - (s - r);
      if (rule_ == NoiseAdaptation::kResidual) seen = d * d * r * r / (s * s) + (s - r) * r / s;
      if (rule_ == NoiseAdaptation::kNone) continue;
      r = std::max(assumed_[value], forgetting_ * r + (1 - forgetting_) * seen);
    }
  }

 private:
  NoiseAdaptation rule_;
  double forgetting_;
  double assumed_[3];
  double noise_[3];
};

void ExpectTheFiltersPrediction(const Scenario& scenario) {
  for (int seed = 1; seed <= kSeeds; ++seed) {
    testing::LeadSimulation lead(scenario, seed);
    lead.set_dropout(0.2);
    fusion::Fusion fusion(scenario);
    policies::Witness witness(scenario);
    ByRecursion recursion(scenario);
    int predictions = 0;
    for (int k = 0; k < kSteps; ++k) {
      const testing::LeadStep step = lead.Step();
      const track_t& track = fusion.Step(step.ego, step.radar, step.lidar);
      const conflict::StatedRange seen = witness.Prediction(track, step.radar, step.lidar);
      const std::size_t value = step.radar.valid ? 0 : 2;
      if (seen.valid) {
        ++predictions;
        const double measured = step.radar.valid ? step.radar.range_m : step.lidar.range_m;
        EXPECT_DOUBLE_EQ(seen.range_m, measured - track.innovation[value]);
        // Witness and ByRecursion compute the variance as a difference of numbers of the size of S.
        // So the rounding is relative to S.
        const double rounding = 1e-9 * std::max(1.0, track.innovation_variance[value]);
        ASSERT_NEAR(seen.std_m * seen.std_m, recursion.Variance(track, value), rounding)
            << "seed " << seed << ", step " << k;
      }
      recursion.Learn(track);
    }
    EXPECT_GT(predictions, kSteps * 8 / 10) << "every step but those without a value";
  }
}

TEST(WitnessProperty, IsTheFiltersPredictionWhateverNoiseItUses) {
  for (const NoiseAdaptation rule : kRules) ExpectTheFiltersPrediction(With(rule));
}

TEST(WitnessProperty, IsThatAlsoOfSensorsBesideTheLane) {
  ExpectTheFiltersPrediction(With(NoiseAdaptation::kNone, 2.5, -1.5));
  ExpectTheFiltersPrediction(With(NoiseAdaptation::kInnovation, 2.5, -1.5));
}

TEST(WitnessProperty, OfAnAdaptiveFilterNeedsTheStepBefore) {
  const Scenario scenario = With(NoiseAdaptation::kResidual);
  testing::LeadSimulation lead(scenario, 1);
  fusion::Fusion fusion(scenario);
  policies::Witness witness(scenario);
  for (int k = 0; k < 50; ++k) {
    const testing::LeadStep step = lead.Step();
    const track_t& track = fusion.Step(step.ego, step.radar, step.lidar);
    if (k % 10 == 5) continue;  // the witness does not get the messages of this step
    const bool predicted = witness.Prediction(track, step.radar, step.lidar).valid;
    EXPECT_EQ(predicted, k % 10 != 6 && k > 0) << k;
  }
}

}  // namespace
}  // namespace fogline
