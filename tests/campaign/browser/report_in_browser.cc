// The report of runs in a real browser: it draws its figures, stays within the width of a phone,
// and responds to the reader.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/campaign/browser/browser.h"
#include "tests/unit/tools/report/example_runs.h"
#include "tools/report/figures.h"
#include "tools/report/report.h"

namespace fogline {
namespace {

using nlohmann::json;
using ::testing::Each;
using ::testing::SizeIs;

class ReportInBrowserTest : public BrowserTest {
 protected:
  json Show(std::span<const report::ReportRun> runs, ViewSize window, std::string_view script,
            Scheme scheme = Scheme::kLight) {
    return BrowserTest::Show(report::MakeReport(runs, ExampleTable()), window, script, scheme);
  }
};

TEST_F(ReportInBrowserTest, DrawsEveryFigureAndLoadsNothing) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    found.drawn = canvases().map(isDrawn);
    found.values = [...document.querySelectorAll(".legend td")].map((cell) => cell.textContent);
    found.names = [...document.querySelectorAll("[role=img]")].map((e) => e.ariaLabel);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["loaded"], 0);
  EXPECT_THAT(found["drawn"], SizeIs(4 * report::Figures().size()));
  EXPECT_THAT(found["drawn"], Each(true));
  EXPECT_THAT(found["values"], Each(::testing::Ne("")));
  EXPECT_THAT(found["names"][0].get<std::string>(),
              ::testing::StartsWith("Figure 1, Speeds of the three cars: without"));
}

TEST_F(ReportInBrowserTest, GivesEachRunAPanelSideBySideAtFirst) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    found.drawn = canvases().map(isDrawn);
    const spans = page.charts.slice(0, 4).map(({scales: {y: {min, max}}}) => [min, max].join());
    found.spans = new Set(spans).size;)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_THAT(found["drawn"], SizeIs(4 * report::Figures().size()));
  EXPECT_THAT(found["drawn"], Each(true));
  EXPECT_EQ(found["spans"], 1) << "panels of a figure are compared, so they share their axis";
}

/// Runs in which all cars keep 20 m/s. The axis of speeds then has its shortest span.
std::vector<report::ReportRun> SteadyRuns() {
  std::vector<report::ReportRun> runs = ExampleRuns();
  for (report::ReportRun& run : runs) {
    for (metrics::Sample& sample : run.samples) {
      sample.preceding_speed_mps = sample.host_speed_mps = sample.follower_speed_mps = 20;
    }
  }
  return runs;
}

TEST_F(ReportInBrowserTest, SaysIfAnAxisSpansLessThanAHundredthOfTheValueAndOffersTheWholeAxis) {
  const json found = Show(SteadyRuns(), kDesktop, R"(
    const notes = (figure) => [...document.querySelectorAll(`#${figure} .span-note`)]
        .filter((note) => !note.hidden).map((note) => note.querySelector("span").textContent);
    const axes = () => page.charts.slice(0, 4).map(({scales: {y: {min, max}}}) => [min, max]);
    found.notes = notes("speeds");
    found.others = notes("accelerations");
    found.fitted = axes()[0];
    const boxes = () => document.querySelectorAll("#speeds .span-note input");
    found.named = boxes()[1].ariaLabel;
    found.described = boxes()[1].closest("p").id ===
        document.querySelectorAll("#speeds .chart")[1].getAttribute("aria-describedby");
    // A reader reaches the box with the keyboard, and presses the space bar.
    boxes()[1].focus();
    found.focused = document.activeElement === boxes()[1];
    boxes()[1].click();
    await settled();
    found.stays = document.activeElement === boxes()[1];
    found.checked = [...boxes()].map((box) => box.checked);
    found.whole = axes();
    found.says = notes("speeds");
    // The boxes stay checked when the reader changes the view of the runs and the time span.
    click("[value=overlaid]");
    await settled();
    click("[value=apart]");
    setSpan([10, 20]);
    await settled();
    found.kept = [...boxes()].map((box) => box.checked);
    found.zoomed = axes()[2];
    boxes()[0].click();
    await settled();
    found.back = axes()[3];
    found.again = notes("speeds");)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  const std::string note = "axis spans 0.56 % of the value";
  EXPECT_EQ(found["notes"], json::array({note, note, note, note}));
  EXPECT_THAT(found["others"], SizeIs(0));
  EXPECT_EQ(found["named"], "Value axes of figure 1 from zero");
  EXPECT_EQ(found["described"], true);
  EXPECT_EQ(found["focused"], true);
  EXPECT_EQ(found["stays"], true);
  EXPECT_NEAR(found["fitted"][1].get<double>() - found["fitted"][0].get<double>(), 0.112, 1e-9);
  EXPECT_THAT(found["checked"], Each(true));
  EXPECT_THAT(found["whole"], Each(json::array({0, 1.06 * 20})));
  EXPECT_THAT(found["says"], Each("axis from zero"));
  EXPECT_THAT(found["kept"], Each(true));
  EXPECT_EQ(found["zoomed"], json::array({0, 1.06 * 20}));
  EXPECT_EQ(found["back"], found["fitted"]);
  EXPECT_EQ(found["again"], found["notes"]);
}

