// A driver with human weaknesses. The digest is the same on every transport, even if the driver and
// the arbitrator read each other's messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

#include "tests/integration/runs/transports.h"

namespace fogline::test {
namespace {

using Words = std::vector<std::string>;

/// Settings of a short run with fog at its beginning. The driver takes over in the fog.
const Words kFogForTheDriver{"/steps=60",      "/fog/model=beam",   "/fog/visibility_m=40",
                             "/fog/start_s=1", "/fog/duration_s=3", "/arbitrator/threshold=0.5"};

struct Weakness {
  std::string name;
  Words fields;
};

const std::vector<Weakness> kWeaknesses{
    {"Iidm", {"/human/following=iidm"}},
    {"AccIdm", {"/human/following=acc_idm"}},
    {"FogSight", {"/human/sight=fog"}},
    {"Misjudges", {"/human/misjudges=true"}},
    {"LosesAwareness", {"/human/loses_awareness=true"}},
    {"All",
     {"/human/following=acc_idm", "/human/sight=fog", "/human/misjudges=true",
      "/human/loses_awareness=true"}},
};

class HumanDriverTest : public testing::Test {
 protected:
  /// @param more further arguments
  nlohmann::json Run(const std::string& transport, const Words& fields, const Words& more = {}) {
    Words all = kFogForTheDriver;
    all.insert(all.end(), fields.begin(), fields.end());
    return RunOn(transport, "scenario/paper.json", folder_.File(transport + ".lcm"), all, more);
  }

  ScratchFolder folder_;
};

class HumanDriverOnTransportsTest : public HumanDriverTest,
                                    public testing::WithParamInterface<Weakness> {};

TEST_P(HumanDriverOnTransportsTest, HasTheSameDigestInOneProcessInMemoryAndOverTheNetwork) {
  const auto direct = ExpectTheSameOnAnyTransport(
      [this](const std::string& transport) { return Run(transport, GetParam().fields); }, 60);
  EXPECT_NE(direct["digest"], Run("direct", {})["digest"]) << "it makes a difference";
}

INSTANTIATE_TEST_SUITE_P(With, HumanDriverOnTransportsTest, testing::ValuesIn(kWeaknesses),
                         [](const auto& weakness) { return weakness.param.name; });

TEST_F(HumanDriverTest, WithAllWeaknessesHasTheSameDigestOnABadNetwork) {
  Words all = kWeaknesses.back().fields;
  all.emplace_back("/steps=40");
  const auto good = Run("direct", all);
  for (const char* transport : {"memq", "udpm"}) {
    const auto bad =
        Run(transport, all,
            {"--stall-timeout", "30", "--faults", "loss=0.3,duplicate=0.1,reorder=0.1,delay_ms=5"});
    EXPECT_EQ(bad["digest"], good["digest"]) << transport;
    EXPECT_GT(bad["repairs"], 100) << "was anything lost?";
  }
}

TEST_F(HumanDriverTest, WithATooLongReactionTimeIsRefusedBeforeTheRunStarts) {
  const Outcome outcome =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                  "--set", "/human/misjudges=true", "--set", "/step_s=0.003"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  EXPECT_THAT(outcome.err,
              testing::HasSubstr("/step_s: 0.003 s is too short for the driver: human driver: the "
                                 "reaction time is longer than 254 steps"));
}

}  // namespace
}  // namespace fogline::test
