#include "tools/report/report.h"

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/report/example_runs.h"
#include "tools/report/assets.h"
#include "tools/report/figures.h"
#include "tools/report/html.h"

namespace fogline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t Count(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The text from `begin` up to `end`, without `end`.
std::string Between(const std::string& text, std::string_view begin, std::string_view end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) return "";
  return text.substr(from, text.find(end, from) - from);
}

std::string SectionOf(const std::string& page, std::string_view id) {
  return Between(page, fmt::format("<section id=\"{}\"", id), "</section>");
}

TEST(MakeReportTest, HasEveryFigureAndEveryRun) {
  const std::vector<report::ReportRun> runs = ExampleRuns();
  const std::string page = report::MakeReport(runs, ExampleTable());
  for (const report::Figure& figure : report::Figures()) {
    EXPECT_EQ(Count(page, fmt::format("<figure id=\"{}\"", figure.id)), 1U) << figure.id;
    EXPECT_THAT(page, HasSubstr(std::string(figure.title)));
  }
  const std::string selector = Between(page, "<fieldset", "</fieldset>");
  for (const report::ReportRun& run : runs) {
    EXPECT_THAT(selector, HasSubstr(fmt::format("<span class=\"name\">{}</span>", run.name)));
    EXPECT_THAT(SectionOf(page, "scenarios"), HasSubstr(run.digest));
    EXPECT_THAT(SectionOf(page, "scenarios"), HasSubstr(report::EscapeHtml(run.scenario_json)));
  }
}

TEST(MakeReportTest, TellsWhatHappenedAndExplainsItsTermsBeforeAllElse) {
  const std::string page = report::MakeReport(ExampleRuns(), ExampleTable());
  const std::string header = Between(page, "<header>", "</header>");
  EXPECT_THAT(header,
              HasSubstr("<p class=\"story\">In fog from 19\u00a0s to 30\u00a0s the LiDAR read"));
  for (const char* term : {"Compromised safety", "Safety improvement, SI",
                           "Degree of Conflict, DoC", "Redundant human engagement, RHE"}) {
    EXPECT_THAT(header,
                ::testing::ContainsRegex(fmt::format("<dt>{}</dt><dd>[^<.]+\\.</dd>", term)));
  }
  EXPECT_THAT(report::MakeReport({}, {}), Not(HasSubstr("class=\"story\"")));
}

TEST(MakeReportTest, LeavesNoPlaceOfTheTemplateOpen) {
  const std::string page = report::MakeReport(ExampleRuns(10), {});
  EXPECT_THAT(page, Not(HasSubstr("{{title}}")));
  EXPECT_THAT(page, Not(HasSubstr("{{data}}")));
  EXPECT_THAT(page, HasSubstr("<title>Traded control in fog · Fogline report</title>"));
}

TEST(MakeReportTest, RefersToNothingOutsideThePage) {
  std::string page = report::MakeReport(ExampleRuns(), ExampleTable());
  // uPlot's licence comment and the name of SVG's namespace contain URLs, but load nothing.
  for (const std::string_view known :
       {"https://github.com/leeoniya/uPlot", "http://www.w3.org/2000/svg"}) {
    for (std::size_t at = page.find(known); at != page.npos; at = page.find(known)) {
      page.erase(at, known.size());
    }
  }
  for (const std::string_view reference :
       {"http:", "https:", "src=", "@import", "url(", "fetch("}) {
    EXPECT_THAT(page, Not(HasSubstr(std::string(reference))));
  }
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(MakeReportTest, CarriesTheLicenceOfTheChartLibrary) {
  const std::string page = report::MakeReport({}, {});
  EXPECT_THAT(page, HasSubstr("Copyright (c) 2022 Leon Sorokin"));
  EXPECT_THAT(page, HasSubstr("THE SOFTWARE IS PROVIDED &quot;AS IS&quot;"));
}

TEST(MakeReportTest, NamesTheVersionOfTheChartLibrary) {
  const std::string page = report::MakeReport({}, {});
  const std::string before = "Charts by uPlot ";
  const std::size_t begin = page.find(before);
  ASSERT_NE(begin, page.npos);
  const std::size_t at = begin + before.size();
  const std::string version = page.substr(at, page.find(',', at) - at);
  EXPECT_THAT(page, HasSubstr("uPlot (v" + version + ") */"));
}

TEST(MakeReportTest, StaysBelowTwoMegabytesForFourRunsOfFiveHundredSteps) {
  EXPECT_LT(report::MakeReport(ExampleRuns(), ExampleTable()).size(), 2'000'000U);
}

TEST(MakeReportTest, EscapesEveryTextOfARun) {
  const std::string evil = "</script><img src=x onerror=alert(1)>\"'&";
  report::ReportRun run = ExampleRun({.steps = 3});
  run.name = run.log = run.shortage = evil;
  run.scenario_title = run.scenario_json = run.digest = evil;
  run.measures = {{evil, 1.0, evil, evil}};
  report::ReportTable table = ExampleTable();
  table.note = evil;
  const std::string page = report::MakeReport({&run, 1}, table);
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("</script><")));
}

