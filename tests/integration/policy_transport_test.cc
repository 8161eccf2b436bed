// Every policy has one digest, however the messages travel: it has a say in two processes, and each
// has an instance of its own.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

#include "scenario/scenario.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

class PolicyTransportTest : public testing::TestWithParam<std::size_t> {
 protected:
  static std::string_view Name(std::size_t row) { return ChoiceNames<Policy>::kNames[row]; }

  /// The LiDAR loses the car in step 15 or so; the wheel changes hands with all that is smooth.
  nlohmann::json Run(const std::string& transport) const {
    const Outcome outcome = RunCommand({Program("fogline"),
                                        "run",
                                        "scenario/dense_fog.json",
                                        "--json",
                                        "--quiet",
                                        "--transport",
                                        transport,
                                        "--log",
                                        folder_.File(transport + ".lcm"),
                                        "--set",
                                        "/steps=60",
                                        "--set",
                                        "/fog/start_s=1",
                                        "--set",
                                        "/fog/duration_s=4",
                                        "--set",
                                        "/arbitrator/policy=" + std::string(Name(GetParam())),
                                        "--set",
                                        "/arbitrator/transfer/profile=sigmoid",
                                        "--set",
                                        "/arbitrator/transfer/gate=true",
                                        "--set",
                                        "/arbitrator/transfer/hysteresis=sprt",
                                        "--set",
                                        "/arbitrator/transfer/min_dwell_s=1"});
    EXPECT_EQ(outcome.code, 0) << transport << ": " << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  ScratchFolder folder_;
};

TEST_P(PolicyTransportTest, HasTheSameDigestInOneProcessInMemoryAndOverTheNetwork) {
  const auto direct = Run("direct");
  ASSERT_EQ(direct["digest"].get<std::string>().size(), 64U);
  for (const char* transport : {"memq", "udpm"}) {
    const auto other = Run(transport);
    EXPECT_EQ(other["steps"], 60) << transport;
    EXPECT_EQ(other["digest"], direct["digest"]) << transport;
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheTable, PolicyTransportTest,
                         testing::Range<std::size_t>(0, ChoiceNames<Policy>::kNames.size()),
                         [](const auto& row) {
                           return std::string(ChoiceNames<Policy>::kNames[row.param]);
                         });

}  // namespace
}  // namespace fogline::test
