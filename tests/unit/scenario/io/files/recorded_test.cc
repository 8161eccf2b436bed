#include "scenario/io/files/recorded.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A folder with a scenario of a recorded leader (5 steps of 0.5 s from 10 s on) and its CSV file.
class RecordedLeadTest : public testing::Test {
 protected:
  RecordedLeadTest() : folder_(scratch_.path()) {
    std::filesystem::create_directories(folder_ / "data");
    Write("lead.json", R"({"version": 1, "steps": 5, "step_s": 0.5,
 "lead": {"profile": "recorded",
  "recorded": {"file": "data/lead.csv", "time_column": "t",
   "speed_column": "v", "start_s": 10}}})");
  }

  void Write(std::string_view name, std::string_view text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::vector<double> SpeedsOf(std::string_view csv,
                               const std::vector<std::string>& overrides = {}) const {
    Write("data/lead.csv", csv);
    return LoadScenario(folder_ / "lead.json", overrides).lead.recorded.speeds_mps;
  }
  // The error text that a user sees, without the folder.
  std::string ErrorOf(std::string_view csv, const std::vector<std::string>& overrides = {}) const {
    try {
      SpeedsOf(csv, overrides);
      return "";
    } catch (const ScenarioError& error) {
      std::string what = error.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at = what.find(prefix); at != std::string::npos; at = what.find(prefix)) {
        what.erase(at, prefix.size());
      }
      return what;
    }
  }

  test::ScratchFolder scratch_;
  const std::filesystem::path folder_;
};

TEST_F(RecordedLeadTest, HasOneSpeedForEachStep) {
  EXPECT_THAT(SpeedsOf("t,v\n10,1\n10.5,2\n11,3\n11.5,4\n12,5\n"), ElementsAre(1, 2, 3, 4, 5));
}

TEST_F(RecordedLeadTest, IsInterpolatedBetweenRowsOfAnyRate) {
  EXPECT_THAT(SpeedsOf("t,v\n9,0\n10.25,5\n10.75,7\n13,7\n"), ElementsAre(4, 6, 7, 7, 7));
}

TEST_F(RecordedLeadTest, FindsItsColumnsByName) {
  EXPECT_THAT(SpeedsOf("gap, v ,t\n9,1,10\n9,1,12\n"), ElementsAre(1, 1, 1, 1, 1));
}

TEST_F(RecordedLeadTest, TakesByteOrderMarkCrLfSpacesAndEmptyLinesAtTheEnd) {
  EXPECT_THAT(SpeedsOf("\xef\xbb\xbft,v\r\n10, 1.5 \r\n12,1.5\r\n\r\n\n"),
              ElementsAre(1.5, 1.5, 1.5, 1.5, 1.5));
  EXPECT_THAT(SpeedsOf("t,v\n10,1\n12,1"), ElementsAre(1, 1, 1, 1, 1));
}

TEST_F(RecordedLeadTest, TakesARowAsItIsWhereTimesDifferByRoundingOnly) {
  EXPECT_THAT(SpeedsOf("t,v\n10,0.1\n10.5000001,0.2\n11,0.3\n11.4999999,0.4\n11.9999999,0.5\n"),
              ElementsAre(0.1, 0.2, 0.3, 0.4, 0.5));
}

TEST_F(RecordedLeadTest, NeedsNoFileOnceItIsPrinted) {
  Write("data/lead.csv", "t,v\n10,1\n12,2\n");
  const Scenario scenario = LoadScenario(folder_ / "lead.json");
  std::filesystem::remove(folder_ / "data/lead.csv");
  const std::string text = PrintScenario(scenario);
  EXPECT_EQ(PrintScenario(ParseScenario(text)), text);
  Write("printed.json", text);
  EXPECT_EQ(PrintScenario(LoadScenario(folder_ / "printed.json")), text);
  EXPECT_EQ(scenario.lead.recorded.file, "data/lead.csv");
}

TEST_F(RecordedLeadTest, IsNotReadForAnotherProfile) {
  EXPECT_THAT(
      LoadScenario(folder_ / "lead.json", {"/lead/profile=constant"}).lead.recorded.speeds_mps,
      testing::IsEmpty());
}

TEST_F(RecordedLeadTest, NamesAFileThatIsNotThere) {
  EXPECT_THAT(ErrorOf("t,v\n10,1\n12,1\n", {"/lead/recorded/file=data/other.csv"}),
              HasSubstr("--set /lead/recorded/file=data/other.csv: error: /lead/recorded/file: "
                        "data/other.csv cannot be read: No such file or directory\n"));
  std::filesystem::remove(folder_ / "data/lead.csv");
  try {
    LoadScenario(folder_ / "lead.json");
    FAIL();
  } catch (const ScenarioError& error) {
    EXPECT_EQ(error.diagnostics()[0].line, 3);
    EXPECT_EQ(error.diagnostics()[0].column, 24);
    EXPECT_EQ(error.diagnostics()[0].rule, "csv-file");
  }
}

