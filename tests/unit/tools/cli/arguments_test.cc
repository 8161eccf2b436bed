#include "tools/cli/arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/errors.h"
#include "tests/support/command.h"
#include "tests/support/environment_url.h"
#include "tests/support/input_errors.h"

namespace fogline::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

struct Printed {
  std::string out;
  std::string err;
};
Printed WhatIsPrinted(const std::function<void()>& call) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  call();
  std::fflush(stdout);
  return {.out = testing::internal::GetCapturedStdout(),
          .err = testing::internal::GetCapturedStderr()};
}

// ---- SCENARIO, --set, --seed

class ScenarioArgumentsTest : public testing::Test {
 protected:
  void Read(std::vector<std::string> words) {
    words.insert(words.begin(), (SourceDirectory() / "scenario/paper.json").string());
    app_.parse(std::vector(words.rbegin(), words.rend()));
  }
  CLI::App app_;
  const cli::ScenarioArguments arguments_{app_};
};

TEST_F(ScenarioArgumentsTest, AreTheFileWithItsOverridesAndItsSeed) {
  Read({"--set", "/arbitrator/threshold=0.8", "--set", "/steps=30", "--seed", "7"});
  const Scenario scenario = arguments_.Load();
  EXPECT_EQ(scenario.arbitrator.threshold, 0.8);
  EXPECT_EQ(scenario.steps, 30);
  EXPECT_EQ(scenario.seed, 7);
  EXPECT_EQ(arguments_.file().filename(), "paper.json");
}

TEST_F(ScenarioArgumentsTest, RefuseAScenarioThatNoRunCanHave) {
  Read({"--set", R"(/road/grade=[{"position_m":50,"grade":0},{"position_m":20,"grade":0.05}])"});
  EXPECT_THAT(ErrorOf([&] { arguments_.Load(); }), HasSubstr("/road/grade/1/position_m: "));
}

TEST_F(ScenarioArgumentsTest, RefuseAnOverrideOfAFieldThatTheVerbSets) {
  Read({"--set", "/arbitrator/threshold=0.8"});
  EXPECT_EQ(ErrorOf([&] { arguments_.RefuseOverrideOf("/arbitrator/threshold", "see there"); }),
            "error: --set /arbitrator/threshold: see there");
  EXPECT_EQ(ErrorOf([&] { arguments_.RefuseOverrideOf("/arbitrator", "see there"); }), "");
}

// ---- logs, seeds, JSON, builds

TEST(LogArgumentsTest, LeaveOutALogThatCannotBeRead) {
  std::vector<std::string> used;
  bool readable = true;
  const Printed printed = WhatIsPrinted([&] {
    readable = cli::ForEachReadable({"a.lcm", "b.lcm", "c.lcm"}, [&](const auto& log) {
      if (log == "b.lcm") throw InputError("b.lcm: error: torn");
      used.push_back(log);
    });
  });
  EXPECT_FALSE(readable);
  EXPECT_THAT(used, ElementsAre("a.lcm", "c.lcm"));
  EXPECT_EQ(printed.err, "b.lcm: error: torn\n");
  EXPECT_TRUE(cli::ForEachReadable({"a.lcm"}, [](const auto&) {}));
}

TEST(SeedArgumentsTest, ExplainASingleNumberThatMayBeMeantAsACount) {
  sweep::SeedRange seeds;
  const auto read = [&](const char* text) {
    return WhatIsPrinted([&] { seeds = cli::ReadSeeds(text); }).err;
  };
  EXPECT_EQ(read("100"), "--seeds 100 is the one seed 100; seeds 1 to 100 are --seeds 1:100\n");
  EXPECT_EQ(seeds.first, 100);
  EXPECT_EQ(seeds.last, 100);
  EXPECT_EQ(read("3:5"), "");
  EXPECT_EQ(seeds.count(), 3);
  EXPECT_EQ(read("1"), "");
  EXPECT_EQ(read("7:7"), "");
  EXPECT_NE(ErrorOf([] { cli::ReadSeeds("many"); }), "");
}

