// Every shipped scenario has one digest on all transports.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

/// Names of the scenario files, without ".json".
std::vector<std::string> ShippedScenarios() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SourceDirectory() / "scenario")) {
    const std::filesystem::path& file = entry.path();
    if (file.extension() == ".json" && file.stem().extension() != ".schema") {
      names.push_back(file.stem().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

class TransportTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    std::ifstream in(SourceDirectory() / File());
    const auto scenario = nlohmann::json::parse(in);
    const auto module = ProgramDirectory().parent_path() / "lib/fogline/sumo.so";
    if (scenario.value("/lead/profile"_json_pointer, "") == "sumo" &&
        !std::filesystem::exists(module)) {
      GTEST_SKIP() << "this build has no SUMO: no " << module;
    }
    const std::string recording = scenario.value("/lead/recorded/file"_json_pointer, "");
    if (recording.empty()) return;
    const auto file = SourceDirectory() / "scenario" / recording;
    ASSERT_TRUE(std::filesystem::exists(file)) << "no recorded driving at " << file;
    // A run of a whole recording takes many minutes. Its first 100 s are enough for this test.
    more_ = {"--set", "/steps=1000"};
  }

  static std::string File() { return "scenario/" + GetParam() + ".json"; }

  nlohmann::json Run(const std::string& transport) {
    std::vector<std::string> command{
        Program("fogline"), "run",     File(),
        "--json",           "--quiet", "--transport",
        transport,          "--log",   folder_.File(transport + ".lcm")};
    command.insert(command.end(), more_.begin(), more_.end());
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 0) << transport << ": " << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  ScratchFolder folder_;
  std::vector<std::string> more_;
};

TEST_P(TransportTest, HasTheSameDigestAndMeasuresInOneProcessInMemoryAndOverTheNetwork) {
  const auto direct = Run("direct");
  ASSERT_EQ(direct["digest"].get<std::string>().size(), 64U);
  for (const char* transport : {"memq", "udpm", "tcpq"}) {
    const auto other = Run(transport);
    EXPECT_EQ(other["steps"], direct["steps"]) << transport;
    EXPECT_EQ(other["digest"], direct["digest"]) << transport;
    EXPECT_EQ(other["metrics"], direct["metrics"]) << transport;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, TransportTest, testing::ValuesIn(ShippedScenarios()),
                         [](const auto& scenario) { return scenario.param; });

TEST(VerifyTest, IsRefusedForARunThatHasNothingToCompare) {
  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{"run", "scenario/paper.json", "--transport", "direct"},
        {"table", "scenario/paper.json"}}) {
    std::vector<std::string> command{Program("fogline")};
    command.insert(command.end(), verb.begin(), verb.end());
    command.emplace_back("--verify");
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_EQ(outcome.err, "fogline " + verb.front() +
                               ": error: --verify: a run with --transport direct is one process "
                               "and has no messages that could be altered\n");
  }
}

}  // namespace
}  // namespace fogline::test
