// Checks the posterior probability that the LiDAR is deceived. In sequences that follow the model
// of the LiDAR's modes, the LiDAR must be deceived in a share p of the steps whose posterior is p.
#include "services/decision/conflict/over_time/lidar_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

constexpr double kRadarStd_m = 0.8;
constexpr double kLidarStd_m = 0.03;
constexpr std::int64_t kSequences = 50'000;
constexpr std::int64_t kLength = 12;  // steps of a sequence; the test uses only the last step

/// A LiDAR that behaves as the model says. The gap of each step is drawn independently.
class Lidar {
 public:
  Lidar(const conflict::ConflictParameters& model, const Random& random)
      : model_(model), random_(random) {}

  bool deceived() const { return mode_ != conflict::LidarMode::kClean; }

  conflict::Evidence At(std::int64_t step) {
    const auto [change, echo] = random_.Uniform2(step, 0);
    const auto [stray, place] = random_.Uniform2(step, 1);
    const auto [radar, lidar] = random_.Normal2(step, 2);
    const double gap_m = model_.fog_return_m + 10 * random_.Uniform2(step, 3)[0] - 5;
    const auto& next = model_.mode_transition[static_cast<std::size_t>(mode_)];
    mode_ = change < next[0]             ? conflict::LidarMode::kClean
            : change < next[0] + next[1] ? conflict::LidarMode::kFogReturn
                                         : conflict::LidarMode::kDropout;
    conflict::Evidence evidence{.radar = {true, gap_m + kRadarStd_m * radar, kRadarStd_m},
                                .lidar = {false, 0, kLidarStd_m},
                                .prediction = {}};
    if (echo >= model_.echo_probability[static_cast<std::size_t>(mode_)]) return evidence;
    evidence.lidar.valid = true;
    evidence.lidar.range_m = Range(gap_m, stray, place, lidar);
    return evidence;
  }

 private:
  double Range(double gap_m, double stray, double place, double noise) const {
    const double anywhere_m = place * model_.stray_range_m;
    switch (mode_) {
      case conflict::LidarMode::kClean:
        return gap_m + kLidarStd_m * noise;
      case conflict::LidarMode::kDropout:
        return anywhere_m;
      case conflict::LidarMode::kFogReturn:
        break;
    }
    if (stray < model_.stray_share) return anywhere_m;
    // The sum of the echo's scatter in the fog and of the sensor's noise is drawn from a normal
    // distribution, because the model treats this sum as normally distributed. The scatter has the
    // distribution Beta(2, 20), with mean 1/11 and variance 40/(22^2 23).
    const double scatter_m2 = model_.fog_scatter_m * model_.fog_scatter_m * 40 / (22 * 22 * 23);
    return model_.fog_return_m + model_.fog_scatter_m / 11 +
           std::sqrt(scatter_m2 + kLidarStd_m * kLidarStd_m) * noise;
  }

  conflict::ConflictParameters model_;
  Random random_;
  conflict::LidarMode mode_ = conflict::LidarMode::kClean;
};

/// All steps whose posterior lies in one interval: the sum of the posteriors (`said`), and the
/// number of steps in which the LiDAR is deceived (`were_so`). Both have the same expected value.
struct Claims {
  double said = 0;
  double variance = 0;  // variance of the number of deceived steps
  int were_so = 0;
  int count = 0;
};

TEST(LidarModesPropertyTest, SayTheShareOfStepsInWhichTheLidarIsDeceived) {
  // GIVEN many LiDARs with a fog return near the car, so that all probabilities occur
  conflict::ConflictParameters model;
  model.fog_return_m = 40;
  constexpr std::array kEdges{0.02, 0.5, 0.98};  // in most steps the posterior is near 0 or 1
  std::array<Claims, kEdges.size() + 1> claims{};
  for (std::int64_t sequence = 0; sequence < kSequences; ++sequence) {
    Lidar lidar(model, Random(sequence, Stream::kLidar));
    conflict::LidarModeConflict posterior(model);
    double p = 0;
    for (std::int64_t step = 0; step < kLength; ++step) p = posterior.Step(lidar.At(step));
    Claims& claim = claims[static_cast<std::size_t>(
        std::ranges::count_if(kEdges, [p](double edge) { return p >= edge; }))];
    claim.said += p;
    claim.variance += p * (1 - p);
    claim.were_so += lidar.deceived() ? 1 : 0;
    ++claim.count;
  }
  // THEN in each interval the number of deceived steps is about the sum of the posteriors
  for (const Claims& claim : claims) {
    EXPECT_GT(claim.count, 100) << claim.said;
    EXPECT_NEAR(claim.were_so, claim.said, 4 * std::sqrt(claim.variance)) << claim.count;
  }
}

}  // namespace
}  // namespace fogline
