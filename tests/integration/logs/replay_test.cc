// `fogline replay`: a role computes its outputs again from the inputs in a log, and compares them
// with the log.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "services/log/log_seal.h"
#include "services/log/remains.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

// Settings that switch on all features with which a role reads an additional input, has a memory,
// or draws random numbers.
const Words kEverything{"--set", "/human/loses_awareness=true",
                        "--set", "/human/misjudges=true",
                        "--set", "/human/sight=fog",
                        "--set", "/human/following=acc_idm",
                        "--set", "/followers/count=4",
                        "--set", "/followers/driver=drawn",
                        "--set", "/followers/sight=fog",
                        "--set", "/arbitrator/take_over/mode=requested",
                        "--set", "/host_vehicle/model=longitudinal",
                        "--set", "/arbitrator/transfer/profile=sigmoid",
                        "--set", "/arbitrator/transfer/gate=true",
                        "--set", "/arbitrator/transfer/hysteresis=sprt",
                        "--set", "/arbitrator/transfer/min_dwell_s=1"};

class ReplayTest : public testing::Test {
 protected:
  std::string Log(const std::string& scenario, const Words& more) const {
    const std::string log = folder_.File("run.lcm");
    Words command{Program("fogline"), "run", scenario, "--quiet", "--log", log};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome run = RunCommand(command);
    EXPECT_EQ(run.code, 0) << run.err;
    return log;
  }