TEST(MakeReportTest, DoesNotTakeTextOfARunForItsTemplate) {
  report::ReportRun run = ExampleRun({.steps = 3});
  run.name = "{{data}}";
  EXPECT_THAT(report::MakeReport({&run, 1}, {}), HasSubstr("<span class=\"name\">{{data}}</span>"));
}

TEST(MakeReportTest, ShowsEveryMeasureOfEveryRunSideBySide) {
  std::vector<report::ReportRun> runs = ExampleRuns(20);
  runs[0].measures = {{"first", 1.25, "m", "of one run"}, {"both", 2.5, "s", ""}};
  runs[1].measures = {{"both", 3.5, "s", ""}, {"last", 4.5, "", "of the other"}};
  runs.resize(2);
  runs[1].si_pct = 55.5;
  const std::string table = SectionOf(report::MakeReport(runs, {}), "measures");
  for (const double value : {1.25, 2.5, 3.5, 4.5, 55.5}) {
    EXPECT_THAT(table, HasSubstr(fmt::format("<data value=\"{}\">", value)));
  }
  EXPECT_EQ(Count(table, "<tr>"), 1U + 4U);  // the head, SI and three measures
  EXPECT_EQ(Count(table, "<td>–</td>"), 3U);
  EXPECT_THAT(table, HasSubstr("<data value=\"2.5\">2.50</data></td><td><data value=\"3.5\">3.50"));
}

TEST(MakeReportTest, NamesAMeasureByItsDescriptionFirstAndTypesetsItsUnit) {
  report::ReportRun run = ExampleRun({.steps = 3});
  run.measures = {{"max_abs_jerk_mps3", 2.0, "m/s3", "largest jerk of the host"}};
  EXPECT_THAT(report::MakeReport({&run, 1}, {}),
              HasSubstr("largest jerk of the host\u00a0<span class=\"unit\">m/s³</span>"
                        "<small>max_abs_jerk_mps3</small>"));
}

TEST(MakeReportTest, KeepsAMeasureThatARunHasTwice) {
  report::ReportRun run = ExampleRun({.steps = 3});
  const double none = std::numeric_limits<double>::quiet_NaN();
  run.measures = {{"twice", none, "m", ""}, {"twice", 2.0, "m", ""}};
  EXPECT_EQ(Count(SectionOf(report::MakeReport({&run, 1}, {}), "measures"), ">twice\u00a0<span"),
            2U);
}

TEST(MakeReportTest, PutsTheReproducedTableBesideThePublishedOne) {
  const std::string table = SectionOf(report::MakeReport(ExampleRuns(10), ExampleTable()), "table");
  EXPECT_THAT(table, HasSubstr("<data value=\"80.8125\">80.81</data></td>"
                               "<td class=\"deviation\">± <data value=\"4.5\">4.50</data></td>"
                               "<td><data value=\"80.79\">80.79</data></td>"));
  EXPECT_THAT(table, HasSubstr("\u221210.25"));
  // One row has no published values (two cells). None of the four rows has values for the effect of
  // the fog (three cells in each row).
  EXPECT_EQ(Count(table, "<td>–</td>"), 2U + 3U * 4U);
  EXPECT_THAT(table, HasSubstr("Mean and standard deviation over seeds 1 to 200."));
}

TEST(MakeReportTest, HasAColumnOfSeedsOnlyWhereTheRowsAreOfSeveral) {
  report::ReportTable table = ExampleTable();
  EXPECT_THAT(SectionOf(report::MakeReport(ExampleRuns(10), table), "table"),
              Not(HasSubstr(">Seed</th>")));
  table.rows[1].seed = 4711;
  const std::string section = SectionOf(report::MakeReport(ExampleRuns(10), table), "table");
  EXPECT_EQ(Count(section, ">Seed</th>"), 1U);
  EXPECT_THAT(section, HasSubstr("<data value=\"0.5\">0.5</data></th><td>4711</td>"));
}

TEST(MakeReportTest, SaysOfEveryRunWhereItComesFrom) {
  report::ReportRun run = ExampleRun({.steps = 3});
  run.log = "paper-<1>.lcm";
  EXPECT_THAT(report::MakeReport({&run, 1}, {}),
              HasSubstr("<span class=\"origin\">paper-&lt;1&gt;.lcm · Traded control in fog · "
                        "seed 7</span>"));
}

