// Programs that share a network with a run, or with a log that is played.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/log/event_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/network/meeting.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(CoexistenceTest, ALogThatIsPlayedCapturesNoWaitingRole) {
  // GIVEN the log of a run that waited for a driver from elsewhere, and another driver that waits
  Meeting meeting;
  Background first(meeting.Command("fogline-driver", {}));
  const Outcome recorded =
      RunCommand(meeting.Run({"--external", "driver", "--json", "--set", "/steps=100"}));
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const std::string log = meeting.Log();
  Background driver(meeting.Command("fogline-driver", {}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run")) << driver.Err();
  // WHEN lcm-logplayer plays the log at the address at which the driver waits
  const Outcome player =
      RunCommand({"lcm-logplayer", "--speed=20", "--lcm-url=" + meeting.url(), log});
  ASSERT_EQ(player.code, 0) << player.err;
  // THEN the driver still waits, and takes part in the next run
  EXPECT_TRUE(IsAlive(driver.pid())) << driver.Err();
  const Outcome run =
      RunCommand(meeting.Run({"--external", "driver", "--json", "--set", "/steps=100"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["digest"], json::parse(recorded.out)["digest"]);
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST(CoexistenceTest, RunsAndRolesCanAgreeOnAnIdBeforehand) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  const auto command = [&](const std::string& id) {
    return std::vector<std::string>{Program("fogline"),
                                    "run",
                                    "scenario/paper.json",
                                    "--json",
                                    "--lcm-url",
                                    url,
                                    "--external",
                                    "driver",
                                    "--run-id",
                                    id,
                                    "--set",
                                    "/steps=100",
                                    "--log",
                                    folder.File(id + ".lcm")};
  };
  // GIVEN a driver for run 4711, and a run with another id that waits for a driver
  Background driver({Program("fogline-driver"), "--lcm-url", url, "--run-id", "4711"});
  Background other(command("4712"));
  ASSERT_TRUE(other.WaitForErr("waiting for the driver")) << other.Err();
  // THEN the driver takes part in run 4711 only
  const Outcome run = RunCommand(command("4711"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("run 4711 on "));
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  const Outcome direct = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--json",
                                     "--set", "/steps=100", "--transport", "direct"});
  EXPECT_EQ(json::parse(run.out)["digest"], json::parse(direct.out)["digest"]);
  log::EventLogReader log(folder.File("4711.lcm"));
  const auto event = log.Next();
  ASSERT_TRUE(event);
  EXPECT_EQ(runtime::ReadInt64(event->data, runtime::kRunIdOffset), 4711);
}

TEST(CoexistenceTest, AnIdOfARunIsAPositiveNumber) {
  const auto refuses = [](const std::vector<std::string>& command, const char* id) {
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2) << id;
    EXPECT_THAT(outcome.err, HasSubstr(id));
    EXPECT_THAT(outcome.err, HasSubstr("--run")) << id;
  };
  for (const char* id : {"0", "-5", "x", "1.5", "99999999999999999999"}) {
    refuses({Program("fogline"), "run", "scenario/paper.json", "--run-id", id}, id);
    refuses({Program("fogline-driver"), "--wait", "1", "--run-id", id}, id);
    refuses({Program("fogline"), "metrics", "any.lcm", "--run", id}, id);
    refuses({Program("fogline"), "view", "--no-browser", "--run", id}, id);
  }
}

TEST(SilenceTest, TopAndDoctorListTheRolesThatWaitBeforeAnyRun) {
  // GIVEN a driver at the meeting address, and an acc on a network of its own
  Meeting meeting;
  const std::string own = runtime::FreshMulticastUrl();
  const Background driver(meeting.Command("fogline-driver", {}));
  const Background acc(meeting.Command("fogline-acc", {"--lcm-url", own}));
  // WHEN top and doctor look at the meeting address, THEN they list both roles, each with its place
  // and version
  json waiting;
  const TimePoint end = Clock::now() + kPatience;
  while (waiting.size() < 2 && Clock::now() < end) waiting = TopOnce(meeting)["waiting"];
  ASSERT_EQ(waiting.size(), 2U) << waiting;
  EXPECT_EQ(waiting[0]["role"], "acc");
  EXPECT_EQ(waiting[0]["pid"], acc.pid());
  EXPECT_THAT(waiting[0]["lcm_url"].get<std::string>(), testing::StartsWith(own));
  EXPECT_EQ(waiting[1]["role"], "driver");
  EXPECT_EQ(waiting[1]["pid"], driver.pid());
  EXPECT_NE(waiting[1]["version"], "");
  EXPECT_EQ(waiting[1]["same_types"], true);
  const std::vector<std::string> both{"ok       acc waits on " + own,
                                      ": pid " + std::to_string(driver.pid()) + " on "};
  const Outcome doctor = RunUntilItPrints(meeting.Command("fogline", {"doctor"}), both);
  for (const std::string& found : both) EXPECT_THAT(doctor.out, HasSubstr(found));
  EXPECT_THAT(doctor.out, HasSubstr(", version "));
  // AND on the acc's own network, only the acc is listed
  const Outcome top =
      RunUntilItPrints({Program("fogline"), "top", "--once", "--json", "--lcm-url", own},
                       {"\"pid\": " + std::to_string(acc.pid())});
  const json there = json::parse(top.out);
  ASSERT_EQ(there["waiting"].size(), 1U) << top.out;
  EXPECT_EQ(there["waiting"][0]["pid"], acc.pid());
  EXPECT_TRUE(there["others"].empty()) << there["others"];
}

TEST(SilenceTest, ARunSaysWhichRolesHaveComeAndWhichAreMissing) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  Background run({Program("fogline"), "run", "scenario/paper.json", "--external", "driver",
                  "--external", "acc", "--external", "radar", "--set", "/steps=20", "--lcm-url",
                  url, "--log", folder.File("run.lcm")});
  ASSERT_TRUE(
      run.WaitForErr("waiting for the radar, the acc, the driver (60 s): start each with: "
                     "fogline-ROLE --lcm-url '" +
                     url))
      << run.Err();
  Background acc({Program("fogline-acc"), "--lcm-url", url});
  EXPECT_TRUE(run.WaitForErr("the acc has come (pid " + std::to_string(acc.pid()) + " on "))
      << run.Err();
  EXPECT_TRUE(run.WaitForErr("; missing: the radar, the driver\n")) << run.Err();
  Background radar({Program("fogline-radar"), "--lcm-url", url});
  EXPECT_TRUE(run.WaitForErr("; missing: the driver\n")) << run.Err();
  Background driver({Program("fogline-driver"), "--lcm-url", url});
  EXPECT_EQ(run.Wait(), 0) << run.Err();
}

}  // namespace
}  // namespace fogline::test
