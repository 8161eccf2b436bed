// Real time on networks that lose all messages of one channel. The run names the roles that do not
// receive this channel. If the runner has started such a role, the runner starts the role again. A
// run fails if a role is deaf at the end of the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/log/event_log.h"
#include "tests/integration/realtime/not_whole.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

constexpr int kDeafRunRate_hz = 20;

class DeafRoleTest : public NetworkTest {
 protected:
  std::vector<std::string> RealtimeRun(int seconds, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--realtime",
                                       "--set",
                                       "/step_s=" + std::to_string(1.0 / kDeafRunRate_hz),
                                       "--set",
                                       "/steps=" + std::to_string(seconds * kDeafRunRate_hz),
                                       "--lcm-url",
                                       kUrl};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }
  /// The newest step of a channel in the log of the last run.
  std::int64_t NewestStepOf(std::string_view channel) {
    std::int64_t newest = -1;
    log::EventLogReader reader(Log());
    while (const auto event = reader.Next()) {
      if (event->channel == channel)
        newest = std::max(newest, runtime::ReadInt64(event->data, runtime::kStepOffset));
    }
    return newest;
  }
};

TEST_F(DeafRoleTest, IsNamedAndStartedAgainAndComputesWhenItHears) {
  const Machine machine("deaf");
  machine.RouteMulticastToItself();
  constexpr int kSeconds = 14;
  Background run(machine.On(RealtimeRun(kSeconds, {})));
  ASSERT_TRUE(run.WaitForErr("processes: "));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  // WHEN no role receives TRUTH
  machine.LoseChannel("TRUTH");
  ASSERT_TRUE(run.WaitForErr("radar (pid " + std::to_string(PidOf(run.Err(), "radar")) +
                             ") has heard no TRUTH for "))
      << run.Err();
  machine.LoseNothing();
  // THEN the run restarts a role that reads TRUTH, and this role computes until the end
  EXPECT_EQ(run.Wait(), kFailed);
  const auto result = nlohmann::json::parse(run.Out(), nullptr, false);
  ASSERT_TRUE(result.is_object()) << run.Err();
  bool radar = false;
  for (const auto& role : result["restarts"]) {
    EXPECT_THAT(role["last"].get<std::string>(),
                HasSubstr("s, although the world has published it, and was killed"));
    radar = radar || role["role"] == "radar";
    EXPECT_NE(role["role"], "fusion") << "no role published the input that it lacked";
  }
  EXPECT_TRUE(radar) << result["restarts"];
  EXPECT_GE(NewestStepOf("RADAR"), kSeconds * kDeafRunRate_hz - 5);
  // AND the run fails, because the log lacks the messages of about two seconds
  EXPECT_THAT(run.Err(), HasSubstr(kNotWhole));
}

TEST_F(DeafRoleTest, AtTheEndIsAFailureOfTheRun) {
  const Machine machine("deaf");
  machine.RouteMulticastToItself();
  // The ACC counts as deaf after about 3 s, or some seconds later on a busy machine. So the run
  // lasts 10 s.
  Background run(machine.On(RealtimeRun(10, {"--restarts", "0"})));
  ASSERT_TRUE(run.WaitForErr("processes: "));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  machine.LoseChannel("HOST_EGO");
  EXPECT_EQ(run.Wait(), 3);
  EXPECT_THAT(run.Err(), HasSubstr("warning: acc (pid "));
  EXPECT_THAT(run.Err(), HasSubstr(" on deaf) is deaf: it has heard no HOST_EGO for "));
  EXPECT_THAT(run.Err(),
              HasSubstr(" is deaf at the end of the run: it has heard no HOST_EGO for "));
}

TEST_F(DeafRoleTest, FromElsewhereIsNamed) {
  const Lab lab(2);
  Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  // The driver counts as deaf after about 3 s, and then receives TRUTH again. On a busy machine
  // each of these two changes may take three seconds more.
  constexpr int kSeconds = 12;
  Background run(lab[0].On(RealtimeRun(kSeconds, {"--external", "driver"})));
  ASSERT_TRUE(run.WaitForErr("processes: "));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  lab[1].LoseChannel("TRUTH");
  EXPECT_TRUE(run.WaitForErr("warning: driver (pid " + std::to_string(driver.pid()) +
                             " on lab2) is deaf: it has heard no TRUTH for "));
  lab[1].LoseNothing();
  EXPECT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_GE(NewestStepOf("DRIVER_COMMAND"), kSeconds * kDeafRunRate_hz - 5);
}

}  // namespace
}  // namespace fogline::test
