// Logs and scenarios of older versions of Fogline, kept in the folder `kept`. Each file gives the
// results that its own version computed, or is refused with the name of the version that wrote it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

#include "services/runtime/process/version.h"
#include "tests/integration/logs/log_integrity_fixture.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

const std::string kFolder = "tests/integration/logs/kept/";
/// A log of version 0.1.0. It has a seal. Its digest is the one that 0.1.0 printed.
const std::string kLog = kFolder + "0.1.0.lcm";
constexpr const char* kDigest = "ab994b1e784025877d54a09ec67bf5706aab942d556ec08659f0806d69a457a2";
/// A log of an early state of 0.1.0, which had no seals and another run_t.
const std::string kEarlyLog = kFolder + "early.lcm";

std::string ThisVersion() { return "this is Fogline " + std::string(runtime::Version()); }

/// Whether, in a log, RUN and the messages of the steps have the types of this build.
bool HasTypesOfThisBuild(const std::string& log) {
  log::EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    const std::size_t channel = ChannelNamed(event->channel);
    if (channel == kNumChannels) continue;
    if (runtime::ReadInt64(event->data, 0) != runtime::FingerprintOf(channel)) return false;
  }
  return true;
}

/// Makes a copy of the log of 0.1.0 that looks like the log of a version with another type of
/// TRACK: the fingerprints in TRACK and in RUN differ. The copy has no seal.
void WriteLogOfOtherTypes(const std::string& log) {
  Rewrite(SourceDirectory() / kLog, log, [](std::string_view channel, Payload& payload) {
    if (channel == "TRACK") payload.front() ^= 1U;
    run_t run{};
    if (channel == "RUN" && runtime::Decode(payload, run)) {
      run.type_fingerprint ^= 1;
      runtime::Encode(run, payload);
    }
  });
}

Words VerbsOn(const std::string& verb, const std::string& log, const std::string& out) {
  Words command{Program("fogline"), verb, log};
  if (verb == "replay") command.emplace_back("--all");
  if (verb == "diff") command.push_back(log);
  if (verb == "export") command.insert(command.end(), {"--out", out + ".mat"});
  if (verb == "report") command.insert(command.end(), {"--output", out + ".html"});
  return command;
}

TEST(KeptLogTest, OfTheLastVersionIsReadWithItsDigestOrRefusedWithItsName) {
  const Outcome digest = RunCommand({Program("fogline"), "digest", kLog, "--json"});
  if (HasTypesOfThisBuild(SourceDirectory() / kLog)) {
    ASSERT_EQ(digest.code, 0) << digest.err;
    EXPECT_EQ(nlohmann::json::parse(digest.out)[0]["digest"], kDigest);
  } else {
    EXPECT_EQ(digest.code, 2);
    EXPECT_EQ(digest.err, kLog + ": error: written by Fogline 0.1.0 with other message types; " +
                              ThisVersion() + "\n");
  }
}

TEST(KeptLogTest, OfAnEarlyStateIsRefusedWithItsNameByEveryVerb) {
  const ScratchFolder folder;
  for (const char* verb :
       {"metrics", "digest", "events", "replay", "diff", "export", "report", "compare"}) {
    SCOPED_TRACE(verb);
    Words command = VerbsOn(verb, kEarlyLog, folder.File("out"));
    if (std::string(verb) == "compare") command.emplace_back("scenario/data/acc_platoon_a.csv");
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(kEarlyLog +
                                       ": error: written by Fogline 0.1.0 (early "
                                       "state) with other message types; " +
                                       ThisVersion()));
  }
  const Outcome resumed = RunCommand({Program("fogline"), "run", "--resume", kEarlyLog});
  EXPECT_EQ(resumed.code, 2);
  EXPECT_EQ(resumed.err, kEarlyLog +
                             ": error: --resume: the log was made with other message types, "
                             "by Fogline 0.1.0 (early state)\n");
}

TEST(KeptLogTest, WithAnotherTypeOfAStepIsRefusedAndNotReadWrongly) {
  const ScratchFolder folder;
  const std::string log = folder.File("other.lcm");
  WriteLogOfOtherTypes(log);
  const Outcome metrics = RunCommand({Program("fogline"), "metrics", log});
  EXPECT_EQ(metrics.code, 2);
  if (HasTypesOfThisBuild(SourceDirectory() / kLog)) {
    EXPECT_EQ(metrics.err, log +
                               ": error: written by another version of Fogline with other message "
                               "types; " +
                               ThisVersion() + "\n");
  }
}

TEST(KeptScenarioTest, OfTheLastVersionHasTheResultOfItsTime) {
  // The file has every field of a scenario of version 0.1.0, and the values of paper.json.
  const Outcome run = RunCommand(
      {Program("fogline"), "run", kFolder + "0.1.0.json", "--transport", "direct", "--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["digest"],
            "90ca471057e464abfe9d7ecdf77847b16f1ad324c53bc77693fede234c4e8fd6");
}

TEST(KeptScenarioTest, OfALaterFormatIsRefusedWithBothNumbers) {
  const ScratchFolder folder;
  const std::string scenario = folder.File("later.json");
  std::ofstream(scenario) << "{\"version\": 2}\n";
  const Outcome check = RunCommand({Program("fogline"), "check", scenario});
  EXPECT_EQ(check.code, 2);
  EXPECT_THAT(check.err, HasSubstr("/version: must be 1, not 2"));
}

}  // namespace
}  // namespace fogline::test
