#include "scenario/io/loader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_errors.h"

namespace fogline {
namespace {

std::vector<Diagnostic> DiagnosticsOf(std::string_view text,
                                      const std::vector<std::string>& overrides = {}) {
  try {
    ParseScenario(text, "f", overrides);
    return {};
  } catch (const ScenarioError& error) {
    return error.diagnostics();
  }
}

std::string ErrorOf(std::string_view text, const std::vector<std::string>& overrides = {}) {
  try {
    ParseScenario(text, "f", overrides);
    return "";
  } catch (const ScenarioError& error) {
    return error.what();
  }
}

std::string FileText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(LoaderTest, GivesTheDefaultsWhereTheFileIsSilent) {
  const Scenario scenario = ParseScenario(R"({"version": 1})");
  EXPECT_EQ(PrintScenario(scenario), PrintScenario(Scenario{}));
}

TEST(LoaderTest, ReadsEveryKindOfField) {
  const Scenario scenario = ParseScenario(R"({
    "version": 1, "title": "N\u00e4he", "seed": 9007199254740991, "step_s": 0.05,
    "fog": {"model": "beam"}, "fusion": {"gating": true},
    "lead": {"breakpoints": [{"speed_mps": 5}, {"duration_s": 2.5}],
             "recorded": {"speeds_mps": [1, 2.5]}}})");
  EXPECT_EQ(scenario.title, "N\xc3\xa4he");
  EXPECT_EQ(scenario.seed, 9007199254740991);
  EXPECT_EQ(scenario.step_s, 0.05);
  EXPECT_EQ(scenario.fog.model, FogModel::kBeam);
  EXPECT_TRUE(scenario.fusion.gating);
  ASSERT_EQ(scenario.lead.breakpoints.size(), 2U);
  EXPECT_EQ(scenario.lead.breakpoints[0].speed_mps, 5);
  EXPECT_EQ(scenario.lead.breakpoints[0].duration_s, SpeedBreakpoint{}.duration_s);
  EXPECT_EQ(scenario.lead.breakpoints[1].duration_s, 2.5);
  EXPECT_THAT(scenario.lead.recorded.speeds_mps, testing::ElementsAre(1, 2.5));
}

TEST(LoaderTest, TakesAWholeNumberWithAFractionPartForAnInteger) {
  EXPECT_EQ(ParseScenario(R"({"version": 1.0, "steps": 2e2})").steps, 200);
}

TEST(LoaderTest, TakesBothEndsOfARangeAndNothingBeyond) {
  EXPECT_EQ(ParseScenario(R"({"version": 1, "step_s": 0.001})").step_s, 0.001);
  EXPECT_EQ(ParseScenario(R"({"version": 1, "step_s": 1})").step_s, 1);
  EXPECT_EQ(DiagnosticsOf(R"({"version": 1, "step_s": 1.0000000000000002})").size(), 1U);
}

TEST(LoaderTest, ReportsAllMistakesInTheOrderOfTheFile) {
  const auto diagnostics = DiagnosticsOf(R"({"published": 1,
 "steps": 0, "fog": {"modle": 1,
 "bias_m": -1}, "version": 2})");
  std::vector<std::string> found;
  for (const Diagnostic& diagnostic : diagnostics) {
    found.push_back(std::to_string(diagnostic.line) + ":" + std::to_string(diagnostic.column) +
                    " " + diagnostic.rule + " " + diagnostic.pointer);
  }
  EXPECT_THAT(found, testing::ElementsAre("1:15 type /published", "2:11 range /steps",
                                          "2:22 unknown-key /fog/modle", "3:12 range /fog/bias_m",
                                          "3:28 range /version"));
}

TEST(LoaderTest, RefusesAnEmptyKeyWithoutASuggestion) {
  EXPECT_EQ(DiagnosticsOf(R"({"version": 1, "minimal_risk": {"": 1}})")[0].message,
            "unknown key; known here are \"deceleration_mps2\", \"jerk_mps3\"");
}

TEST(LoaderTest, PrintsTwentyMistakesAndTheNumberOfTheOthers) {
  std::string text = R"({"version": 1, "lead": {"recorded": {"speeds_mps": [0)";
  for (int i = 0; i < 25; ++i) text += ",\n-1";
  const std::string error = ErrorOf(text + "]}}}");
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 21);
  EXPECT_THAT(error, testing::HasSubstr("\n... and 5 more\n25 errors; "));
}

