#include "tools/study/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tools/study/examples.h"
#include "tests/unit/tools/study/few_seeds.h"

namespace fogline {
namespace {

/// A comparison of `none` and `traded` in which some runs of `traded` end in a collision.
/// rms_jerk_mps3 differs in each pair. In a pair without a collision all other measures are equal.
study::Comparison WithCrashes(std::int64_t crashes) {
  const std::size_t measures = study::ComparedMetrics().size();
  std::vector<double> values(2 * measures * kSeeds, 0.0);
  const auto set = [&](std::size_t variant, std::string_view measure, auto value_of) {
    const std::size_t row = variant * measures + study::PlaceOfMetric(measure);
    for (std::int64_t seed = 0; seed < kSeeds; ++seed) {
      values[row * kSeeds + static_cast<std::size_t>(seed)] = value_of(seed);
    }
  };
  const auto crashed = [&](std::int64_t seed) { return seed < crashes; };
  set(0, "steps", [](std::int64_t) { return 500.0; });
  set(1, "steps", [&](std::int64_t seed) { return crashed(seed) ? 100.0 : 500.0; });
  set(1, "collided", [&](std::int64_t seed) { return crashed(seed) ? 1.0 : 0.0; });
  set(1, "rms_jerk_mps3", [](std::int64_t seed) { return 1 + 0.1 * static_cast<double>(seed); });
  return {{{"fog", "paper.json", {}}}, {{"none", {}}, {"traded", {}}}, kSeeds, values};
}

/// The cells of a measure's row for `traded`, by column.
std::map<std::string, std::string> RowOf(const std::string& csv, const std::string& measure) {
  std::istringstream lines(csv);
  std::string head;
  std::getline(lines, head);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("fog,traded," + measure + ',')) continue;
    std::istringstream names(head);
    std::istringstream cells(line + ',');
    std::map<std::string, std::string> row;
    for (std::string name, cell; std::getline(names, name, ',');) {
      std::getline(cells, cell, ',');
      row[name] = cell;
    }
    return row;
  }
  return {};
}

TEST(ComparisonTest, ComparesCollisionsByTheExactTestOfMcNemar) {
  auto row = RowOf(WithCrashes(6).Csv(0), "collided");
  EXPECT_EQ(row["difference"], "0.3");
  EXPECT_EQ(row["p"], "0.03125");
  EXPECT_EQ(row["p_holm"], "0.03125") << "the only test of the file";
}

TEST(ComparisonTest, GivesCollisionsAnIntervalOfSharesAndLeavesTheirCodeOut) {
  const auto interval = [](std::int64_t crashes) {
    auto row = RowOf(WithCrashes(crashes).Csv(0), "collided");
    return std::pair(std::stod(row["difference_ci95_low"]), std::stod(row["difference_ci95_high"]));
  };
  EXPECT_LT(interval(kSeeds).first, 1);
  EXPECT_EQ(interval(kSeeds).second, 1);
  EXPECT_LT(interval(0).first, interval(0).second);
  EXPECT_THROW(study::PlaceOfMetric("collision"), std::out_of_range);
}

TEST(ComparisonTest, GivesNoOtherPValueIfRunsEndEarly) {
  const study::Comparison comparison = WithCrashes(6);
  auto row = RowOf(comparison.Csv(0), "rms_jerk_mps3");
  EXPECT_EQ(row["difference"], "1.95");
  EXPECT_EQ(row["difference_cut_short"], "6");
  EXPECT_EQ(row["p"], "");
  EXPECT_EQ(row["p_holm"], "");
  EXPECT_EQ(comparison.Comparisons(0), 1);
}

TEST(ComparisonTest, TestsEveryMeasureOfWholeRuns) {
  const study::Comparison comparison = WithCrashes(0);
  const std::string csv = comparison.Csv(0);
  auto row = RowOf(csv, "rms_jerk_mps3");
  EXPECT_EQ(row["difference_cut_short"], "0");
  EXPECT_LT(std::stod(row["p"]), 0.001);
  EXPECT_GE(std::stod(row["p_holm"]), std::stod(row["p"]));
  EXPECT_EQ(RowOf(csv, "collided")["p"], "1");
  EXPECT_EQ(comparison.Comparisons(0), static_cast<std::int64_t>(study::ComparedMetrics().size()));
}

