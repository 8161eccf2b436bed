// Tests of the figures, files and texts that studies make of their runs.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tests/unit/tools/study/few_seeds.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/study.h"
#include "tools/study/thresholds/threshold_mix.h"

namespace fogline {
namespace {

using Rows = std::vector<std::map<std::string, std::string>>;

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ',');
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// The rows of a file of the study, by column.
Rows RowsOf(const study::StudyResult& result, std::string_view name) {
  const auto file = std::ranges::find(result.files, name, &study::StudyFile::name);
  std::istringstream lines(file->content);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> head = Split(line);
  Rows rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = Split(line);
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = cells.at(i);
  }
  return rows;
}

double NumberIn(const std::map<std::string, std::string>& row, const std::string& column) {
  return std::atof(row.at(column).c_str());
}

TEST(DriverStudyTest, ItsFigureHasEachDriverAtItsOwnVisibility) {
  const study::StudyContext context = test::FewSeeds(1, 2);
  const study::StudyResult result = study::RunDriverStudy(context);
  const study::StudyDesign design = study::DriverDesign();
  const study::Comparison comparison(context, design.cases, design.variants);
  const auto figure =
      std::ranges::find(result.section.figures, "driver-cs-visibility", &report::StudyFigure::id);
  ASSERT_NE(figure, result.section.figures.end());
  int points = 0;
  for (const report::StudySeries& series : figure->series) {
    const bool human = series.name == "human";
    for (std::size_t i = 0; i < series.x.size(); ++i, ++points) {
      const study::Cell cell{
          comparison.CaseNamed(
              fmt::format("{} at {:g} m", human ? "human" : "paper's driver", series.x[i])),
          comparison.VariantNamed(series.name == "without traded control" ? "none" : "traded")};
      EXPECT_EQ(series.y[i], comparison.Mean(cell, study::kShortfall).mean)
          << series.name << " at " << series.x[i] << " m";
    }
  }
  EXPECT_EQ(points, 3 * 7);
}

TEST(VehicleStudyTest, NamesTheHardestAccelerationOfAnyRun) {
  const study::StudyResult result = study::RunVehicleStudy(test::FewSeeds(1, 1));
  double hardest = 0;
  for (const auto& row : RowsOf(result, "vehicle.csv")) {
    if (row.at("measure") != "max_abs_acceleration_mps2") continue;
    hardest = std::max(hardest, NumberIn(row, "mean"));  // of one run, because there is one seed
  }
  ASSERT_GT(hardest, 0);
  EXPECT_NE(result.section.method.find(
                fmt::format("of a host in any of these runs is {:.1f} m/s2", hardest)),
            std::string::npos)
      << hardest;
}

TEST(ThresholdStudyTest, ItsDifferencesOfSafetyAreInMetresOfShortfall) {
  const study::StudyResult result = study::RunThresholdStudy(test::FewSeeds(1, 3));
  int compared = 0;
  for (const auto& row : RowsOf(result, "threshold.csv")) {
    if (row.at("compromised_minus_fixed").empty()) continue;
    ++compared;
    const double difference = NumberIn(row, "compromised_minus_fixed");
    EXPECT_NEAR(difference,
                NumberIn(row, "compromised_safety_fog_m") - NumberIn(row, "fixed_compromised_m"),
                1e-5 * (1 + std::abs(difference)))
        << row.at("member");
    EXPECT_GE(NumberIn(row, "fixed_compromised_m"), 0) << row.at("member");
    EXPECT_LE(NumberIn(row, "compromised_minus_fixed_ci95_low"),
              NumberIn(row, "compromised_minus_fixed_ci95_high"));
  }
  EXPECT_GT(compared, 5);
}

TEST(ThresholdStudyTest, AQuarterOfItsSituationsHasNoFog) {
  constexpr int kSituations = 400;
  const std::vector<std::string_view> rule{"fixed 0.5"};
  const study::MixedRuns mixed =
      study::RunMix(test::FewSeeds(1, kSituations), study::RulesNamed(rule),
                    study::MixedHuman::kDrawn, study::MixedRadar::kDrawn, {"/steps=250"});
  const auto clear = std::ranges::count_if(mixed.members.front().shortfall_m,
                                           [](double m) { return std::isnan(m); });
  // The number of situations without fog is binomial, with a standard deviation of 8.7. The
  // tolerance is four standard deviations.
  EXPECT_NEAR(static_cast<double>(clear), kSituations / 4.0, 4 * 8.7);
}

}  // namespace
}  // namespace fogline
