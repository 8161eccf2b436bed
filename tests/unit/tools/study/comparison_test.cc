#include "tools/study/comparison.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/tools/study/examples.h"

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
  // GIVEN four seeds: both collide; only one of them; none, with equal and with other safety
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

}  // namespace
}  // namespace fogline
