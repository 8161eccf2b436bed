// The curves of the report in a real browser.
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/campaign/browser/browser.h"
#include "tests/unit/tools/report/example_curves.h"
#include "tests/unit/tools/report/example_runs.h"
#include "tools/report/report.h"

namespace fogline {
namespace {

using nlohmann::json;
using ::testing::Each;
using ::testing::SizeIs;

using CurvesInBrowserTest = BrowserTest;

TEST_F(CurvesInBrowserTest, DrawsTheCurvesWithRunsAndWithout) {
  const std::string_view look = R"(
    found.drawn = curveCanvases().map(isDrawn);
    found.figures = document.getElementById("figures").checkVisibility();
    found.values = [...document.querySelectorAll("#curves .legend td")].map((cell) => cell.textContent);
    found.reading = document.querySelector("#front .reading").textContent;)";
  const json both =
      Show(report::MakeReport(ExampleRuns(50), ExampleTable(), ExampleCurves()), kDesktop, look);
  const json alone = Show(report::MakeReport({}, {}, ExampleCurves()), kDesktop, look);
  for (const json& found : {both, alone}) {
    EXPECT_THAT(found["problems"], SizeIs(0)) << found;
    EXPECT_EQ(found["drawn"], json::parse("[true, true]"));
    EXPECT_THAT(found["values"], Each(::testing::Ne("")));
    EXPECT_EQ(found["reading"], "Threshold 0.5: SI 55.56 %, RHE 0.00 %, on the front");
  }
  EXPECT_EQ(both["figures"], true);
  EXPECT_EQ(alone["figures"], false);
}

TEST_F(CurvesInBrowserTest, PointsAtTheSameThresholdInBothFigures) {
  const json found = Show(report::MakeReport({}, {}, ExampleCurves()), kDesktop, R"(
    const [{chart: byThreshold}, {chart: front}] = curvePage.charts;
    mouse("mousemove", byThreshold.over, byThreshold.valToPos(0.7, "x"));
    await settled();
    found.byThreshold = [curvePage.text.textContent, document.querySelector(".spot").textContent];
    mouse("mousemove", front.over, front.valToPos(100, "x"), front.valToPos(100, "y"));
    await settled();
    found.byFront = [curvePage.text.textContent, document.querySelector(".spot").textContent];
    curvePage.slider.value = 49;
    curvePage.slider.dispatchEvent(new Event("input"));
    await settled();
    found.bySlider = [byThreshold.posToVal(byThreshold.cursor.left, "x").toFixed(2),
                      document.querySelector(".spot").textContent];)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["byThreshold"], json::parse(R"(["0.7", "0.7"])"));
  EXPECT_EQ(found["byFront"], json::parse(R"(["0.01", "0.01–0.2"])"));
  EXPECT_EQ(found["bySlider"], json::parse(R"(["0.50", "0.5"])"));
}

TEST_F(CurvesInBrowserTest, LooksCloserAtCurvesByDraggingAndBack) {
  const json found = Show(report::MakeReport({}, {}, ExampleCurves()), kDesktop, R"(
    const {chart} = curvePage.charts[1];
    const span = () => [chart.scales.x.min, chart.scales.x.max];
    found.before = span();
    mouse("mousemove", chart.over, 50);
    mouse("mousedown", chart.over, 50);
    mouse("mousemove", chart.over, 150);
    mouse("mouseup", chart.over, 150);
    await settled();
    found.closer = span();
    found.can = !curvePage.whole.disabled;
    found.drawn = curveCanvases().map(isDrawn);
    click("#whole-curves");
    await settled();
    found.after = span();
    found.cannot = curvePage.whole.disabled;)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_GT(found["closer"][0], found["before"][0]);
  EXPECT_LT(found["closer"][1], found["before"][1]);
  EXPECT_EQ(found["after"], found["before"]);
  EXPECT_EQ(found["can"], true);
  EXPECT_EQ(found["cannot"], true);
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(CurvesInBrowserTest, HidesAMeasureWithItsBandsAndShowsItAgain) {
  const json found = Show(report::MakeReport({}, {}, ExampleCurves()), kDesktop, R"(
    const counts = () => [curvePage.charts[0].chart.series.length, curvePage.charts[0].chart.bands.length];
    found.before = counts();
    click("#thresholds .legend button");
    await settled();
    found.hidden = counts();
    found.focus = document.activeElement.textContent;
    click("#thresholds .legend button");
    await settled();
    found.again = counts();)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  // counts() returns the numbers of series and of bands. The 11 series are the threshold, 2 means,
  // and the 2 edges of each band. Each mean has 2 bands.
  EXPECT_EQ(found["before"], json::parse("[11, 4]"));
  EXPECT_EQ(found["hidden"], json::parse("[6, 2]"));
  EXPECT_EQ(found["again"], found["before"]);
  EXPECT_EQ(found["focus"], "SI");
}

TEST_F(CurvesInBrowserTest, FitsCurvesOnAPhone) {
  const json found =
      Show(report::MakeReport(ExampleRuns(50), ExampleTable(), ExampleCurves()), kPhone, R"(
    document.querySelectorAll("details").forEach((element) => { element.open = true; });
    await settled();
    found.width = document.documentElement.scrollWidth;
    found.charts = curvePage.charts.map(({chart}) => chart.width);
    found.drawn = curveCanvases().map(isDrawn);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_LE(found["width"], kPhone.width);
  EXPECT_THAT(found["charts"], Each(::testing::Le(kPhone.width)));
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(CurvesInBrowserTest, DrawsTheCurvesInTheColoursOfDarkAndPaper) {
  const json found = Show(report::MakeReport({}, {}, ExampleCurves()), kDesktop, R"(
    const colour = () => curvePage.charts[0].chart.series.at(-2).stroke();
    found.colours = [colour()];
    dispatchEvent(new Event("beforeprint"));
    found.colours.push(colour());
    dispatchEvent(new Event("afterprint"));
    found.colours.push(colour());)",
                          Scheme::kDark);
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["colours"], json::parse(R"(["#4794f5", "#0059a1", "#4794f5"])"));
}

TEST_F(CurvesInBrowserTest, ShowsCurvesOfOneThresholdOrWithoutSiWithoutAnError) {
  report::ReportCurves curves = ExampleCurves();
  curves.published.clear();
  for (report::ReportCurves::Point& point : curves.points) point.si_pct = {};
  const json no_si = Show(report::MakeReport({}, {}, curves), kDesktop, "");
  EXPECT_THAT(no_si["problems"], SizeIs(0)) << no_si;
  curves.points = {ExampleCurves().points[49]};
  const json one = Show(report::MakeReport({}, {}, curves), kDesktop, "");
  EXPECT_THAT(one["problems"], SizeIs(0)) << one;
}

}  // namespace
}  // namespace fogline
