// The page of studies in a real browser: has it every study, are its figures drawn, does it do what
// the reader asks.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/report/browser.h"
#include "tools/report/study_page.h"
#include "tools/study/study.h"

namespace fogline {
namespace {

using nlohmann::json;
using ::testing::Each;
using ::testing::Ge;
using ::testing::SizeIs;

/// All studies over a few seeds, as `fogline study all` makes them; made once.
const std::vector<StudySection>& Sections() {
  static const std::vector<StudySection> kSections = [] {
    std::vector<StudySection> sections;
    for (const Study& study : Studies()) {
      StudyResult result = study.run({.scenarios = std::string(FOGLINE_SOURCE_DIR) + "/scenario",
                                      .seeds = {1, 8},
                                      .jobs = 2,
                                      .progress = {}});
      StudySection& section = sections.emplace_back(std::move(result.section));
      section.name = study.name;
      section.title = study.title;
      section.question = study.question;
    }
    return sections;
  }();
  return kSections;
}

std::size_t CountFigures() {
  std::size_t count = 0;
  for (const StudySection& section : Sections()) count += section.figures.size();
  return count;
}

class StudyInBrowserTest : public BrowserTest {
 protected:
  json Show(ViewSize window, std::string_view script, Scheme scheme = Scheme::kLight) {
    return BrowserTest::Show(MakeStudyPage("fogline study all", Sections()), window, script,
                             scheme);
  }
};

TEST_F(StudyInBrowserTest, HasEveryStudyDrawsEveryFigureAndLoadsNothing) {
  const json found = Show(kDesktop, R"(
    found.sections = [...document.querySelectorAll("main > section")].map(({id}) => id);
    found.links = [...document.querySelectorAll("nav a")].map((a) => a.getAttribute("href"));
    found.findings = [...document.querySelectorAll(".finding")].map((e) => e.children.length);
    found.drawn = canvases().map(isDrawn);
    found.titles = [...document.querySelectorAll("figure h3")].map((e) => e.textContent);
    found.values = charts.map(({chart}) => chart.data.slice(1).flat().filter(Number.isFinite).length);
    found.rows = [...document.querySelectorAll("table")].map((e) => e.tBodies[0].rows.length);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["loaded"], 0);
  std::vector<std::string> names;
  std::vector<std::string> links;
  for (const Study& study : Studies()) {
    names.emplace_back(study.name);
    links.push_back('#' + names.back());
  }
  EXPECT_EQ(found["sections"], json(names));
  EXPECT_EQ(found["links"], json(links));
  EXPECT_THAT(found["findings"], Each(Ge(1)));
  EXPECT_THAT(found["drawn"], SizeIs(CountFigures()));
  EXPECT_THAT(found["drawn"], Each(true));
  EXPECT_THAT(found["titles"], Each(::testing::Ne("")));
  EXPECT_THAT(found["values"], SizeIs(CountFigures()));
  EXPECT_THAT(found["values"], Each(Ge(2))) << "a figure without points";
  EXPECT_THAT(found["rows"], Each(Ge(1)));
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

TEST_F(StudyInBrowserTest, GivesTheValuesAtTheCursor) {
  const json found = Show(kDesktop, R"(
    const index = figures.findIndex(({id}) => id === "transfer-jerk");
    const {chart} = charts[index];
    mouse("mousemove", chart.over, chart.valToPos(0, "x"));
    await settled();
    const legend = document.querySelector("#transfer-jerk .legend");
    found.at = legend.querySelector(".at").textContent;
    found.values = [...legend.querySelectorAll(".value")].map((e) => e.textContent);)");
  EXPECT_THAT(found["problems"], SizeIs(0)) << found;
  EXPECT_EQ(found["at"], "step");
  EXPECT_THAT(found["values"], SizeIs(2));
  EXPECT_THAT(found["values"], Each(::testing::Ne("")));
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
