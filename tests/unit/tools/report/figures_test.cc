#include "tools/report/figures.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/tools/report/example_runs.h"
#include "tools/report/assets.h"

namespace fogline {
namespace {

metrics::Sample At(double time_s, double lambda_human, bool fog) {
  metrics::Sample sample;
  sample.time_s = time_s;
  sample.lambda_human = lambda_human;
  sample.fog_present = fog;
  return sample;
}

TEST(FiguresTest, DrawOnlyColumnsThatExistAndColoursOfThePalette) {
  for (const report::Figure& figure : report::Figures()) {
    for (const report::Curve& curve : figure.curves) {
      EXPECT_NO_THROW(report::ColumnNamed(curve.column)) << figure.id;
      EXPECT_LT(static_cast<std::size_t>(curve.colour), report::kPaletteSize) << curve.label;
    }
  }
}

TEST(FiguresTest, ShadeBetweenCurvesOfTheirOwn) {
  for (const report::Figure& figure : report::Figures()) {
    if (figure.shade.below.empty()) continue;
    for (const std::string_view column : {figure.shade.below, figure.shade.limit}) {
      EXPECT_NE(std::ranges::find(figure.curves, column, &report::Curve::column),
                figure.curves.end())
          << figure.id << ": " << column;
    }
  }
}

TEST(FiguresTest, LeaveNoColumnUndrawn) {
  std::set<std::string_view> drawn{"time_s"};
  for (const report::Figure& figure : report::Figures()) {
    for (const report::Curve& curve : figure.curves) drawn.insert(curve.column);
  }
  EXPECT_EQ(drawn.size(), report::kColumns.size());
}

TEST(FiguresTest, TellTheCurvesOfAFigureApartByColourAndByDash) {
  for (const report::Figure& figure : report::Figures()) {
    std::set<int> colours;
    std::set<report::Dash> dashes;
    for (const report::Curve& curve : figure.curves) {
      EXPECT_TRUE(colours.insert(curve.colour).second) << figure.id << ": " << curve.label;
      EXPECT_TRUE(dashes.insert(curve.dash).second) << figure.id << ": " << curve.label;
    }
  }
}

TEST(FiguresTest, HaveThePaletteOfThePage) {
  for (std::size_t i = 0; i < report::kPaletteSize; ++i) {
    const std::string rule = fmt::format("--p{}: {};", i, report::kPalette[i]);
    EXPECT_NE(report::assets::kPageCss.find(rule), std::string_view::npos) << rule;
  }
}

TEST(RunStyleTest, TellsTwentyFourRunsApartByClassesOfThePage) {
  std::set<std::string> styles;
  for (std::size_t i = 0; i < 24; ++i) EXPECT_TRUE(styles.insert(report::RunStyle(i)).second) << i;
  EXPECT_EQ(report::RunStyle(7), "c7 r0");
  EXPECT_EQ(report::RunStyle(8), "c0 r1");
  for (const char* rule : {".c7 {", ".r0 {", ".r1 {", ".r2 {"}) {
    EXPECT_NE(report::assets::kPageCss.find(rule), std::string_view::npos) << rule;
  }
}

TEST(ColumnNamedTest, RefusesAnUnknownName) {
  EXPECT_THROW(report::ColumnNamed("speed"), std::out_of_range);
}

TEST(HostJerkTest, IsTheChangeOfAccelerationPerSecond) {
  std::vector<metrics::Sample> samples{At(0.0, 0, false), At(0.1, 0, false), At(0.2, 0, false)};
  samples[1].host_acceleration_mps2 = 0.5;
  samples[2].host_acceleration_mps2 = 0.25;
  EXPECT_TRUE(std::isnan(report::HostJerk(samples, 0)));
  EXPECT_NEAR(report::HostJerk(samples, 1), 5.0, 1e-12);
  EXPECT_NEAR(report::HostJerk(samples, 2), -2.5, 1e-12);
}

TEST(FogWindowsTest, LastUntilTheStepWithoutFog) {
  const report::ReportRun run = ExampleRun({.threshold = 0.5});
  const std::vector<report::Window> windows = report::FogWindows(run.samples);
  ASSERT_EQ(windows.size(), 1U);
  EXPECT_DOUBLE_EQ(windows[0].begin_s, 19.0);
  EXPECT_DOUBLE_EQ(windows[0].end_s, 30.0);
}

TEST(HumanWindowsTest, LastWhileTheHumanHasAnyAuthorityOrUntilTheEnd) {
  const std::vector<metrics::Sample> samples{At(0.0, 1.0, false), At(0.1, 0.0, false),
                                             At(0.2, 0.01, false), At(0.3, 0.6, false)};
  const std::vector<report::Window> windows = report::HumanWindows(samples);
  ASSERT_EQ(windows.size(), 2U);
  EXPECT_EQ(windows[0].begin_s, 0.0);
  EXPECT_EQ(windows[0].end_s, 0.1);
  EXPECT_EQ(windows[1].begin_s, 0.2);
  EXPECT_EQ(windows[1].end_s, 0.3);
}

TEST(HumanWindowsTest, AreNoneInARunWithoutSamples) {
  EXPECT_TRUE(report::HumanWindows({}).empty());
}

}  // namespace
}  // namespace fogline