TEST_F(ReportInBrowserTest, ShowsEverySensorAtFirst) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    const buttons = [...document.querySelectorAll(".legend button")];
    found.pressed = buttons.map((button) => button.getAttribute("aria-pressed"));
    found.curves = panelCurves(report.figures[1], [state.runs[0]]).map(({curve}) => curve.label);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_THAT(found["pressed"], Each("true"));
  EXPECT_EQ(found["curves"],
            json::parse(R"(["radar", "LiDAR", "fused", "true gap", "safe distance"])"));
}

TEST_F(ReportInBrowserTest, OffersWhatItHidesWhereRunsAreOverlaidAsAnEmptyBox) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    click("[value=overlaid]");
    await settled();
    const boxes = () => [...document.querySelectorAll("#host-gap .legend button")];
    const look = (button) => [button.getAttribute("aria-pressed"),
                              getComputedStyle(button).textDecorationLine,
                              getComputedStyle(button, "::before").content];
    found.hidden = look(boxes()[1]);
    found.shown = look(boxes()[3]);
    boxes()[1].click();
    await settled();
    found.clicked = look(boxes()[1]);
    found.curves = panelCurves(report.figures[1], state.runs).map(({curve}) => curve.label);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["hidden"], json::parse(R"(["false", "none", "\"\""])"));
  EXPECT_EQ(found["shown"], json::parse(R"(["true", "none", "\"\u2713\""])"));
  EXPECT_EQ(found["clicked"], found["shown"]);
  EXPECT_THAT(found["curves"].get<std::vector<std::string>>(), ::testing::Contains("LiDAR"));
}

TEST_F(ReportInBrowserTest, DrawsNoisyFiguresInAStripForEachRunWhereTheOthersAreOverlaid) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    click("[value=overlaid]");
    await settled();
    found.panels = report.figures.map(({id}) => document.querySelectorAll(`#${id} .chart`).length);
    found.drawn = canvases().map(isDrawn);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["panels"], json::parse("[1, 1, 1, 1, 4, 4]"));
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(ReportInBrowserTest, DrawsTwentyFourRunsInDifferentLines) {
  const std::vector<report::ReportRun> runs(24, ExampleRun({.threshold = 0.5, .steps = 20}));
  std::vector<report::ReportRun> different = runs;
  for (std::size_t i = 0; i < different.size(); ++i) {
    for (metrics::Sample& sample : different[i].samples)
      sample.host_speed_mps += static_cast<double>(i);
  }
  const json found = Show(different, kDesktop, R"(
    click("[value=overlaid]");
    await settled();
    const looks = (lines) => lines.map(({stroke, width}) => `${stroke} ${width}`).join();
    const host = report.figures[0].curves[1];
    found.lines = new Set(state.runs.map((run) => looks(runLines(run, host, 1)))).size;
    const dot = (element) => getComputedStyle(element).backgroundImage;
    found.dots = new Set([...document.querySelectorAll("#measures .dot")].map(dot)).size;
    found.drawn = canvases().map(isDrawn);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["lines"], 24);
  EXPECT_EQ(found["dots"], 24);
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(ReportInBrowserTest, SaysOfATableThatItGoesOnToTheRightUntilItsEnd) {
  constexpr std::string_view kLook = R"(
    const table = document.querySelector("#measures .scroll");
    const look = () => [getComputedStyle(table).boxShadow !== "none",
                        getComputedStyle(table, "::after").content.includes("Scroll sideways") &&
                        getComputedStyle(table, "::after").visibility === "visible"];
    found.first = look();
    table.scrollLeft = 1e6;
    await settled();
    found.last = look();)";
  const json phone = Show(ExampleRuns(50), kPhone, kLook);
  EXPECT_THAT(phone["problems"], SizeIs(0)) << phone;
  EXPECT_EQ(phone["first"], json::parse("[true, true]"));
  EXPECT_EQ(phone["last"], json::parse("[false, false]"));
  const json desktop = Show(ExampleRuns(50), kDesktop, kLook);
  EXPECT_EQ(desktop["first"], json::parse("[false, false]"));
}

