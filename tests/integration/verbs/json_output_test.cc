// Each verb of `fogline` with the option --json prints one JSON document to stdout, and nothing
// else.
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"
#include "tests/support/verbs.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The log of a run behind a recorded leader, because `compare` needs such a log. All verbs that
/// read a log read this log.
class JsonOutputTest : public testing::Test {
 protected:
  JsonOutputTest() : log_(folder_.File("run.lcm")) {
    const Outcome run = RunCommand({Program("fogline"), "run", "scenario/recorded_lead.json",
                                    "--set", "/steps=20", "--transport", "direct", "--log", log_});
    EXPECT_EQ(run.code, 0) << run.err;
  }

  /// The arguments of each verb.
  std::map<std::string, std::vector<std::string>> Calls() const {
    const std::string paper = "scenario/paper.json";
    const std::string url = runtime::FreshMulticastUrl();
    return {
        {"run", {paper, "--set", "/steps=20", "--transport", "memq", "--log", File("memq.lcm")}},
        {"table", {paper, "--seeds", "1:2"}},
        {"sweep", {paper, "--seeds", "1:2", "--out", File("sweep.csv")}},
        {"calibrate",
         {paper, "--free", "/fog/bias_m=0.2:0.3", "--seeds", "1:2", "--evaluations", "2"}},
        {"study", {"transfer", "--seeds", "1:2", "--out", File("study")}},
        {"metrics", {log_}},
        {"compare", {log_, "scenario/data/acc_platoon_a.csv"}},
        {"report", {log_, "--output", File("report.html")}},
        {"digest", {log_}},
        {"diff", {log_, log_}},
        {"events", {log_}},
        {"replay", {log_, "--all"}},
        {"export", {log_, "--out", File("export")}},
        {"graph", {}},
        {"check", {paper}},
        {"top", {"--once", "--interval", "0.1", "--lcm-url", url}},
        {"record", {File("all.lcm"), "--for", "0.1", "--lcm-url", url}},
        {"doctor", {"--lcm-url", url}},
        {"keygen", {File("test.key")}},
    };
  }
  std::string File(const std::string& name) const { return folder_.File(name); }

  ScratchFolder folder_;
  std::string log_;
};

TEST_F(JsonOutputTest, IsOneDocumentForEveryVerbThatReports) {
  for (auto [verb, arguments] : Calls()) {
    SCOPED_TRACE(verb);
    arguments.insert(arguments.begin(), {Program("fogline"), verb});
    arguments.emplace_back("--json");
    const Outcome outcome = RunCommand(arguments);
    // doctor may also end with exit code 1.
    EXPECT_TRUE(outcome.code == 0 || (verb == "doctor" && outcome.code == 1)) << outcome.err;
    EXPECT_TRUE(nlohmann::json::accept(outcome.out)) << outcome.out;
  }
}

TEST_F(JsonOutputTest, IsOfferedByEveryVerbButThoseThatExplainOrShow) {
  const auto calls = Calls();
  for (const std::string& verb : Verbs()) {
    SCOPED_TRACE(verb);
    const std::string help = RunCommand({Program("fogline"), verb, "--help"}).out;
    // Calls() lacks `drive`, because this verb needs a terminal. keys_test.cc calls it.
    const bool reports = calls.contains(verb) || verb == "drive";
    EXPECT_THAT(help, reports ? testing::Matcher<std::string>(HasSubstr("\n  --json "))
                              : Not(HasSubstr("--json")));
  }
}

TEST_F(JsonOutputTest, NamesThePageAndTheRunsOfAReport) {
  const std::string page = File("report.html");
  const Outcome outcome =
      RunCommand({Program("fogline"), "report", log_, "--output", page, "--json"});
  const auto document = nlohmann::json::parse(outcome.out, nullptr, false);
  EXPECT_EQ(document["report"], page);
  EXPECT_EQ(document["png"], nullptr);
  ASSERT_EQ(document["runs"].size(), 1U);
  EXPECT_EQ(document["runs"][0]["log"], log_);
  EXPECT_EQ(document["runs"][0]["seed"], 1);
  EXPECT_EQ(document["runs"][0]["complete"], true);
}

TEST_F(JsonOutputTest, NamesTheFileOfAKey) {
  const Outcome outcome = RunCommand({Program("fogline"), "keygen", File("lab.key"), "--json"});
  EXPECT_EQ(nlohmann::json::parse(outcome.out, nullptr, false)["file"], File("lab.key"));
}

}  // namespace
}  // namespace fogline::test