TEST_F(RecordedLeadTest, NamesTheColumnsThatThereAre) {
  EXPECT_EQ(ErrorOf("t,v1,v2\n10,1,1\n"),
            "lead.json:4:20: error: /lead/recorded/speed_column: data/lead.csv has no column "
            "\"v\"; it has \"t\", \"v1\", \"v2\"; did you mean \"v1\"?\n"
            "1 error; what is allowed: fogline check --explain /lead/recorded/speed_column");
  EXPECT_THAT(ErrorOf(""), HasSubstr("has no column \"t\"; it has no header line"));
  EXPECT_THAT(ErrorOf("t,v,v\n10,1,1\n"), HasSubstr("more than one column \"v\""));
}

TEST_F(RecordedLeadTest, NamesEveryCellThatIsNoNumber) {
  EXPECT_EQ(ErrorOf("t,v\n10,fast\n11,\n12\n13,nan\n14,1e999\n15,1 2\n"),
            "data/lead.csv:2:4: error: /lead/recorded/file: \"fast\" is not a number\n"
            "data/lead.csv:3:4: error: /lead/recorded/file: \"\" is not a number\n"
            "data/lead.csv:4:1: error: /lead/recorded/file: the row ends before column 2\n"
            "data/lead.csv:5:4: error: /lead/recorded/file: \"nan\" is not a number\n"
            "data/lead.csv:6:4: error: /lead/recorded/file: \"1e999\" is not a number\n"
            "data/lead.csv:7:4: error: /lead/recorded/file: \"1 2\" is not a number\n"
            "6 errors; what is allowed: fogline check --explain /lead/recorded/file");
}

TEST_F(RecordedLeadTest, HasMistakesThatAreThoseOfNoOverride) {
  try {
    SpeedsOf("t,v\n10,fast\n", {"/steps=4"});
    ADD_FAILURE() << "the file is refused";
  } catch (const ScenarioError& error) {
    for (const Diagnostic& mistake : error.diagnostics()) EXPECT_EQ(mistake.override_number, 0);
  }
}

TEST_F(RecordedLeadTest, RefusesAnEmptyLineBetweenRows) {
  EXPECT_THAT(ErrorOf("t,v\n10,1\n\n12,1\n"),
              HasSubstr("data/lead.csv:3:1: error: /lead/recorded/file: an empty line"));
}

TEST_F(RecordedLeadTest, RefusesTimesThatDoNotAscend) {
  EXPECT_THAT(ErrorOf("t,v\n10,1\n11,1\n11,1\n12,1\n"),
              HasSubstr("data/lead.csv:4:1: error: /lead/recorded/file: time 11 s does not come "
                        "after 11 s, the time of the row above\n"));
}

TEST_F(RecordedLeadTest, RefusesSpeedsOutOfRange) {
  EXPECT_THAT(ErrorOf("t,v\n10,1\n12,-0.5\n"),
              HasSubstr("data/lead.csv:3:4: error: /lead/recorded/file: -0.5 is outside [0, 70] "
                        "m/s\n"));
}

TEST_F(RecordedLeadTest, NeedsARecordingThatSpansTheRun) {
  EXPECT_THAT(ErrorOf("t,v\n10,1\n11.9,1\n"),
              HasSubstr("lead.json:4:36: error: /lead/recorded/start_s: 5 steps of 0.5 s from here "
                        "need 10 s to 12 s, but data/lead.csv has 10 s to 11.9 s\n"));
  EXPECT_THAT(ErrorOf("t,v\n10.1,1\n13,1\n"), HasSubstr("has 10.1 s to 13 s\n"));
  EXPECT_THAT(ErrorOf("t,v\n"), HasSubstr("data/lead.csv has no rows\n"));
}

TEST_F(RecordedLeadTest, SpeaksOfTimesAsPeopleWriteThem) {
  // In binary, 10 s + 8 * 0.1 s is 10.799999999999999 s, and 10 s + 3 * 0.1 s is 10.300000000000001
  // s. The error text has 10.8 s and 10.3 s.
  for (const auto& [steps, end] : {std::pair{"9", "10.8"}, {"4", "10.3"}}) {
    EXPECT_THAT(
        ErrorOf("t,v\n10,1\n10.1,1\n", {"/step_s=0.1", std::string("/steps=") + steps}),
        HasSubstr(std::string(" need 10 s to ") + end + " s, but data/lead.csv has 10 s to "));
  }
}

TEST_F(RecordedLeadTest, NamesTheSeparatorThatStandsWhereACommaMust) {
  EXPECT_EQ(
      ErrorOf("t;v\n10;1,5\n12;1,5\n"),
      "lead.json:3:24: error: /lead/recorded/file: data/lead.csv seems to be separated by ';', "
      "but ',' is expected\n"
      "1 error; what is allowed: fogline check --explain /lead/recorded/file");
  EXPECT_THAT(ErrorOf("t\tv\n10\t1\n"),
              HasSubstr("seems to be separated by tabs, but ',' is expected"));
}

TEST_F(RecordedLeadTest, RefusesMoreStepsThanAScenarioCanCarry) {
  EXPECT_THAT(ErrorOf("t,v\n10,1\n12,1\n", {"/steps=1000001"}),
              HasSubstr("/steps: 1000001 steps; a recorded leader has at most 1000000\n"));
}

}  // namespace
}  // namespace fogline
