// `fogline table` computes the paper's table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/children.h"
#include "tests/support/command.h"
#include "tests/support/verbs.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;

/// Rows of `fogline table scenario/paper.json` for thresholds 0.2, 0.5, 0.8.
nlohmann::json TableRows(const std::vector<std::string>& more) {
  std::vector<std::string> command{Program("fogline"), "table", "scenario/paper.json", "--json"};
  command.insert(command.end(), more.begin(), more.end());
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false)["rows"];
}

TEST(TableTextTest, SaysOnceThatThereIsNoSafetyToImproveWithoutFog) {
  const Outcome table = RunCommand({Program("fogline"), "table", "scenario/paper.json", "--set",
                                    "/fog/model=none", "--set", "/steps=310"});
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out,
              testing::EndsWith("\n\nno SI: without traded control the following car never comes "
                                "too close (no fog?)\n"));
  EXPECT_THAT(table.out, testing::Not(HasSubstr("0 seeds")));
}

TEST(TableTextTest, SaysInItsHelpForWhatItObeysTheEnvironment) {
  EXPECT_THAT(RunCommand({Program("fogline"), "table", "--help"}).out,
              testing::ContainsRegex("processes for[ \n]+--external use"));
  EXPECT_THAT(RunCommand({Program("fogline"), "run", "--help"}).out,
              testing::Not(testing::ContainsRegex("processes for[ \n]+--external")));
}

TEST(TableTextTest, EndsWithSafetyByOtherFloorsAndReadings) {
  const Outcome table =
      RunCommand({Program("fogline"), "table", "scenario/paper.json", "--thresholds", "0.5"});
  ASSERT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("(/measures/safety_floor_m, 0.01 m)"));
  // The scenario has a floor of 10 mm, so the value for floor_10mm equals SI.
  const nlohmann::json row = TableRows({"--thresholds", "0.5"})[0];
  EXPECT_EQ(row["other_si_pct"]["floor_10mm"], row["si_pct"]);
  EXPECT_EQ(row["other_si_pct"].size(), 7U);
  // A lower floor also counts steps with little compromised safety. In these steps, traded control
  // avoids a smaller share of compromised safety.
  double above = 100;
  for (const char* floor : {"floor_20mm", "floor_10mm", "floor_5mm", "floor_1mm", "floor_0mm"}) {
    EXPECT_LT(row["other_si_pct"][floor], above) << floor;
    above = row["other_si_pct"][floor];
  }
  const std::string last_line = table.out.substr(table.out.rfind("\n", table.out.size() - 2) + 1);
  EXPECT_THAT(last_line, testing::StartsWith("     0.5  "));
  EXPECT_THAT(last_line, HasSubstr("80.80"));
}

class TableTest : public testing::TestWithParam<const char*> {};

TEST_P(TableTest, MeetsThePublishedOneToAPointWithTheScenariosOwnSeed) {
  const nlohmann::json rows = TableRows({"--transport", GetParam()});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0]["threshold"], 0.2);
  EXPECT_NEAR(rows[0]["si_pct"], 100, 0.005);
  EXPECT_NEAR(rows[0]["rhe_pct"], 100, 0.005);
  EXPECT_EQ(rows[1]["threshold"], 0.5);
  EXPECT_NEAR(rows[1]["si_pct"], 80.79, 1);
  EXPECT_LE(rows[1]["rhe_pct"], 0.3);
  EXPECT_EQ(rows[2]["threshold"], 0.8);
  EXPECT_NEAR(rows[2]["si_pct"], 10.23, 1);
  EXPECT_LE(rows[2]["rhe_pct"], 0.3);
  EXPECT_EQ(rows[1]["published_si_pct"], 80.79);
}

INSTANTIATE_TEST_SUITE_P(Transports, TableTest, testing::Values("direct", "memq", "udpm"),
                         [](const auto& transport) { return std::string(transport.param); });

TEST(TableOverSeedsTest, IsTheSameOnEveryTransportToTheLastDigit) {
  const nlohmann::json direct = TableRows({"--seeds", "3:4"});
  EXPECT_EQ(TableRows({"--seeds", "3:4", "--transport", "memq"}), direct);
}

TEST(TableOverSeedsTest, IsTheSameForAnyNumberOfRunsAtOnce) {
  const nlohmann::json direct = TableRows({"--seeds", "3:5", "--thresholds", "0.5"});
  for (const char* transport : {"memq", "udpm", "tcpq"}) {
    EXPECT_EQ(TableRows({"--seeds", "3:5", "--thresholds", "0.5", "--transport", transport,
                         "--jobs", "3"}),
              direct)
        << transport;
  }
}

