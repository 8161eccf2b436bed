// The page of studies in a real browser. It has every study, draws its figures, and responds to the
// reader.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/campaign/browser/browser.h"
#include "tools/report/study_page.h"
#include "tools/study/claims.h"
#include "tools/study/study.h"

namespace fogline {
namespace {

using nlohmann::json;
using ::testing::Each;
using ::testing::Ge;
using ::testing::SizeIs;

/// The sections of all studies over a few seeds, as `fogline study all` makes them. Only the first
/// call computes the studies.
const std::vector<report::StudySection>& Sections() {
  static const std::vector<report::StudySection> kSections = [] {
    std::vector<report::StudySection> sections;
    for (const study::Study& study : study::Studies()) {
      study::StudyResult result =
          study.run({.scenarios = std::string(FOGLINE_SOURCE_DIR) + "/scenario",
                     .seeds = {1, 8},
                     .jobs = 2,
                     .progress = {}});
      report::StudySection& section = sections.emplace_back(std::move(result.section));
      section.name = study.name;
      section.title = study.title;
      section.question = study.question;
      section.claims = study::CheckClaims(result.claims, /*few_runs=*/true);
    }
    return sections;
  }();
  return kSections;
}

std::size_t CountFigures() {
  std::size_t count = 0;
  for (const report::StudySection& section : Sections()) count += section.figures.size();
  return count;
}

/// Unfolds all folded sections, because the page draws their figures only then.
constexpr std::string_view kUnfold = R"(
    const chartOf = (name) => charts.find(({figure}) => figure.id === name).chart;
    document.querySelectorAll("details.more-figures").forEach((e) => { e.open = true; });
    await settled();)";

class StudyInBrowserTest : public BrowserTest {
 protected:
  json Show(ViewSize window, std::string_view script, Scheme scheme = Scheme::kLight) {
    return BrowserTest::Show(report::MakeStudyPage("fogline study all", Sections()), window,
                             std::string(kUnfold) + std::string(script), scheme);
  }
};

TEST_F(StudyInBrowserTest, HasEveryStudyDrawsEveryFigureAndLoadsNothing) {
  const json found = Show(kDesktop, R"(
    found.sections = [...document.querySelectorAll("main > section")].map(({id}) => id);
    found.links = [...document.querySelectorAll("nav a")].map((a) => a.getAttribute("href"));
    found.answers = [...document.querySelectorAll(".finding > p")].map((e) => e.textContent.length);
    found.claims = [...document.querySelectorAll(".claims")].length;
    found.drawn = canvases().map(isDrawn);
    found.titles = [...document.querySelectorAll("figure h3")].map((e) => e.textContent);
    found.values = charts.map(({chart}) => chart.data.slice(1).flat().filter(Number.isFinite).length);
    found.rows = [...document.querySelectorAll("table")].map((e) => e.tBodies[0].rows.length);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["loaded"], 0);
  std::vector<std::string> names;
  std::vector<std::string> links;
  for (const study::Study& study : study::Studies()) {
    names.emplace_back(study.name);
    links.push_back('#' + names.back());
  }
  EXPECT_EQ(found["sections"], json(names));
  EXPECT_EQ(found["links"], json(links));
  EXPECT_THAT(found["answers"], SizeIs(names.size()));
  EXPECT_THAT(found["answers"], Each(Ge(40)));
  EXPECT_EQ(found["claims"], names.size());
  EXPECT_THAT(found["drawn"], SizeIs(CountFigures()));
  EXPECT_THAT(found["drawn"], Each(true));
  EXPECT_THAT(found["titles"], Each(::testing::Ne("")));
  EXPECT_THAT(found["values"], SizeIs(CountFigures()));
  EXPECT_THAT(found["values"], Each(Ge(2))) << "a figure without points";
  EXPECT_THAT(found["rows"], Each(Ge(1)));
}

TEST_F(StudyInBrowserTest, SaysIfAnAxisSpansLessThanAHundredthOfTheValueAndOffersTheWholeAxis) {
  // GIVEN values of 100 and 100.5. With its margin the axis spans 0.55
  report::StudySection section{.name = "narrow", .title = "Narrow", .question = "How narrow?"};
  for (const bool logarithmic : {false, true}) {
    report::StudyFigure& figure = section.figures.emplace_back(report::StudyFigure{
        .id = logarithmic ? "logarithmic" : "linear", .title = "Values", .log_y = logarithmic});
    figure.categories = {"one", "other"};
    figure.series = {{.name = "series", .x = {0, 1}, .y = {100, 100.5}}};
  }
  const json found = BrowserTest::Show(report::MakeStudyPage("fogline study narrow", {&section, 1}),
                                       kDesktop, std::string(kUnfold) + R"(
    const line = (id) => document.querySelector(`#${id} .span-note`);
    const {chart} = charts[0];
    const axis = () => [chart.scales.y.min, chart.scales.y.max];
    await settled();
    found.note = line("linear").textContent;
    found.hidden = [line("linear").hidden, line("logarithmic").hidden];
    found.fitted = axis();
    line("linear").querySelector("input").click();
    await settled();
    found.whole = axis();
    line("linear").querySelector("input").click();
    await settled();
    found.back = axis();)",
                                       Scheme::kLight);
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["note"], "axis spans 0.55 % of the valuefrom zero");
  EXPECT_EQ(found["hidden"], json::parse("[false, true]"));
  EXPECT_EQ(found["whole"], json::array({0, 1.05 * 100.5}));
  EXPECT_NE(found["fitted"], found["whole"]);
  EXPECT_EQ(found["back"], found["fitted"]);
}

