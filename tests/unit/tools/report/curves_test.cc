#include "tools/report/curves.h"

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/tools/report/example_curves.h"
#include "tests/unit/tools/report/example_runs.h"

namespace fogline {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Curves with these values in each row: threshold, SI, RHE.
report::ReportCurves CurvesOf(const std::vector<std::array<double, 3>>& rows) {
  report::ReportCurves curves;
  for (const auto& [threshold, si, rhe] : rows) {
    curves.points.push_back({threshold, ExampleSummary(si, 1), ExampleSummary(rhe, 1)});
  }
  return curves;
}

TEST(FrontPointsTest, ShareAPlaceWhereThresholdsAgree) {
  const std::vector<report::FrontPoint> points = report::FrontPoints(
      CurvesOf({{0.1, 100, 100}, {0.2, 100, 100}, {0.3, 100, 100}, {0.5, 80, 0}, {0.6, 100, 100}}));
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].thresholds, "0.5");
  EXPECT_EQ(points[1].thresholds, "0.1–0.3, 0.6");
  EXPECT_THAT(points[1].rows, ElementsAre(0, 1, 2, 4));
}

TEST(FrontPointsTest, SayWhichAreOnTheFront) {
  const std::vector<report::FrontPoint> points =
      report::FrontPoints(CurvesOf({{0.2, 100, 100}, {0.5, 80, 0}, {0.8, 10, 0}}));
  ASSERT_EQ(points.size(), 3U);  // in the order of RHE, then of SI
  EXPECT_FALSE(points[0].on_front);
  EXPECT_TRUE(points[1].on_front);
  EXPECT_TRUE(points[2].on_front);
}

TEST(FrontPointsTest, LeaveOutThresholdsWithoutSi) {
  report::ReportCurves curves = CurvesOf({{0.2, 100, 100}, {0.5, 80, 0}});
  curves.points[0].si_pct = {};
  EXPECT_EQ(report::FrontPoints(curves).size(), 1U);
  curves.points[1].si_pct = {};
  EXPECT_THAT(report::FrontPoints(curves), IsEmpty());
}

TEST(LabelOrderTest, PrefersTenthsAndManyThresholdsAndSkipsDominatedOthers) {
  const report::ReportCurves curves =
      CurvesOf({{0.1, 100, 90}, {0.15, 100, 90}, {0.3, 95, 9}, {0.35, 90, 0}, {0.45, 70, 0}});
  const std::vector<report::FrontPoint> points = report::FrontPoints(curves);
  std::vector<std::string> labels;
  for (const std::size_t i : report::LabelOrder(curves, points))
    labels.push_back(points[i].thresholds);
  EXPECT_THAT(labels, ElementsAre("0.1–0.15", "0.3", "0.35"));
}

TEST(CurvesDataTest, HasEveryValueAndNullWhereThereIsNone) {
  report::ReportCurves curves = ExampleCurves();
  curves.points[3].si_pct.ci95.reset();
  const json data = json::parse(report::CurvesData(curves));
  ASSERT_EQ(data["thresholds"].size(), 99U);
  EXPECT_EQ(data["thresholds"][49], 0.5);
  for (const char* measure : {"si", "rhe"}) {
    for (const char* value : {"mean", "deviation", "ci95", "p5", "p95"}) {
      EXPECT_EQ(data[measure][value].size(), 99U) << measure << " " << value;
    }
  }
  EXPECT_EQ(data["si"]["mean"][49], *curves.points[49].si_pct.mean);
  EXPECT_TRUE(data["si"]["ci95"][3].is_null());
  EXPECT_EQ(data["published"][1]["si"], 80.79);
}

TEST(MakeReportWithCurvesTest, HasBothFiguresAndAllValues) {
  const std::string page = report::MakeReport(ExampleRuns(10), ExampleTable(), ExampleCurves());
  EXPECT_THAT(page, HasSubstr("<figure id=\"thresholds\""));
  EXPECT_THAT(page, HasSubstr("<figure id=\"front\""));
  EXPECT_THAT(page, HasSubstr("99 thresholds over seeds 1 to 200"));
  for (const report::ReportCurves::Point& point : ExampleCurves().points) {
    EXPECT_THAT(page,
                HasSubstr(fmt::format("<th scope=\"row\"><data value=\"{}\">", point.threshold)));
  }
}

TEST(MakeReportWithCurvesTest, SaysWhichBandIsWhich) {
  const std::string page = report::MakeReport({}, {}, ExampleCurves());
  EXPECT_THAT(page, HasSubstr("Dark bands: 95 % confidence intervals of the means"));
  EXPECT_THAT(page, HasSubstr("Light bands: from the 5th to the 95th percentile of the seeds."));
}

TEST(MakeReportWithCurvesTest, SaysHowManySeedsHaveNoSi) {
  report::ReportCurves curves = ExampleCurves();
  EXPECT_THAT(report::MakeReport({}, {}, curves), Not(HasSubstr("have no SI")));
  for (report::ReportCurves::Point& point : curves.points) point.si_pct.count = 187;
  EXPECT_THAT(report::MakeReport({}, {}, curves), HasSubstr("13 of the 200 seeds have no SI"));
}

TEST(MakeReportWithCurvesTest, NeedsNoRun) {
  const std::string page = report::MakeReport({}, {}, ExampleCurves());
  EXPECT_THAT(page, HasSubstr("<title>Traded control in fog · Fogline report</title>"));
  EXPECT_THAT(page, HasSubstr("<section id=\"figures\" hidden"));
}

TEST(MakeReportWithCurvesTest, HasNoSuchSectionWithoutCurves) {
  const std::string page = report::MakeReport(ExampleRuns(10), ExampleTable());
  EXPECT_THAT(page, Not(HasSubstr("<section id=\"curves\"")));
  EXPECT_THAT(page, HasSubstr("\"curves\":null"));
}

TEST(MakeReportWithCurvesTest, EscapesTheTitleOfTheScenario) {
  report::ReportCurves curves = ExampleCurves();
  curves.scenario_title = "<img src=x>";
  EXPECT_THAT(report::MakeReport({}, {}, curves), Not(HasSubstr("<img")));
}

}  // namespace
}  // namespace fogline
