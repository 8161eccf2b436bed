// With each policy, a run has the same digest on all transports. Two roles use a policy that
// selects sensors: arbitrator and fusion. Each role has its own instance of the policy.
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/sections/decision.h"
#include "scenario/sections/scenario.h"
#include "tests/integration/runs/transports.h"

namespace fogline::test {
namespace {

/// Settings: the LiDAR sees no car from about step 15 on, and transfers between automation and
/// human are smooth.
const std::vector<std::string> kFogWithSmoothTransfers{"/steps=60",
                                                       "/fog/start_s=1",
                                                       "/fog/duration_s=4",
                                                       "/arbitrator/transfer/profile=sigmoid",
                                                       "/arbitrator/transfer/gate=true",
                                                       "/arbitrator/transfer/hysteresis=sprt",
                                                       "/arbitrator/transfer/min_dwell_s=1"};

void ExpectOneDigest(std::string_view policy, const std::vector<std::string>& more = {}) {
  const ScratchFolder folder;
  std::vector<std::string> fields = kFogWithSmoothTransfers;
  fields.push_back("/arbitrator/policy=" + std::string(policy));
  fields.insert(fields.end(), more.begin(), more.end());
  ExpectTheSameOnAnyTransport(
      [&](const std::string& transport) {
        return RunOn(transport, "scenario/dense_fog.json", folder.File(transport + ".lcm"), fields);
      },
      60);
}

class PolicyTransportTest : public testing::TestWithParam<std::size_t> {};

TEST_P(PolicyTransportTest, HasTheSameDigestInOneProcessInMemoryAndOverTheNetwork) {
  ExpectOneDigest(ChoiceNames<Policy>::kNames[GetParam()]);
}

INSTANTIATE_TEST_SUITE_P(OfTheTable, PolicyTransportTest,
                         testing::Range<std::size_t>(0, ChoiceNames<Policy>::kNames.size()),
                         [](const auto& row) {
                           return std::string(ChoiceNames<Policy>::kNames[row.param]);
                         });

TEST(PolicyOnAPosteriorTest, HasTheSameDigestInOneProcessInMemoryAndOverTheNetwork) {
  ExpectOneDigest("bayes",
                  {"/arbitrator/measure=lidar_modes", "/arbitrator/measure_scale=probability"});
}

TEST(PolicyThatSharesTest, HasOneDigestAlsoWithADriverWhoMustBeAsked) {
  ExpectOneDigest("blend",
                  {"/arbitrator/take_over/mode=requested", "/arbitrator/take_over/time/mean_s=1",
                   "/arbitrator/take_over/time/std_s=0.01"});
}

TEST(HandBackByTheFusionTest, HasTheSameDigestInOneProcessInMemoryAndOverTheNetwork) {
  ExpectOneDigest(
      "traded", {"/arbitrator/transfer/hand_back=fusion", "/arbitrator/transfer/hand_back_s=0.5"});
}

TEST(PolicyOnAPosteriorTest, IsRefusedBeforeTheRunForAMeasureThatIsNone) {
  for (const char* transport : {"direct", "udpm"}) {
    const Outcome outcome =
        RunCommand({Program("fogline"), "run", "scenario/dense_fog.json", "--transport", transport,
                    "--set", "/arbitrator/measure_scale=probability"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err,
              "scenario/dense_fog.json: error: /arbitrator/measure_scale: \"probability\" needs a "
              "measure whose score is a probability, such as \"lidar_modes\"; /arbitrator/measure "
              "is \"doc\"\n");
  }
}

}  // namespace
}  // namespace fogline::test