TEST_F(ReportInBrowserTest, PointsAtTheSameTimeInEveryFigure) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    pointer(0, 50);
    await settled();
    found.time = state.time;
    found.cursors = page.charts.map((chart) => chart.posToVal(chart.cursor.left, "x"));
    found.slider = Number(page.slider.value);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  const double time_s = found["time"];
  EXPECT_GT(time_s, 5.0);
  EXPECT_LT(time_s, 19.0);
  EXPECT_NEAR(found["slider"].get<double>(), time_s, 0.051);  // half a step
  for (const json& cursor : found["cursors"]) {
    EXPECT_NEAR(cursor.get<double>(), time_s, 0.25);  // a pixel
  }
}

TEST_F(ReportInBrowserTest, ShowsTheValuesOfTheTimeOfTheSlider) {
  std::vector<report::ReportRun> runs = ExampleRuns();
  runs[1].samples[123].host_speed_mps = -12.3456;
  const json found = Show(runs, kDesktop, R"(
    page.slider.value = 12.3;
    page.slider.dispatchEvent(new Event("input"));
    await settled();
    const row = document.querySelectorAll("#speeds .legend tbody tr")[1];
    found.row = row.innerText;)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_THAT(found["row"].get<std::string>(), ::testing::HasSubstr("\u221212.346"));
}

TEST_F(ReportInBrowserTest, ZoomsEveryFigureByDraggingAndBack) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    const {over} = page.charts[2];
    const span = () => page.charts.map(({scales: {x: {min, max}}}) => [min, max]);
    mouse("mousemove", over, 40);
    mouse("mousedown", over, 40);
    mouse("mousemove", over, 120);
    mouse("mouseup", over, 120);
    await settled();
    found.zoomed = span();
    found.drawn = canvases().map(isDrawn);
    click("#whole");
    await settled();
    found.whole = span();)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  const json first = found["zoomed"][0];
  EXPECT_GT(first[0].get<double>(), 5.0);
  EXPECT_LT(first[1].get<double>(), 40.0);
  EXPECT_THAT(found["zoomed"], Each(first));
  EXPECT_THAT(found["whole"], Each(json::parse("[0.0, 49.9]")));
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(ReportInBrowserTest, FollowsTheRunSelectorDownToNoRun) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    found.counts = [];
    for (const box of document.querySelectorAll("#runs input")) {
      box.click();
      await settled();
      found.counts.push(canvases().length);
      found.rows = document.querySelectorAll("#speeds .legend thead th").length;
    })");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["counts"], json::parse("[18, 12, 6, 0]"));
  EXPECT_EQ(found["rows"], 1);
}

TEST_F(ReportInBrowserTest, HidesACurveAndShowsItAgain) {
  const json found = Show(ExampleRuns(), kDesktop, R"(
    const series = () => page.charts[4 * 3].series.length - 1;  // of the first run in figure 4
    found.before = series();
    click("#follower-gap .legend button");
    await settled();
    found.after = series();
    found.focus = document.activeElement.textContent;)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["before"], 2);  // the lines gap and safe distance
  EXPECT_EQ(found["after"], 1);
  EXPECT_EQ(found["focus"], "gap");
}