TEST(ComparisonTest, ARunThatCollidesIsLessSafeThanOneThatDoesNot) {
  // GIVEN four seeds. With the first seed both runs collide, with the second seed one run. The runs
  // of the third seed have equal safety, and the runs of the fourth seed have different safety
  const std::size_t measures = study::ComparedMetrics().size();
  std::vector<double> values(2 * measures * 4, 0.0);
  const auto set = [&](std::size_t variant, std::string_view measure, std::array<double, 4> of) {
    const std::size_t row = variant * measures + study::PlaceOfMetric(measure);
    std::ranges::copy(of, values.begin() + static_cast<std::ptrdiff_t>(row * 4));
  };
  set(0, "collided", {1, 0, 0, 0});
  set(1, "collided", {1, 1, 0, 0});
  set(0, "mean_compromised_safety_fog_m", {0.1, 0.9, 0.2, 0.3});
  set(1, "mean_compromised_safety_fog_m", {0.4, 0.1, 0.2, 0.1});
  const study::Comparison comparison({{"fog", "paper.json", {}}}, {{"none", {}}, {"traded", {}}}, 4,
                                     values);
  EXPECT_EQ(comparison.LessSafe({0, 0}, {0, 1}), (std::vector<double>{0, 0, 0, 1}));
  EXPECT_EQ(comparison.LessSafe({0, 1}, {0, 0}), (std::vector<double>{0, 1, 0, 0}));
}

TEST(ComparisonTest, CountsAPairOfDifferentlyLongRunsAsCutShort) {
  const std::size_t measures = study::ComparedMetrics().size();
  std::vector<double> values(2 * measures * kSeeds, 0.0);
  const auto steps_of = [&](std::size_t variant) {
    const std::size_t row = variant * measures + study::PlaceOfMetric("steps");
    return std::span(values).subspan(row * kSeeds, kSeeds);
  };
  std::ranges::fill(steps_of(0), 500.0);
  std::ranges::fill(steps_of(1), 500.0);
  steps_of(1)[3] = 499;
  const study::Comparison comparison({{"fog", "paper.json", {}}}, {{"none", {}}, {"traded", {}}},
                                     kSeeds, values);
  EXPECT_EQ(comparison.PairsCutShort({0, 0}, {0, 1}), 1);
  EXPECT_EQ(comparison.PairsCutShort({0, 0}, {0, 0}), 0);
}

// Each run is paired with the run without traded control of the same case.
TEST(ComparisonTest, HasInEachCaseTheRunsOfThisCaseAlone) {
  const std::vector<std::string> early{"/fog/start_s=5", "/steps=200"};
  const std::vector<std::string> denser{"/fog/start_s=5", "/steps=200", "/fog/bias_m=0.4"};
  const std::vector<study::StudyCase> cases{{"early", "paper.json", early},
                                            {"denser", "paper.json", denser}};
  const std::vector<study::StudyVariant> variants{{"none", {"/arbitrator/policy=none"}},
                                                  {"traded", {"/arbitrator/policy=traded"}}};
  const study::StudyContext context = test::FewSeeds(4, 6);
  const study::Comparison both(context, cases, variants);
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const study::Comparison alone(context, {cases[c]}, variants);
    for (std::size_t v = 0; v < variants.size(); ++v) {
      for (const std::string_view measure :
           {"si_pct", "mean_compromised_safety_fog_m", "max_doc"}) {
        const auto expected = alone.Values({0, v}, measure);
        const auto values = both.Values({c, v}, measure);
        for (std::size_t seed = 0; seed < 3; ++seed) {
          const bool both_missing = std::isnan(values[seed]) && std::isnan(expected[seed]);
          EXPECT_TRUE(both_missing || values[seed] == expected[seed]) << c << v << measure << seed;
        }
      }
    }
  }
  EXPECT_NE(both.Values({0, 1}, "max_doc")[0], both.Values({1, 1}, "max_doc")[0]);
}

}  // namespace
}  // namespace fogline
