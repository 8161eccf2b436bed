// What `fogline check` says about the repository's scenarios: the shipped scenarios and those in
// scenario/bad.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

namespace fs = std::filesystem;

using test::Outcome;
using test::SourceDirectory;

std::string FileText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Runs `fogline check` in the repository's folder.
Outcome RunCheck(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{test::Program("fogline"), "check"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return test::RunCommand(command);
}

// The names, without their extension, of the files in scenario/bad that end in `extension`.
std::vector<std::string> BadNames(const std::string& extension) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(SourceDirectory() / "scenario/bad")) {
    if (entry.path().extension() == extension) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// The test runs in the repository's folder, so that error texts have the expected file names.
class BadScenarioTest : public testing::TestWithParam<std::string> {
 protected:
  BadScenarioTest() { fs::current_path(SourceDirectory()); }
  ~BadScenarioTest() override { fs::current_path(outside_); }

 private:
  fs::path outside_ = fs::current_path();
};

TEST_P(BadScenarioTest, IsToldWhatIsWrong) {
  const fs::path file = fs::path("scenario/bad") / (GetParam() + ".json");
  const fs::path expected = fs::path("scenario/bad") / (GetParam() + ".expected");
  try {
    LoadScenario(file);
    FAIL() << file << " was accepted";
  } catch (const ScenarioError& error) {
    EXPECT_EQ(error.what() + std::string("\n"), FileText(expected));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, BadScenarioTest, testing::ValuesIn(BadNames(".json")),
                         [](const auto& file) { return file.param; });

TEST(BadScenariosTest, AreThereForEveryRule) {
  EXPECT_GE(BadNames(".json").size(), 25U);
  EXPECT_EQ(BadNames(".json"), BadNames(".expected"));
  std::vector<std::string> rules;
  for (const std::string& name : BadNames(".json")) {
    try {
      LoadScenario(SourceDirectory() / "scenario/bad" / (name + ".json"));
    } catch (const ScenarioError& error) {
      for (const Diagnostic& diagnostic : error.diagnostics()) rules.push_back(diagnostic.rule);
    }
  }
  for (const char* rule : {"syntax", "too-large", "duplicate-key", "unknown-key", "missing-key",
                           "type", "range", "choice", "list-length", "text", "needed"}) {
    EXPECT_THAT(rules, testing::Contains(rule));
  }
}

TEST(CheckTest, ExitsWith2AndPrintsTheExpectedTextForABadFile) {
  const Outcome outcome = RunCheck({"scenario/bad/several_kinds_at_once.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err,
            FileText(SourceDirectory() / "scenario/bad/several_kinds_at_once.expected"));
}

TEST(CheckTest, SaysOkForTheShippedScenarios) {
  const Outcome outcome = RunCheck({"scenario/paper.json", "scenario/dense_fog.json"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "scenario/paper.json: ok\nscenario/dense_fog.json: ok\n");
  EXPECT_EQ(outcome.err, "");
}

TEST(CheckTest, ChecksTheRemainingFilesAfterABadOne) {
  const Outcome outcome = RunCheck({"scenario/bad/root_is_list.json", "scenario/paper.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "scenario/paper.json: ok\n");
}

TEST(CheckTest, PrintsTheSchemaThatIsCommitted) {
  const Outcome outcome = RunCheck({"--schema"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, FileText(SourceDirectory() / "scenario/scenario.schema.json"));
}

TEST(CheckTest, PrintsTheEffectiveScenario) {
  const Outcome outcome =
      RunCheck({"--print", "--set", "/arbitrator/threshold=0.8", "scenario/paper.json"});
  EXPECT_EQ(outcome.code, 0);
  const Scenario scenario =
      LoadScenario(SourceDirectory() / "scenario/paper.json", {"/arbitrator/threshold=0.8"});
  EXPECT_EQ(outcome.out, PrintScenario(scenario));
  EXPECT_EQ(scenario.arbitrator.threshold, 0.8);
}

TEST(CheckTest, NamesAnOverrideThatIsWrong) {
  const Outcome outcome =
      RunCheck({"scenario/paper.json", "--set", "/fog/bias_m=-1", "--set", "/steps=10"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            "--set /fog/bias_m=-1: error: /fog/bias_m: -1 is outside [0, 100] m\n"
            "1 error; what is allowed: fogline check --explain /fog/bias_m\n");
}

TEST(CheckTest, PrintsMistakesAsJson) {
  const Outcome outcome =
      RunCheck({"--json", "scenario/paper.json", "scenario/bad/range_number_above.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out,
            "[\n"
            "  {\n"
            "    \"file\": \"scenario/bad/range_number_above.json\",\n"
            "    \"line\": 4,\n"
            "    \"column\": 32,\n"
            "    \"pointer\": \"/world/host_speed_mps\",\n"
            "    \"rule\": \"range\",\n"
            "    \"message\": \"320 is outside [0, 70] m/s\"\n"
            "  }\n"
            "]\n");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(RunCheck({"--json", "scenario/paper.json"}).out, "[]\n");
}

TEST(CheckTest, ExplainsAField) {
  const Outcome outcome = RunCheck({"--explain", "/fog/visibility_m"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, ExplainField("/fog/visibility_m"));
  EXPECT_EQ(RunCheck({"--explain", "/fog/no"}).code, 2);
}

TEST(CheckTest, ExplainsWhereANumberComesFrom) {
  const Outcome outcome = RunCheck({"--explain", "/lidar/bias_m"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, testing::HasSubstr("\n  Source:  our choice, because "));
}

TEST(CheckTest, RefusesACommandLineWithoutSense) {
  EXPECT_EQ(RunCheck({}).code, 2);
  EXPECT_EQ(RunCheck({"--schema", "--print", "scenario/paper.json"}).code, 2);
  EXPECT_EQ(RunCheck({"--print", "scenario/paper.json", "scenario/dense_fog.json"}).code, 2);
}

TEST(CheckTest, HelpsWithin80ColumnsAndWithExamples) {
  const Outcome outcome = RunCheck({"--help"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, testing::HasSubstr("Examples:\n"));
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
}

TEST(RecordedLeadScenarioTest, HasTheRecordedSpeedAtEveryStep) {
  const fs::path file = SourceDirectory() / "scenario/recorded_lead.json";
  const Scenario scenario = LoadScenario(file);
  const std::vector<double>& speeds_mps = scenario.lead.recorded.speeds_mps;
  ASSERT_EQ(speeds_mps.size(), 7000U);
  EXPECT_EQ(speeds_mps.front(), 18.01909091);
  EXPECT_EQ(speeds_mps.back(), 19.30222222);
}

}  // namespace
}  // namespace fogline