TEST_F(ReportInBrowserTest, FitsAPhoneInEveryView) {
  const json found = Show(ExampleRuns(), kPhone, R"(
    const width = () => document.documentElement.scrollWidth;
    document.querySelectorAll("details").forEach((element) => { element.open = true; });
    found.viewport = innerWidth;
    found.widths = [width()];
    found.drawn = canvases().map(isDrawn);
    click("[value=overlaid]");
    await settled();
    found.widths.push(width());
    found.charts = page.charts.map((chart) => chart.width);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["viewport"], kPhone.width);
  EXPECT_THAT(found["widths"], Each(::testing::Le(kPhone.width)));
  EXPECT_THAT(found["charts"], Each(::testing::Le(kPhone.width)));
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(ReportInBrowserTest, FitsAPhoneWithLongNames) {
  std::vector<report::ReportRun> runs = ExampleRuns(50);
  for (report::ReportRun& run : runs) {
    run.name = run.scenario_title = std::string(200, 'x');
    run.measures = {{std::string(200, 'y'), 1.5, "m", std::string(200, 'z')}};
  }
  const json found = Show(runs, kPhone, "found.width = document.documentElement.scrollWidth;");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_LE(found["width"], kPhone.width);
}

TEST_F(ReportInBrowserTest, ResizesTheChartsWithTheWindow) {
  const json found = Show(ExampleRuns(50), kDesktop, R"(
    found.before = page.charts[0].width;
    document.querySelector("main").style.maxWidth = "420px";
    await settled();
    found.after = page.charts[0].width;)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_LT(found["before"], 300) << "four columns";
  EXPECT_GT(found["after"], 300) << "one column in 420 pixels";
}

TEST_F(ReportInBrowserTest, IsDarkWhereTheReaderLikesItDarkAndWhiteOnPaper) {
  const json found = Show(ExampleRuns(50), kDesktop, R"(
    found.screen = [getComputedStyle(document.body).backgroundColor, state.theme.ink];
    dispatchEvent(new Event("beforeprint"));
    found.paper = [getComputedStyle(document.documentElement).backgroundColor, state.theme.ink];
    dispatchEvent(new Event("afterprint"));
    found.again = state.theme.ink;)",
                          Scheme::kDark);
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["screen"], json::parse(R"json(["rgb(17, 21, 26)", "#e4e8ec"])json"));
  EXPECT_EQ(found["paper"], json::parse(R"json(["rgb(255, 255, 255)", "#1b2127"])json"));
  EXPECT_EQ(found["again"], "#e4e8ec");
}

TEST_F(ReportInBrowserTest, TakesTextOfARunForTextOnly) {
  std::vector<report::ReportRun> runs = ExampleRuns(20);
  const std::string evil =
      "</script><script>window.taken = true</script>\"><img src=x onerror='taken=1'>";
  for (report::ReportRun& run : runs) run.name = run.scenario_title = run.digest = evil;
  const json found = Show(runs, kDesktop, R"(
    found.taken = window.taken === true;
    found.name = document.querySelector(".run .name").textContent;)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["taken"], false);
  EXPECT_EQ(found["name"], evil);
}

TEST_F(ReportInBrowserTest, ComparesRunsOfDifferentLengthAndStep) {
  std::vector<report::ReportRun> runs = ExampleRuns(100);
  runs[0].samples.resize(40);
  for (metrics::Sample& sample : runs[1].samples) sample.time_s *= 2.5;
  const json found = Show(runs, kDesktop, R"(
    setTime(15.0);
    await settled();
    found.span = state.span;
    found.row = [...document.querySelectorAll("#speeds .legend tbody tr:nth-child(2) td")]
        .map((cell) => cell.textContent);
    found.drawn = canvases().map(isDrawn);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["span"], json::parse("[0.0, 24.75]"));
  EXPECT_EQ(found["row"][0], "–");
  EXPECT_NE(found["row"][1], "–");
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(ReportInBrowserTest, ShowsRunsWithoutFollowerOrStepsWithoutAnError) {
  std::vector<report::ReportRun> runs = ExampleRuns(60);
  runs[0].samples.clear();
  for (metrics::Sample& sample : runs[1].samples) {
    sample.follower_gap_m = sample.follower_safe_distance_m = sample.follower_speed_mps = kNone;
  }
  runs.resize(2);
  const json both = Show(runs, kDesktop, "found.charts = page.charts.length;");
  EXPECT_THAT(both["problems"], SizeIs(0)) << both;
  EXPECT_EQ(both["charts"], 2 * 6);
  EXPECT_THAT(Show({runs.data(), 1}, kDesktop, "")["problems"], SizeIs(0));
  EXPECT_THAT(Show({}, kDesktop, "")["problems"], SizeIs(0));
}

}  // namespace
}  // namespace fogline
