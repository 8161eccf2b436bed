#include "tools/study/detection/detector_bank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/random.h"
#include "services/decision/conflict/over_time/degree_of_conflict.h"
#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

TEST(DetectorParametersTest, FollowTheNoiseOfTheSensors) {
  Scenario scenario;
  scenario.radar.range_std_m = 0.3;
  scenario.lidar.range_std_m = 0.4;
  const conflict::ConflictParameters parameters = study::DetectorParameters(scenario);
  // CUSUM and SPRT, the two sequential tests, look for the same shift of the difference. With
  // CUSUM's reference value kappa = 1/2, this shift is one standard deviation of the difference:
  // 0.5 m.
  EXPECT_NEAR(parameters.sprt_delta_m, 0.5, 1e-12);
  EXPECT_EQ(parameters.bin_width_m, 0.4);
  EXPECT_EQ(parameters.frame_bins, 625) << "250 m as ever";
}

TEST(DetectorsTest, BeginWithEveryMeasureOfTheTable) {
  const auto rows = conflict::ConflictMeasures();
  for (std::size_t m = 0; m < rows.size(); ++m) {
    EXPECT_EQ(study::Detectors()[m].name, rows[m].name);
    EXPECT_EQ(study::Detectors()[m].measure, m);
  }
  EXPECT_EQ(study::Detectors()[rows.size()].name, "distance");
}

TEST(DetectorsTest, HaveWindowAndSignForEachMeasureOfASingleStep) {
  for (const std::string measure :
       {"nis", "hellinger", "dempster_bins", "cosine_consonant", "witness_nis", "distance"}) {
    for (const std::string with : {" + window", " + sign", " + window + sign"}) {
      EXPECT_NO_THROW(study::DetectorNamed(measure + with)) << measure << with;
    }
  }
  for (const std::string measure :
       {"doc", "nis_window", "nis_signed", "cusum", "glr", "sprt", "lidar_modes"}) {
    EXPECT_THROW(study::DetectorNamed(measure + " + window"), std::out_of_range) << measure;
  }
  std::set<std::string> names;
  for (const study::Detector& one : study::Detectors()) names.insert(one.name);
  EXPECT_EQ(names.size(), study::Detectors().size());
}

/// The scores of some detectors, step by step.
std::vector<std::vector<double>> ScoresOf(const conflict::ConflictParameters& parameters,
                                          const std::vector<std::string>& names, int steps) {
  std::vector<std::size_t> detectors;
  for (const std::string& name : names) detectors.push_back(study::DetectorNamed(name));
  study::DetectorBank bank(parameters, detectors);
  const Random random(1, Stream{1'000'005});
  std::vector<std::vector<double>> scores;
  for (int i = 0; i < steps; ++i) {
    const auto of_step = bank.Step(UnitNoise(random, i, 0.3));
    scores.emplace_back(of_step.begin(), of_step.end());
  }
  return scores;
}

TEST(DetectorBankTest, WindowAndSignAreThoseOfTheScores) {
  conflict::ConflictParameters parameters;
  parameters.window_steps = 3;
  const auto scores =
      ScoresOf(parameters, {"nis", "nis + sign", "nis + window", "nis + window + sign"}, 40);
  const Random random(1, Stream{1'000'005});
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double d = UnitNoise(random, static_cast<std::int64_t>(i), 0.3).radar.range_m -
                     UnitNoise(random, static_cast<std::int64_t>(i), 0.3).lidar.range_m;
    EXPECT_NEAR(scores[i][0], d * d, 1e-12);
    EXPECT_NEAR(scores[i][1], d * std::abs(d), 1e-12);
    if (i < 2) continue;
    EXPECT_NEAR(scores[i][2], (scores[i][0] + scores[i - 1][0] + scores[i - 2][0]) / 3, 1e-12);
    EXPECT_NEAR(scores[i][3], (scores[i][1] + scores[i - 1][1] + scores[i - 2][1]) / 3, 1e-12);
  }
}

// The sensors' offset exceeds their noise here, as in paper.json. So the mean of absolute
// differences equals the mean of the differences themselves.
TEST(DetectorBankTest, TheDegreeOfConflictIsTheSigmoidOfADistanceWithWindowAndSign) {
  conflict::ConflictParameters parameters;
  parameters.offset_m = 20;
  parameters.doc_slope_pm = 0.5;
  parameters.doc_centre_m = 20;
  std::vector<std::size_t> detectors{study::DetectorNamed("doc"),
                                     study::DetectorNamed("distance + window + sign")};
  study::DetectorBank bank(parameters, detectors);
  const Random random(2, Stream{1'000'005});
  for (int i = 0; i < 50; ++i) {
    const auto scores = bank.Step(UnitNoise(random, i, parameters.offset_m));
    EXPECT_NEAR(scores[0],
                conflict::DegreeOfConflict(scores[1] + parameters.offset_m, parameters.doc_slope_pm,
                                           parameters.doc_centre_m),
                1e-12)
        << i;
  }
}

TEST(DetectorBankTest, ResetBringsBackTheFirstScores) {
  const std::vector<std::size_t> all = study::AllDetectors();
  study::DetectorBank bank(conflict::ConflictParameters(), all);
  const Random random(3, Stream{1'000'005});
  const auto first = bank.Step(UnitNoise(random, 0, 1));
  const std::vector<double> before(first.begin(), first.end());
  for (int i = 1; i < 30; ++i) bank.Step(UnitNoise(random, i, 1));
  bank.Reset();
  const auto again = bank.Step(UnitNoise(random, 0, 1));
  EXPECT_TRUE(std::ranges::equal(again, before));
}

}  // namespace
}  // namespace fogline
