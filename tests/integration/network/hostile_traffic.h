// A run on a network that also has datagrams of a hostile program.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/network_test.h"

namespace fogline::test {

// Simulated time of the scenario, seconds.
inline constexpr double kScenarioS = 50;

/// How much hostile traffic a run has, and for how long.
struct Hostility {
  double seconds;       // duration of the run
  double rate_hz;       // datagrams per second
  double least_sent;    // least number of sent datagrams
  int least_of_a_kind;  // least number of each kind, both of sent and of refused datagrams
  bool alone = false;   // whether the test is alone on the machine, so that times can be judged
};

class HostileTrafficTest : public NetworkTest {
 protected:
  struct Ended {
    nlohmann::json result;  // of the run
    nlohmann::json sent;    // the hostile program's counts of sent datagrams
  };

  /// Makes a run on a machine whose network already has hostile traffic when the run starts. The
  /// run must succeed.
  /// @param more arguments of the hostile program
  Ended RunUnder(std::vector<std::string> more, const Hostility& hostility) {
    const Machine machine("target");
    machine.RouteMulticastToItself();
    more.insert(more.begin(), {Program("hostile_traffic"), "--port", "7700", "--rate",
                               std::to_string(hostility.rate_hz), "--seconds", "600"});
    // A real attacker has a machine of its own, and takes no processor time from the run. So on a
    // busy machine, the hostile program gets a lower priority than the run.
    if (!hostility.alone) more.insert(more.begin(), {"nice", "-n", "10"});
    Background hostile(machine.On(more));
    Background run(machine.On(Run({"--lcm-url", "udpm://239.255.76.67:7700?ttl=0", "--pace",
                                   std::to_string(kScenarioS / hostility.seconds)})));
    EXPECT_EQ(run.Wait(2 * kPatience), 0) << run.Err();
    hostile.Signal(SIGTERM);
    EXPECT_EQ(hostile.Wait(), 0) << hostile.Err();
    return {ResultOf(run), nlohmann::json::parse(hostile.Out(), nullptr, false)};
  }

  /// Calls RunUnder(). On a busy machine the hostile program may send too few datagrams during the
  /// run, and the run may receive too few of them. Then a second and a third run follow, each four
  /// times as long as the run before.
  /// @param counted the kind of which enough must be sent, or "sent" for all kinds together
  /// @param refused the kinds of which enough must be refused
  Ended RunUnderEnough(const std::vector<std::string>& more, const std::string& counted,
                       const std::vector<std::string>& refused, Hostility hostility) {
    const auto enough = [&](const Ended& ended) {
      return ended.sent.value(counted, 0) > hostility.least_sent &&
             std::ranges::all_of(refused, [&](const std::string& kind) {
               return ended.result["refused"][kind] > hostility.least_of_a_kind;
             });
    };
    const int runs = hostility.alone ? 1 : 3;
    Ended ended = RunUnder(more, hostility);
    for (int i = 1; i < runs && !enough(ended); ++i) {
      hostility.seconds *= 4;
      ended = RunUnder(more, hostility);
    }
    return ended;
  }

  /// Hostile traffic of all kinds.
  void ExpectNoResultChangesAndEachKindIsRefused(const Hostility& hostility) {
    const std::vector<std::string> refused{"foreign", "malformed", "wrong_type", "not_finite",
                                           "out_of_window"};
    const auto [result, sent] = RunUnderEnough({}, "sent", refused, hostility);
    // GIVEN that hostile datagrams were sent
    EXPECT_GT(sent["sent"], hostility.least_sent) << sent;
    for (const char* kind :
         {"noise", "noise_on_a_channel", "not_finite", "wrong_step", "foreign_run", "wrong_type",
          "truncated", "oversized", "fragment", "request", "replayed"}) {
      EXPECT_GT(sent.value(kind, 0), hostility.least_of_a_kind) << kind;
    }
    // THEN the result is that of the undisturbed run
    EXPECT_EQ(result["digest"], Undisturbed());
    // AND the run took less than twice the time that its pace demands
    if (hostility.alone) {
      EXPECT_LT(result["wall_s"], 2 * hostility.seconds);
    }
    // AND the run counts each kind of refused datagram
    for (const std::string& kind : refused) {
      EXPECT_GT(result["refused"][kind], hostility.least_of_a_kind) << result["refused"];
    }
    // AND the run names some of the senders that pretended to belong to other runs
    EXPECT_FALSE(result["strangers"].empty());
  }

  /// Hostile traffic of one kind.
  void ExpectFloodChangesNoResult(const std::string& kind, const Hostility& hostility) {
    const auto [result, sent] = RunUnderEnough({"--only", kind}, kind, {}, hostility);
    EXPECT_GT(sent.value(kind, 0), hostility.least_sent) << sent;
    EXPECT_EQ(result["digest"], Undisturbed());
  }
};

/// Floods of the most expensive kinds of datagrams: requests that must be answered, fragments that
/// the kernel's filter must drop, and copies of genuine messages.
class FloodTest : public HostileTrafficTest, public testing::WithParamInterface<std::string> {};
inline const auto kFloods = testing::Values("request", "fragment", "replayed");
inline std::string NameOfFlood(const testing::TestParamInfo<std::string>& kind) {
  return kind.param;
}

}  // namespace fogline::test