  static Outcome Replay(const Words& arguments) {
    Words command{Program("fogline"), "replay"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return RunCommand(command);
  }

  /// Expects that every role computes the same outputs as in the log in every step.
  static void ExpectSame(const std::string& log, int steps) {
    const Outcome replay = Replay({log, "--all", "--json"});
    EXPECT_EQ(replay.code, 0) << replay.out << replay.err;
    const auto json = nlohmann::json::parse(replay.out, nullptr, false);
    EXPECT_EQ(json["same"], true);
    EXPECT_EQ(json["steps"], steps);
    ASSERT_EQ(json["roles"].size(), kRoles.size() - 1);
    for (const auto& role : json["roles"]) EXPECT_EQ(role["same"], true) << role;
  }

  /// A copy of a log without its seal. In step `step`, the distance in TRACK is 0.25 m larger.
  std::string Altered(const std::string& log, std::int64_t step) const {
    const std::string altered = folder_.File("altered.lcm");
    log::EventLogReader reader(log);
    log::EventLogWriter writer(altered);
    while (const auto event = reader.Next()) {
      if (log::IsLogSeal(*event)) continue;
      std::vector<std::uint8_t> bytes(event->data.begin(), event->data.end());
      track_t track{};
      if (event->channel == "TRACK" && runtime::Decode(bytes, track) && track.header.step == step) {
        track.state[0] += 0.25;
        runtime::Encode(track, bytes);
      }
      writer.Write(event->channel, event->utime, bytes);
    }
    return altered;
  }

  const ScratchFolder folder_;
};

TEST_F(ReplayTest, ComputesALogOfProcessesOnANetworkAgain) {
  ExpectSame(Log("scenario/paper.json", {"--set", "/steps=250"}), 250);
}

TEST_F(ReplayTest, ComputesALogOfOneProcessAgain) {
  ExpectSame(Log("scenario/paper.json", {"--transport", "direct"}), 500);
}

TEST_F(ReplayTest, ComputesALogWithEverythingSwitchedOnAgainWhateverThePolicyDemands) {
  // With policy `bayes` the arbitrator also reads TRUTH. With policy `oracle` the fusion also reads
  // TRUTH. In both runs the driver also reads HOST_COMMAND.
  for (const char* policy : {"bayes", "oracle"}) {
    SCOPED_TRACE(policy);
    Words more = kEverything;
    // The runs end after 500 steps, because with one of these policies the cars collide later.
    more.insert(more.end(), {"--transport", "direct", "--force", "--set", "/steps=500", "--set",
                             std::string("/arbitrator/policy=") + policy});
    ExpectSame(Log("scenario/dense_fog.json", more), 500);
  }
}

TEST_F(ReplayTest, NamesTheStepAndFieldOfAnOutputThatIsNotTheLogs) {
  const std::string log =
      Altered(Log("scenario/paper.json", {"--transport", "direct", "--set", "/steps=250"}), 200);
  // In step 200 the log differs from the output of the fusion. The next steps agree, because the
  // replay takes its inputs from the log.
  const Outcome fusion = Replay({log, "--role", "fusion", "--json"});
  EXPECT_EQ(fusion.code, 1);
  const auto role = nlohmann::json::parse(fusion.out)["roles"][0];
  EXPECT_EQ(role["steps_that_differ"], 1);
  EXPECT_EQ(role["first"]["step"], 200);
  EXPECT_EQ(role["first"]["channel"], "TRACK");
  EXPECT_EQ(role["first"]["field"], "state[0]");
  EXPECT_NEAR(std::stod(role["first"]["log"].get<std::string>()),
              std::stod(role["first"]["replay"].get<std::string>()) + 0.25, 1e-9);
  // The ACC reads TRACK and so computes another command.
  const Outcome acc = Replay({log, "--role", "acc"});
  EXPECT_EQ(acc.code, 1);
  EXPECT_THAT(acc.out, HasSubstr("first in step 200: ACC_COMMAND acceleration_mps2: "));
  // The radar does not read TRACK.
  EXPECT_EQ(Replay({log, "--role", "radar"}).code, 0);
}

TEST_F(ReplayTest, TakesALogThatWasCutOffAsFarAsItGoes) {
  const std::string log = Log("scenario/paper.json", {"--transport", "direct"});
  std::filesystem::resize_file(log, std::filesystem::file_size(log) / 2);
  const Outcome replay = Replay({log, "--role", "world"});
  EXPECT_EQ(replay.code, 1);
  EXPECT_THAT(replay.out, HasSubstr("same: 2"));
  EXPECT_THAT(replay.err, HasSubstr("ends after step 2"));
}

TEST_F(ReplayTest, ReadsTheChosenRunOfALogOfSeveralRuns) {
  const std::string log = Log("scenario/paper.json", {"--transport", "direct"});
  const std::int64_t first = log::ReadFront(log).run_id;
  const std::string before = Content(log);
  Log("scenario/paper.json",
      {"--transport", "direct", "--force", "--seed", "2", "--set", "/steps=250"});
  const std::string second = std::to_string(log::ReadFront(log).run_id);
  const std::string both = folder_.File("both.lcm");
  std::ofstream(both, std::ios::binary) << before << Content(log);
  const auto steps = [](const Outcome& replay) {
    EXPECT_EQ(replay.code, 0) << replay.out << replay.err;
    return nlohmann::json::parse(replay.out, nullptr, false)["steps"];
  };
  const Outcome unsaid = Replay({both, "--all", "--json"});
  EXPECT_EQ(steps(unsaid), 500);
  EXPECT_THAT(unsaid.err, HasSubstr("this is run " + std::to_string(first) +
                                    "; the log also has run " + second));
  EXPECT_EQ(steps(Replay({both, "--all", "--json", "--run", second})), 250);
  const Outcome unknown = Replay({both, "--all", "--run", "5"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("the log has no run 5; it has "));
}

TEST_F(ReplayTest, SaysWhatIsWrongWithItsArguments) {
  const std::string log =
      Log("scenario/paper.json", {"--transport", "direct", "--set", "/steps=5"});
  const auto error = [](const Words& arguments) {
    const Outcome outcome = Replay(arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  };
  EXPECT_EQ(error({log}), "fogline replay: error: give one of --role and --all\n");
  EXPECT_EQ(error({log, "--role", "fusio"}),
            "fogline replay: error: --role fusio: not one of \"world\", \"radar\", \"lidar\", "
            "\"fusion\", \"acc\", \"driver\", \"arbitrator\", \"follower\"; did you mean "
            "\"fusion\"?\n");
  EXPECT_THAT(error({log, "--role", "recorder"}), HasSubstr("--role recorder: not one of"));
  EXPECT_THAT(error({"scenario/paper.json", "--all"}), HasSubstr("scenario/paper.json: error: "));
}

TEST_F(ReplayTest, RefusesALogOfARunInRealtime) {
  const std::string log = Log("scenario/paper.json", {"--realtime", "--set", "/steps=20"});
  const Outcome replay = Replay({log, "--all"});
  EXPECT_EQ(replay.code, 2);
  EXPECT_THAT(replay.err, HasSubstr(log + ": error: a run in real time"));
}

}  // namespace
}  // namespace fogline::test
