// A run receives datagrams that are none of its messages. In the campaign they are 20,000 a second.
// In the plain tests, beside other work, they are up to 4,000 a second and at least 1,000 in all.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

// Simulated time of the scenario, seconds.
constexpr double kScenarioS = 50;

/// How long a run shall take, in seconds, if the campaign sets it. The campaign runs this test
/// alone on the machine, so only there it judges rates and times.
const char* const kCampaignSeconds = std::getenv("FOGLINE_TEST_SECONDS");
double Seconds(double usually) {
  return kCampaignSeconds != nullptr ? std::atof(kCampaignSeconds) : usually;
}

/// Datagrams per second. The campaign uses the rate that Fogline promises to withstand. The plain
/// tests use a rate that a machine with other work to do withstands.
const double kRateHz = kCampaignSeconds != nullptr ? 20'000 : 4'000;
/// The least number of datagrams that are sent in this time. The plain tests ask only for a visible
/// number.
double Plenty(double seconds) {
  return kCampaignSeconds != nullptr ? 0.9 * kRateHz * seconds : 1'000;
}

class HostileTrafficTest : public NetworkTest {
 protected:
  struct Ended {
    nlohmann::json result;  // of the run
    nlohmann::json sent;    // the hostile program's counts of sent datagrams
  };

  /// Makes a run that takes `seconds`. The network of its machine is full of hostile traffic from
  /// before the start. The run must succeed.
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
  // GIVEN that hostile datagrams were sent
  EXPECT_GT(sent["sent"], Plenty(seconds)) << sent;
  for (const char* kind :
       {"noise", "noise_on_a_channel", "not_finite", "wrong_step", "foreign_run", "wrong_type",
        "truncated", "oversized", "fragment", "request", "replayed"}) {
    EXPECT_GT(sent.value(kind, 0), kCampaignSeconds != nullptr ? 500 : 50) << kind;
  }
  // THEN the result is that of the undisturbed run
  EXPECT_EQ(result["digest"], Undisturbed());
  // AND it took little longer than its pace asks
  if (kCampaignSeconds != nullptr) {
    EXPECT_LT(result["wall_s"], 2 * seconds);
  }
  // AND the run counts each kind of refused datagram
  for (const char* kind : {"foreign", "malformed", "wrong_type", "not_finite", "out_of_window"}) {
    EXPECT_GT(result["refused"][kind], kCampaignSeconds != nullptr ? 500 : 50) << result["refused"];
  }
  // AND it names some of the senders that claimed to be of other runs
  EXPECT_FALSE(result["strangers"].empty());
}

/// Floods of the kinds that cost most: requests that must be answered, fragments that LCM's parser
/// handles badly, and copies of genuine messages.
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