/// The world processes of all runs of a table that are under way.
std::vector<pid_t> WorldsOf(const Background& table) {
  std::vector<pid_t> worlds = ChildrenOfAnyThread(table.pid());
  std::erase_if(worlds, [](pid_t child) {
    return Content("/proc/" + std::to_string(child) + "/comm") != "fogline-world\n";
  });
  return worlds;
}

TEST(TableOverSeedsTest, HasAsManyRunsAtOnceAsItIsTold) {
  Background table({Program("fogline"), "table", "scenario/paper.json", "--seeds", "1:2",
                    "--thresholds", "0.5", "--set", "/steps=50000", "--transport", "udpm", "--jobs",
                    "4"});
  std::vector<pid_t> worlds;
  while (worlds.size() < 4) {
    ASSERT_TRUE(IsAlive(table.pid())) << "there were never four runs at once";
    worlds = WorldsOf(table);
  }
  // WHEN Ctrl-C ends the table, THEN no process is left
  table.Signal(SIGINT);
  EXPECT_EQ(table.Wait(), 130) << table.Err();
  for (const pid_t world : worlds) EXPECT_FALSE(IsAlive(world));
}

TEST(TableOverSeedsTest, HasMeansNearThePublishedOne) {
  const nlohmann::json rows = TableRows({"--seeds", "1:40"});
  EXPECT_NEAR(rows[0]["si_pct"], 100, 5);
  EXPECT_NEAR(rows[1]["si_pct"], 80.79, 5);
  EXPECT_NEAR(rows[2]["si_pct"], 10.23, 5);
  for (const nlohmann::json& row : rows) {
    EXPECT_TRUE(row["si_std_pct"].is_number());
    EXPECT_TRUE(row["rhe_std_pct"].is_number());
  }
}

TEST(TableOverSeedsTest, HoldsOverAThousandSeeds) {
  const nlohmann::json rows = TableRows({"--seeds", "1:1000"});
  EXPECT_NEAR(rows[0]["si_pct"], 100, 3);
  EXPECT_NEAR(rows[1]["si_pct"], 80.79, 3);
  EXPECT_NEAR(rows[2]["si_pct"], 10.23, 3);
  EXPECT_NEAR(rows[0]["rhe_pct"], 100, 0.3);
  EXPECT_LE(rows[1]["rhe_pct"], 0.3);
  EXPECT_LE(rows[2]["rhe_pct"], 0.3);
}

TEST(TableOverSeedsTest, SaysWhichSeedsAndThatOneNumberIsOneSeed) {
  const auto table = [](const std::vector<std::string>& more) {
    std::vector<std::string> command{Program("fogline"), "table", "scenario/paper.json"};
    command.insert(command.end(), more.begin(), more.end());
    return RunCommand(command);
  };
  EXPECT_THAT(table({}).out, HasSubstr("\nseed 1\n"));
  EXPECT_EQ(table({}).err, "");
  const Outcome several = table({"--seeds", "3:5"});
  EXPECT_THAT(several.out, HasSubstr("\nseeds 3 to 5: mean +- standard deviation\n"));
  EXPECT_EQ(several.err, "");
  const Outcome one = table({"--seeds", "1000"});
  EXPECT_THAT(one.out, HasSubstr("\nseed 1000\n"));
  EXPECT_EQ(one.err, "--seeds 1000 is the one seed 1000; seeds 1 to 1000 are --seeds 1:1000\n");
  EXPECT_EQ(table({"--seeds", "1000:1000"}).err, "");
  const auto document = nlohmann::json::parse(table({"--seeds", "3:5", "--json"}).out);
  EXPECT_EQ(document["seeds"], 3);
  EXPECT_EQ(document["first_seed"], 3);
  EXPECT_EQ(document["last_seed"], 5);
}

/// The error text of `fogline table` for arguments that it refuses.
std::string TableErrorOf(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"table", "scenario/paper.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return ErrorOf(arguments);
}

TEST(TableArgumentsTest, RefuseSeveralRunsAtOnceForRolesThatAreStartedElsewhere) {
  EXPECT_EQ(TableErrorOf({"--external", "driver", "--lcm-url", "udpm://239.255.76.67:7667?ttl=0",
                          "--jobs", "2"}),
            "fogline table: error: --jobs 2: roles that are started elsewhere take part in one run "
            "at a time\n");
}