TEST(JsonArgumentsTest, PrintWhatJsonAndATerminalCanCarry) {
  const nlohmann::ordered_json json{{"file", "a\xff"}, {"text", "b\x7f"}};
  EXPECT_EQ(WhatIsPrinted([&] { cli::PrintJson(json, -1); }).out,
            "{\"file\":\"a\xef\xbf\xbd\",\"text\":\"b\\u007f\"}\n");
  EXPECT_EQ(WhatIsPrinted([&] {
              cli::PrintJson(nlohmann::ordered_json{{"a", 1}});
            }).out,
            "{\n  \"a\": 1\n}\n");
}

TEST(JsonArgumentsTest, RefuseTwoDocumentsOnStdout) {
  EXPECT_EQ(ErrorOf([] { cli::RefuseJsonBeside("/dev/stdout", "--out", true); }),
            "error: --json: --out /dev/stdout uses stdout already; give --out a file");
  EXPECT_EQ(ErrorOf([] { cli::RefuseJsonBeside("/dev/stdout", "--out", false); }), "");
  EXPECT_EQ(ErrorOf([] { cli::RefuseJsonBeside("out.csv", "--out", true); }), "");
}

TEST(JsonArgumentsTest, PrintRemarksWhereTheDocumentDoesNotGo) {
  const Printed beside_file = WhatIsPrinted([] { cli::PrintBeside("out.csv", "made\n"); });
  EXPECT_EQ(beside_file.out, "made\n");
  EXPECT_EQ(beside_file.err, "");
  const Printed beside_stdout = WhatIsPrinted([] { cli::PrintBeside("/dev/stdout", "made\n"); });
  EXPECT_EQ(beside_stdout.out, "");
  EXPECT_EQ(beside_stdout.err, "made\n");
}

TEST(JsonArgumentsTest, HaveABuildInHexadecimalDigits) {
  EXPECT_EQ(cli::BuildJson(0x2e), "000000000000002e");
  EXPECT_TRUE(cli::BuildJson(runtime::kUnknownBuild).is_null());
}

// ---- --lcm-url

class NetworkArgumentsTest : public testing::Test {
 protected:
  std::string Url(const std::vector<std::string>& words) {
    app_.parse(std::vector(words.rbegin(), words.rend()));
    return arguments_.Url();
  }
  const EnvironmentUrl environment_;
  CLI::App app_;
  const cli::NetworkArguments arguments_{app_, "to observe"};
};

TEST_F(NetworkArgumentsTest, AreTheNetworkOfTheCommandLineOrTheEnvironmentOrLcm) {
  EXPECT_EQ(Url({}), "udpm://239.255.76.67:7667?ttl=0");
  EXPECT_TRUE(arguments_.Follows());
  environment_.Set("udpm://239.255.76.67:7700");
  EXPECT_EQ(Url({}), "udpm://239.255.76.67:7700");
  EXPECT_EQ(Url({"--lcm-url", "tcpq://lab1"}), "tcpq://lab1");
  EXPECT_FALSE(arguments_.Follows());
}

TEST_F(NetworkArgumentsTest, RefuseWhatNoOtherProcessCanObserve) {
  EXPECT_THAT(
      ErrorOf([&] {
        Url({"--lcm-url", "memq://"});
      }),
      StartsWith(
          "error: --lcm-url memq://: other processes cannot look into the memory of a process; "));
  EXPECT_THAT(ErrorOf([&] {
                Url({"--lcm-url", "pigeon"});
              }),
              StartsWith("error: --lcm-url pigeon: no LCM URL such as "));
  environment_.Set("memq://");
  CLI::App app;
  const cli::NetworkArguments unsaid(app, "to observe");
  EXPECT_THAT(ErrorOf([&] { unsaid.Url(); }), StartsWith("error: LCM_DEFAULT_URL memq://: "));
}

}  // namespace
}  // namespace fogline::test
