// A run under datagrams that are none of its messages: 20,000 a second in the campaign, up to 4,000
// where other work is done, and then at least 1,000 in all.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

// Simulated time of the scenario.
constexpr double kScenarioS = 50;

/// How long a run shall take: the campaign asks for more. It has the machine to itself, too, so
/// that it can judge rates and times.
const char* const kCampaignSeconds = std::getenv("FOGLINE_TEST_SECONDS");
double Seconds(double usually) {
  return kCampaignSeconds != nullptr ? std::atof(kCampaignSeconds) : usually;
}

/// A rate that a machine bears which has other work to do, and the one that is promised.
const double kRateHz = kCampaignSeconds != nullptr ? 20'000 : 4'000;
/// What is sent in this time at least; where other work is done, enough to be seen.
double Plenty(double seconds) {
  return kCampaignSeconds != nullptr ? 0.9 * kRateHz * seconds : 1'000;
}

class HostileTrafficTest : public NetworkTest {
 protected:
  struct Ended {
    nlohmann::json result;  // of the run
    nlohmann::json sent;    // at the run
  };

  /// A run of so many seconds on a machine whose network is full of hostile traffic since before it
  /// began. It must succeed.
  /// @param more arguments of the hostile program
  Ended RunUnder(std::vector<std::string> more, double seconds) {
    const Machine machine("target");
    machine.RouteMulticastToItself();
    more.insert(more.begin(), {Program("hostile_traffic"), "--port", "7700", "--rate",
                               std::to_string(kRateHz), "--seconds", "600"});
    Background hostile(machine.On(more));
    Background run(machine.On(Run({"--lcm-url", "udpm://239.255.76.67:7700?ttl=0", "--pace",
                                   std::to_string(kScenarioS / seconds)})));
    EXPECT_EQ(run.Wait(std::chrono::seconds(200)), 0) << run.Err();
    hostile.Signal(SIGTERM);
    EXPECT_EQ(hostile.Wait(), 0) << hostile.Err();
    return {ResultOf(run), nlohmann::json::parse(hostile.Out(), nullptr, false)};
  }
};

TEST_F(HostileTrafficTest, ChangesNoResultAndIsRefusedByKind) {
  const double seconds = Seconds(4);
  const auto [result, sent] = RunUnder({}, seconds);
  // GIVEN that it was there
  EXPECT_GT(sent["sent"], Plenty(seconds)) << sent;
  for (const char* kind :
       {"noise", "noise_on_a_channel", "not_finite", "wrong_step", "foreign_run", "wrong_type",
        "truncated", "oversized", "fragment", "request", "replayed"}) {
    EXPECT_GT(sent.value(kind, 0), kCampaignSeconds != nullptr ? 500 : 50) << kind;
  }
  // THEN the result is that of the undisturbed run
  EXPECT_EQ(result["digest"], Undisturbed());
  // AND it took no longer than its pace wants, but for moments
  if (kCampaignSeconds != nullptr) {
    EXPECT_LT(result["wall_s"], 2 * seconds);
  }
  // AND what was refused is counted by its kind
  for (const char* kind : {"foreign", "malformed", "wrong_type", "not_finite", "out_of_window"}) {
    EXPECT_GT(result["refused"][kind], kCampaignSeconds != nullptr ? 500 : 50) << result["refused"];
  }
  // AND of those who claimed to be of other runs a few are named
  EXPECT_FALSE(result["strangers"].empty());
}

/// Floods of the kinds that cost most: what must be answered, what LCM's parser takes amiss, and
/// what was true a moment ago.
class FloodTest : public HostileTrafficTest, public testing::WithParamInterface<std::string> {};

TEST_P(FloodTest, ChangesNoResult) {
  const double seconds = Seconds(1.5);
  const auto [result, sent] = RunUnder({"--only", GetParam()}, seconds);
  EXPECT_GT(sent.value(GetParam(), 0), Plenty(seconds)) << sent;
  EXPECT_EQ(result["digest"], Undisturbed());
}

INSTANTIATE_TEST_SUITE_P(Of, FloodTest, testing::Values("request", "fragment", "replayed"),
                         [](const auto& kind) { return kind.param; });

}  // namespace
}  // namespace fogline::test