TEST(MakeReportTest, MarksTheRunsWhoseLogsAreNotCompleteAndSaysWhereTheyEnd) {
  std::vector<report::ReportRun> runs = ExampleRuns(10);
  EXPECT_THAT(report::MakeReport(runs, {}), Not(HasSubstr("class=\"badge\"")));
  runs[1].shortage = "ends after step 8 of \"10\"";
  std::string page = report::MakeReport(runs, {});
  EXPECT_EQ(Count(page, ">incomplete log<"), 1U);
  EXPECT_THAT(page, HasSubstr("title=\"ends after step 8 of &quot;10&quot;\""));
  // This run lacks its last step.
  runs[1].scenario.steps = 10;
  runs[1].samples.pop_back();
  page = report::MakeReport(runs, {});
  EXPECT_EQ(Count(page, ">incomplete: ends after step 8 of 10<"), 1U);
  runs[1].samples.clear();
  page = report::MakeReport(runs, {});
  EXPECT_EQ(Count(page, ">incomplete: has no step of 10<"), 1U);
}

TEST(MakeReportTest, HasNoTableSectionWithoutATable) {
  EXPECT_EQ(SectionOf(report::MakeReport(ExampleRuns(10), {}), "table"), "");
}

TEST(MakeReportTest, ListsTheScenarioFieldsThatDifferAndNoOthers) {
  const std::string table = SectionOf(report::MakeReport(ExampleRuns(10), {}), "differences");
  EXPECT_THAT(table, HasSubstr("/arbitrator/threshold"));
  EXPECT_THAT(table, HasSubstr("<td>none</td><td>traded</td>"));
  EXPECT_THAT(table, Not(HasSubstr("/fog/start_s")));
}

TEST(MakeReportTest, SaysNothingOfDifferencesWhereThereAreNone) {
  const std::vector<report::ReportRun> runs(2, ExampleRun({.threshold = 0.5, .steps = 10}));
  EXPECT_EQ(SectionOf(report::MakeReport(runs, {}), "differences"), "");
}

TEST(MakeReportTest, SaysHowManyOfManyDifferencesItLeavesOut) {
  std::vector<report::ReportRun> runs(2, ExampleRun({.steps = 3}));
  for (int i = 0; i < 2; ++i) {
    std::string list;
    for (int k = 0; k < 60; ++k) list += fmt::format("{}{}", k == 0 ? "" : ",", 100 * i + k);
    runs[static_cast<std::size_t>(i)].scenario_json = fmt::format("{{\"speeds\": [{}]}}", list);
  }
  EXPECT_THAT(SectionOf(report::MakeReport(runs, {}), "differences"), HasSubstr("and 10 more"));
}

TEST(MakeReportTest, HasNoTakeOversWithoutARequest) {
  EXPECT_EQ(SectionOf(report::MakeReport(ExampleRuns(), {}), "take-overs"), "");
}

TEST(MakeReportTest, HasAColumnForEachRequestToTakeOverAndARowForEachMeasure) {
  std::vector<report::ReportRun> runs = ExampleRuns();
  runs[1].take_overs = {{.outcome = metrics::TakeOverEnd::kTakenOver,
                         .requested_s = 2,
                         .judged_s = 7,
                         .reaction_time_s = 1.25,
                         .speed_at_request_mps = 20},
                        {.outcome = metrics::TakeOverEnd::kMinimalRisk, .requested_s = 31}};
  const std::string section = SectionOf(report::MakeReport(runs, {}), "take-overs");
  EXPECT_THAT(section, HasSubstr("threshold 0.2, request 1</th>"));
  EXPECT_THAT(section, HasSubstr("threshold 0.2, request 2</th>"));
  EXPECT_THAT(section, HasSubstr("<td>taken over</td><td>minimal risk manoeuvre</td></tr>"));
  EXPECT_THAT(section, HasSubstr("<small>reaction_time_s</small></th>"
                                 "<td><data value=\"1.25\">1.25</data></td><td>–</td></tr>"));
  EXPECT_EQ(Count(section, "<tr>"), 1U + 9U) << "a measure that no request has has no row";
}

TEST(MakeReportTest, NamesACollisionInTheRunSelector) {
  report::ReportRun run = ExampleRun({.steps = 30});
  run.samples.back().collision = truth_t::COLLISION_FOLLOWER;
  run.samples.back().collision_time_s = 2.9;
  EXPECT_THAT(report::MakeReport({&run, 1}, {}), HasSubstr("following car, at 2.9 s"));
}

TEST(MakeReportTest, SumsUpHowLongTheHumanDrives) {
  report::ReportRun run;
  run.samples.resize(11);
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    run.samples[i].time_s = 0.5 * static_cast<double>(i);
    run.samples[i].lambda_human = i == 1 || i == 2 || i == 6 ? 1.0 : 0.0;
  }
  EXPECT_THAT(report::MakeReport({&run, 1}, {}),
              HasSubstr("<dt>Human drives</dt><dd><data value=\"1.5\">1.50</data> s</dd>"));
}

TEST(MakeReportTest, MakesAPageOfNoRunsAndOfARunWithoutSteps) {
  EXPECT_THAT(report::MakeReport({}, {}), HasSubstr("<h1>No runs</h1>"));
  const report::ReportRun empty;
  EXPECT_THAT(report::MakeReport({&empty, 1}, {}), HasSubstr("run 1"));
}

}  // namespace
}  // namespace fogline