TEST(TableArgumentsTest, RefuseToSetWhatTheTableVariesItself) {
  EXPECT_EQ(TableErrorOf({"--set", "/arbitrator/policy=none"}),
            "scenario/paper.json: error: /arbitrator/policy is none, which uses no threshold; "
            "these policies do: traded, adaptive, availability, traded_isolating\n");
  EXPECT_THAT(TableErrorOf({"--set", "/arbitrator/policy=isolate"}),
              HasSubstr("/arbitrator/policy is isolate, which uses no threshold"));
  const ScratchFolder folder;
  EXPECT_EQ(TableErrorOf({"--logs", folder.File("slip/logs")}),
            folder.File("slip/logs") + ": error: --logs: there is no folder " +
                folder.File("slip") + "\n");
  EXPECT_EQ(TableErrorOf({"--logs", "/proc"}),
            "/proc: error: --logs: cannot write: No such file or directory\n");
  EXPECT_EQ(TableErrorOf({"--set", "/arbitrator/threshold=0.3"}),
            "fogline table: error: --set /arbitrator/threshold: the thresholds are those of "
            "--thresholds\n");
  EXPECT_EQ(TableErrorOf({"--seeds", "1:2", "--set", "/seed=3"}),
            "fogline table: error: --set /seed: the seeds are those of --seeds\n");
  EXPECT_EQ(TableErrorOf({"--seeds", "1:2", "--seed", "3"}),
            "fogline table: error: --seed excludes --seeds (see fogline table --help)\n");
}

TEST(TableArgumentsTest, RefuseAThresholdThatComesTwice) {
  EXPECT_EQ(TableErrorOf({"--thresholds", "0.5,0.2,0.50"}),
            "fogline table: error: --thresholds 0.5,0.2,0.50: 0.5 comes twice\n");
}

TEST(TableOfRunsTest, ReplacesLogsAndNoOtherFileAndHasALogForEachThreshold) {
  const ScratchFolder folder;
  const auto table = [&] {
    return RunCommand({Program("fogline"), "table", "scenario/paper.json", "--set", "/steps=20",
                       "--thresholds", "0.5,0.5000001", "--logs", folder.File("")});
  };
  const std::string log = folder.File("paper-seed1-threshold-0.5.lcm");
  std::ofstream(log) << "my notes";
  const Outcome refused = table();
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("error: --logs: the file is no event log"));
  EXPECT_FALSE(std::filesystem::exists(folder.File("paper-seed1-threshold-none.lcm")));
  std::filesystem::remove(log);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(table().code, 0) << "logs are replaced";
  EXPECT_TRUE(std::filesystem::exists(log));
  EXPECT_TRUE(std::filesystem::exists(folder.File("paper-seed1-threshold-0.5000001.lcm")));
}

TEST(TableArgumentsTest, RefuseARoleFromElsewhereWhereItCannotJoin) {
  EXPECT_THAT(TableErrorOf({"--external", "driver"}), HasSubstr("one process"));
  EXPECT_THAT(TableErrorOf({"--external", "driver", "--transport", "udpm"}),
              HasSubstr("--lcm-url"));
}

TEST(TableOfRunsTest, IsTheSameWithADriverFromElsewhereThatIsStartedForEveryRun) {
  const std::vector<std::string> what{"--thresholds", "0.5", "--set", "/steps=250"};
  const std::string url = runtime::FreshMulticastUrl();
  // GIVEN a driver that a shell starts again each time that the driver has exited
  Background drivers(
      {"bash", "-c", "while \"$@\"; do :; done", "-", Program("fogline-driver"), "--lcm-url", url});
  // THEN the driver takes part in both runs of the table
  std::vector<std::string> external = what;
  external.insert(external.end(), {"--external", "driver", "--lcm-url", url});
  EXPECT_EQ(TableRows(external), TableRows(what));
}

TEST(TableOfRunsTest, CountsTheRunsThatEndInACollision) {
  EXPECT_EQ(TableRows({"--thresholds", "0.5", "--seeds", "1:3"})[0]["collisions"], 0);
  // GIVEN a leader that makes an emergency stop, and a host whose ACC can hardly brake
  const nlohmann::json rows =
      TableRows({"--thresholds", "1", "--seeds", "1:3", "--set", "/lead/profile=emergency_brake",
                 "--set", "/acc/min_acceleration_mps2=-0.1"});
  EXPECT_EQ(rows[0]["collisions"], 3);
}

}  // namespace
}  // namespace fogline::test
