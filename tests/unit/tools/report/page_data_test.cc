#include "tools/report/page_data.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/tools/report/example_runs.h"
#include "tools/report/figures.h"

namespace fogline {
namespace {

using nlohmann::json;

/// A column of a run. The run has only the column's index in the page's list of all columns.
json ColumnOf(const json& page, std::size_t run, const std::string& name) {
  return page["columns"][page["runs"][run]["columns"][name].get<std::size_t>()];
}

TEST(PageDataTest, HasEveryColumnOfEveryRunInFullLength) {
  const std::vector<report::ReportRun> runs = ExampleRuns(120);
  const json page = json::parse(report::PageData(runs));
  ASSERT_EQ(page["runs"].size(), runs.size());
  for (std::size_t run = 0; run < runs.size(); ++run) {
    for (const report::Column& column : report::kColumns) {
      EXPECT_EQ(ColumnOf(page, run, std::string(column.name)).size(), 120U) << column.name;
    }
  }
}

TEST(PageDataTest, RoundsToAMicrometreAndKeepsNoNegativeZero) {
  report::ReportRun run;
  run.samples.resize(3);
  run.samples[0].host_gap_m = 33.12345678;
  run.samples[1].host_gap_m = -1e-9;
  run.samples[2].host_gap_m = 2e12 + 0.5;
  const json gaps = ColumnOf(json::parse(report::PageData({&run, 1})), 0, "host_gap_m");
  EXPECT_EQ(gaps[0].dump(), "33.123457");
  EXPECT_EQ(gaps[1].dump(), "0.0");
  EXPECT_EQ(gaps[2].get<double>(), 2e12 + 0.5);
}

TEST(PageDataTest, TurnsWhatIsNoNumberIntoNull) {
  report::ReportRun run;
  run.samples.resize(2);
  run.samples[0].lidar_range_m = kNone;
  run.samples[1].lidar_range_m = std::numeric_limits<double>::infinity();
  const json ranges = ColumnOf(json::parse(report::PageData({&run, 1})), 0, "lidar_range_m");
  EXPECT_TRUE(ranges[0].is_null());
  EXPECT_TRUE(ranges[1].is_null());
}

TEST(PageDataTest, KeepsACurveThatRunsShareOnce) {
  const json page = json::parse(report::PageData(ExampleRuns(50)));
  const auto place = [&](std::size_t run, const char* name) {
    return page["runs"][run]["columns"][name];
  };
  EXPECT_EQ(place(0, "preceding_speed_mps"), place(3, "preceding_speed_mps"));
  EXPECT_EQ(place(0, "time_s"), place(1, "time_s"));
  EXPECT_NE(place(0, "threshold"), place(1, "threshold"));
}

TEST(PageDataTest, SurvivesANameThatIsNoUtf8) {
  report::ReportRun run;
  run.name = "log\xFF.lcm";
  EXPECT_EQ(json::parse(report::PageData({&run, 1}))["runs"][0]["name"], "log\uFFFD.lcm");
}

TEST(PageDataTest, NumbersARunWithoutName) {
  const std::vector<report::ReportRun> runs(2);
  EXPECT_EQ(json::parse(report::PageData(runs))["runs"][1]["name"], "run 2");
}

TEST(PageDataTest, GivesWindowsInSeconds) {
  const std::vector<report::ReportRun> runs{ExampleRun({.threshold = 0.5})};
  const json run = json::parse(report::PageData(runs))["runs"][0];
  EXPECT_EQ(run["fog"], json::parse("[[19.0, 30.0]]"));
  ASSERT_EQ(run["human"].size(), 1U);
  EXPECT_GT(run["human"][0][0], 19.0);
  EXPECT_LT(run["human"][0][1], 30.0);
}

}  // namespace
}  // namespace fogline