TEST_F(StudyInBrowserTest, HidesASeriesAndShowsItAgain) {
  const json found = Show(kDesktop, R"(
    const figure = document.querySelector("#policy-si");
    const image = () => figure.querySelector("canvas").toDataURL();
    const button = figure.querySelector(".legend button");
    const images = [image()];
    found.pressed = [button.getAttribute("aria-pressed")];
    for (let i = 0; i < 2; ++i) {
      button.click();
      await settled();
      images.push(image());
      found.pressed.push(button.getAttribute("aria-pressed"));
    }
    found.changed = images[0] !== images[1];
    found.restored = images[0] === images[2];)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["pressed"], json::parse(R"(["true", "false", "true"])"));
  EXPECT_EQ(found["changed"], true) << "nothing was drawn of the series";
  EXPECT_EQ(found["restored"], true);
}

TEST_F(StudyInBrowserTest, KeepsTheFiguresThatAreThereWhenAPartIsUnfolded) {
  const json found =
      BrowserTest::Show(report::MakeStudyPage("fogline study all", Sections()), kDesktop, R"(
    const drawn = canvases();
    const button = document.querySelector(".legend button");
    document.querySelectorAll("details.more-figures").forEach((e) => { e.open = true; });
    await settled();
    found.before = drawn.length;
    found.after = canvases().length;
    found.kept = [...drawn, button].map((e) => e.isConnected);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_GE(found["before"], 1);
  EXPECT_GT(found["after"], found["before"]);
  EXPECT_THAT(found["kept"], Each(true));
}

TEST_F(StudyInBrowserTest, GivesTheValuesAtTheCursor) {
  const json found = Show(kDesktop, R"(
    const chart = chartOf("transfer-jerk");
    mouse("mousemove", chart.over, 100, chart.valToPos(0, "x"));
    await settled();
    const legend = document.querySelector("#transfer-jerk .legend");
    found.at = legend.querySelector(".at").textContent;
    found.series = figures.find(({id}) => id === "transfer-jerk").series.map(({name}) => name);
    found.values = [...legend.querySelectorAll(".value")].map((e) => e.textContent);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["at"], "step");
  EXPECT_THAT(found["series"], SizeIs(Ge(2)));
  EXPECT_THAT(found["values"], SizeIs(found["series"].size()));
  EXPECT_THAT(found["values"], Each(::testing::Ne("")));
}

TEST_F(StudyInBrowserTest, CutsNoNameOfARowOff) {
  // If the canvas cuts a text off, the outermost pixels of the canvas have ink. So the script looks
  // for ink there.
  constexpr std::string_view kInk = R"(
    const hasInk = (canvas, x, y, width, height) =>
        canvas.getContext("2d").getImageData(x, y, width, height).data.some((v) => v > 0);
    const sides = ({width, height}) =>
        ({left: [0, 0, 1, height], right: [width - 1, 0, 1, height], bottom: [0, height - 1, width, 1]});
    found.cut = figures.flatMap(({id}) => {
      const canvas = document.querySelector(`#${id} canvas`);
      return Object.entries(sides(canvas)).filter(([, side]) => hasInk(canvas, ...side)).map(([name]) => `${id} ${name}`);
    });
    found.names = figures.map(({categories}) => categories.length);)";
  for (const ViewSize size : {kDesktop, kPhone}) {
    const json found = Show(size, kInk);
    EXPECT_THAT(found["problems"], SizeIs(0)) << found;
    EXPECT_THAT(found["cut"], SizeIs(0)) << size.width << " " << found["cut"];
    EXPECT_THAT(found["names"].get<std::vector<int>>(), ::testing::Contains(Ge(16)));
  }
}

