// The scenarios of the repository as `fogline check` sees them: the shipped ones and scenario/bad.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <sys/wait.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/loader.h"

namespace fogline {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = FOGLINE_SOURCE_DIR;
const fs::path kProgram = fs::path(FOGLINE_BINARY_DIR) / "bin/fogline";

std::string FileText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Outcome {
  int exit_code;
  std::string output;
};

// Runs `fogline check` in the repository's folder; `redirection` says what of it to catch.
Outcome RunCheck(const std::string& arguments, const std::string& redirection) {
  const std::string command = "cd '" + kSource.string() + "' && '" + kProgram.string() +
                              "' check " + arguments + " " + redirection;
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  return {.exit_code = WEXITSTATUS(pclose(pipe)), .output = output};
}

// Names of the files in scenario/bad that end in `extension`, without it.
std::vector<std::string> BadNames(const std::string& extension) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kSource / "scenario/bad")) {
    if (entry.path().extension() == extension) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class BadScenarioTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { fs::current_path(kSource); }
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
                         [](const auto& info) { return info.param; });

TEST(BadScenariosTest, AreThereForEveryRule) {
  EXPECT_GE(BadNames(".json").size(), 25U);
  EXPECT_EQ(BadNames(".json"), BadNames(".expected"));
  fs::current_path(kSource);
  std::vector<std::string> rules;
  for (const std::string& name : BadNames(".json")) {
    try {
      LoadScenario("scenario/bad/" + name + ".json");
    } catch (const ScenarioError& error) {
      for (const Mistake& mistake : error.mistakes()) rules.push_back(mistake.rule);
    }
  }
  for (const char* rule : {"syntax", "too-large", "duplicate-key", "unknown-key", "missing-key",
                           "type", "range", "choice", "list-length", "text", "needed"}) {
    EXPECT_THAT(rules, testing::Contains(rule));
  }
}

TEST(CheckTest, ExitsWith2AndPrintsTheExpectedTextForABadFile) {
  const Outcome outcome = RunCheck("scenario/bad/several_kinds_at_once.json", "2>&1 >/dev/null");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.output, FileText(kSource / "scenario/bad/several_kinds_at_once.expected"));
}

TEST(CheckTest, SaysOkForTheShippedScenarios) {
  const Outcome outcome = RunCheck("scenario/paper.json scenario/dense_fog.json", "2>&1");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, "scenario/paper.json: ok\nscenario/dense_fog.json: ok\n");
}

TEST(CheckTest, ChecksTheRemainingFilesAfterABadOne) {
  const Outcome outcome =
      RunCheck("scenario/bad/root_is_list.json scenario/paper.json", "2>/dev/null");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.output, "scenario/paper.json: ok\n");
}

TEST(CheckTest, PrintsTheSchemaThatIsCommitted) {
  const Outcome outcome = RunCheck("--schema", "2>&1");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, FileText(kSource / "scenario/scenario.schema.json"));
}

TEST(CheckTest, PrintsTheEffectiveScenario) {
  const Outcome outcome =
      RunCheck("--print --set /arbitrator/threshold=0.8 scenario/paper.json", "2>&1");
  EXPECT_EQ(outcome.exit_code, 0);
  const Scenario scenario =
      LoadScenario(kSource / "scenario/paper.json", {"/arbitrator/threshold=0.8"});
  EXPECT_EQ(outcome.output, PrintScenario(scenario));
  EXPECT_EQ(scenario.arbitrator.threshold, 0.8);
}

TEST(CheckTest, PrintsMistakesAsJson) {
  const Outcome outcome =
      RunCheck("--json scenario/paper.json scenario/bad/range_number_above.json", "2>&1");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.output,
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
  EXPECT_EQ(RunCheck("--json scenario/paper.json", "2>&1").output, "[]\n");
}

TEST(CheckTest, ExplainsAField) {
  const Outcome outcome = RunCheck("--explain /fog/visibility_m", "2>&1");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, ExplainField("/fog/visibility_m"));
  EXPECT_EQ(RunCheck("--explain /fog/no", "2>&1").exit_code, 2);
}

TEST(CheckTest, RefusesACommandLineWithoutSense) {
  EXPECT_EQ(RunCheck("", "2>&1").exit_code, 2);
  EXPECT_EQ(RunCheck("--schema --print scenario/paper.json", "2>&1").exit_code, 2);
  EXPECT_EQ(RunCheck("--print scenario/paper.json scenario/dense_fog.json", "2>&1").exit_code, 2);
}

TEST(CheckTest, HelpsWithin80ColumnsAndWithExamples) {
  const Outcome outcome = RunCheck("--help", "2>&1");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, testing::HasSubstr("Examples:\n"));
  EXPECT_THAT(outcome.output, testing::Not(testing::ContainsRegex("[^\n]{81}")));
}

TEST(RecordedLeadScenarioTest, HasTheRecordedSpeedAtEveryStep) {
  const fs::path file = kSource / "scenario/recorded_lead.json";
  const fs::path data = kSource.parent_path() / "shared/data/acc_platoon_a.csv";
  if (!fs::exists(data)) GTEST_SKIP() << "the recording is not there: " << data;
  const Scenario scenario = LoadScenario(file);
  const std::vector<double>& speeds_mps = scenario.lead.recorded.speeds_mps;
  ASSERT_EQ(speeds_mps.size(), 7000U);
  EXPECT_EQ(speeds_mps.front(), 18.01909091);
  EXPECT_EQ(speeds_mps.back(), 19.30222222);
}

}  // namespace
}  // namespace fogline