TEST(LoaderTest, StopsCountingMistakesOfAHostileFile) {
  std::string text = R"({"version": 1, "lead": {"recorded": {"speeds_mps": [0)";
  for (int i = 0; i < 500'000; ++i) text += ",[]";
  const std::string error = ErrorOf(text + "]}}}");
  EXPECT_THAT(error, testing::HasSubstr("\n... and 980 or more\n1000 or more errors; "));
}

TEST(LoaderTest, NeedsARecordingForARecordedLeader) {
  EXPECT_EQ(DiagnosticsOf(R"({"version": 1, "lead": {"profile": "recorded"}})")[0].rule, "needed");
  EXPECT_EQ(
      DiagnosticsOf(R"({"version": 1, "lead": {"profile": "recorded", "recorded": {"file": ""}}})")
          .size(),
      1U);
  EXPECT_TRUE(
      DiagnosticsOf(
          R"({"version": 1, "lead": {"profile": "recorded", "recorded": {"file": "a.csv"}}})")
          .empty());
  EXPECT_TRUE(
      DiagnosticsOf(
          R"({"version": 1, "lead": {"profile": "recorded", "recorded": {"speeds_mps": [1]}}})")
          .empty());
}

TEST(LoaderTest, NamesAFileThatCannotBeRead) {
  const std::filesystem::path folder = testing::TempDir();
  try {
    LoadScenario(folder / "no_such_scenario.json");
    FAIL();
  } catch (const ScenarioError& error) {
    EXPECT_EQ(error.what(), (folder / "no_such_scenario.json").string() +
                                ": error: cannot be read: No such file or directory");
    EXPECT_EQ(error.diagnostics()[0].rule, "file");
  }
  EXPECT_THROW(LoadScenario(folder), ScenarioError);
}

TEST(SchemaTest, IsTheCommittedFile) {
  EXPECT_EQ(FileText(std::filesystem::path(FOGLINE_SOURCE_DIR) / "scenario/scenario.schema.json"),
            ScenarioSchema())
      << "run: build/bin/fogline check --schema > scenario/scenario.schema.json";
}

TEST(PrintTest, WritesEqualScenariosAsEqualText) {
  const std::string text = PrintScenario(ParseScenario(R"({"version": 1, "steps": 7})"));
  EXPECT_EQ(text, PrintScenario(ParseScenario(R"({"steps": 7.0, "fog": {}, "version": 1})")));
  EXPECT_EQ(text, PrintScenario(ParseScenario(text)));
  EXPECT_THAT(text, testing::EndsWith("}\n"));
}

TEST(PrintTest, KeepsLongListsWithinTheLine) {
  Scenario scenario;
  scenario.lead.recorded.speeds_mps.assign(500, 18.01909091);
  std::istringstream lines(PrintScenario(scenario));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U);
}

TEST(ExplainTest, TellsMeaningRangeDefaultAndSource) {
  EXPECT_EQ(ExplainField("/acc/headway_s"),
            "/acc/headway_s\n"
            "  Meaning: Time gap T_hw, bumper to bumper, in d_r = T_hw v + d_0.\n"
            "  Allowed: a number in [0, 10] s\n"
            "  Default: 1.5 s\n"
            "  Source:  ISO 15622 offers 1.5 to 2.2 s\n");
}

TEST(ExplainTest, ListsTheChoicesWithTheirMeaning) {
  EXPECT_THAT(ExplainField("/fog/model"), testing::HasSubstr("\n    \"none\"            no fog\n"));
}

TEST(ExplainTest, ListsTheFieldsOfASectionAndOfTheWhole) {
  EXPECT_THAT(ExplainField("/minimal_risk"),
              testing::HasSubstr(
                  "/minimal_risk/jerk_mps3          a number in [0.1, 100] m/s3, default 1"));
  EXPECT_THAT(ExplainField("/"), testing::HasSubstr("    /world             The cars at step 0"));
  EXPECT_EQ(ExplainField("/"), ExplainField(""));
}

TEST(ExplainTest, TakesAnyIndexOfAList) {
  EXPECT_EQ(ExplainField("/published/7/si_pct"), ExplainField("/published/*/si_pct"));
}

TEST(ExplainTest, SuggestsAFieldForAWrongPointer) {
  EXPECT_EQ(test::ErrorOf([] { ExplainField("/fog/visibility"); }),
            "error: /fog/visibility: no such field; did you mean \"/fog/visibility_m\"?");
}

}  // namespace
}  // namespace fogline