TEST_F(StudyInBrowserTest, HasAFewNamesInALegendAndTheOthersBehindOneMore) {
  const json found = Show(kDesktop, R"(
    const seen = ({id}) => [...document.querySelectorAll(`#${id} .legend button`)]
        .filter((button) => button.checkVisibility()).length;
    found.seen = figures.map(seen);
    found.series = figures.map(({series}) => series.length);
    const more = document.querySelector("#conflict-delay-bias details");
    more.open = true;
    found.open = seen(figures[0]);
    const colours = figures[0].series.map((_, i) => i).filter((i) => figures[0].atFirst[i])
        .map((i) => strokeOf(figures[0], i));
    found.colours = [colours.length, new Set(colours).size];)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_THAT(found["seen"], Each(::testing::AllOf(Ge(1), ::testing::Le(8))));
  EXPECT_GT(found["series"][0], 20);
  EXPECT_EQ(found["open"], found["series"][0]);
  EXPECT_EQ(found["colours"][0], found["colours"][1]) << "what is shown at first differs in colour";
}

TEST_F(StudyInBrowserTest, LetsNoGreatValueFlattenTheOthers) {
  const json found = Show(kDesktop, R"(
    // Of the shown points, the share that lies in the first tenth of the axis.
    const flat = (name) => {
      const chart = chartOf(name);
      const {min, max} = chart.scales.y;
      const places = chart.data.slice(1).flat().filter(Number.isFinite);
      return places.filter((place) => place < min + 0.1 * (max - min)).length / places.length;
    };
    found.flat = ["followers-ttc", "followers-string-ttc-traded", "driver-ttc-visibility"].map(flat);
    const drac = chartOf("vehicle-drac");
    const values = figures.find(({id}) => id === "vehicle-drac").series.flatMap(({y}) => y);
    found.most = drac.scales.y.max;
    found.beyond = values.filter((y) => y > found.most).length;
    found.note = document.querySelector("#vehicle-drac .axis").textContent;
    const spy = [];
    const fillText = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...more) {
      spy.push(text);
      return fillText.call(this, text, ...more);
    };
    drac.redraw();
    await settled();
    found.marked = values.filter((y) => y > found.most).every((y) => spy.includes(numberText(y)));)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_THAT(found["flat"], Each(::testing::Le(0.5))) << found;
  EXPECT_LT(found["most"], 14);
  EXPECT_GE(found["beyond"], 1) << "a truck that brakes hard collides";
  EXPECT_EQ(found["marked"], true);
  EXPECT_EQ(found["note"], "follower's largest DRAC (m/s2) (▸ beyond 12.68)");
}

TEST_F(StudyInBrowserTest, FitsAPhoneWithEveryTableOpen) {
  const json found = Show(kPhone, R"(
    document.querySelectorAll("details").forEach((element) => { element.open = true; });
    await settled();
    found.width = document.documentElement.scrollWidth;
    found.charts = charts.map(({chart}) => chart.width);
    found.drawn = canvases().map(isDrawn);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_LE(found["width"], kPhone.width);
  EXPECT_THAT(found["charts"], Each(::testing::Le(kPhone.width)));
  EXPECT_THAT(found["drawn"], Each(true));
}

TEST_F(StudyInBrowserTest, IsDarkWhereTheReaderLikesItDark) {
  constexpr std::string_view kColours = R"(
    found.page = getComputedStyle(document.body).backgroundColor;
    found.series = charts[0].chart.series[1].stroke();)";
  const json light = Show(kDesktop, kColours, Scheme::kLight);
  const json dark = Show(kDesktop, kColours, Scheme::kDark);
  EXPECT_THAT(dark["problems"], SizeIs(0)) << dark;
  EXPECT_NE(light["page"], dark["page"]);
  EXPECT_NE(light["series"], dark["series"]);
}

}  // namespace
}  // namespace fogline
