// Cars on a hill. Several cars follow the host, some with a human driver and some with an ACC. The
// result is the same on any transport, each following car has its own measures, and an impossible
// scenario causes one clear error.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/runs/transports.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

class TrafficTest : public testing::Test {
 protected:
  /// The command line of a verb on the paper's scenario, on a wet road uphill, with five cars
  /// behind the host.
  std::vector<std::string> On(const std::string& verb, const std::vector<std::string>& more) const {
    std::vector<std::string> command{Program("fogline"), verb, "scenario/paper.json"};
    for (const char* field :
         {"/steps=80", "/host_vehicle/model=longitudinal", "/follower_vehicle/model=longitudinal",
          "/road/surface=wet",
          R"(/road/grade=[{"position_m":0,"grade":0},{"position_m":100,"grade":0.05}])",
          "/followers/count=5", "/followers/driver=drawn", "/followers/style=drawn",
          "/followers/safety_model=reference_human"}) {
      command.insert(command.end(), {"--set", field});
    }
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  nlohmann::json Run(const std::string& transport) {
    const Outcome outcome = RunCommand(On("run", {"--json", "--quiet", "--transport", transport,
                                                  "--log", folder_.File(transport + ".lcm")}));
    EXPECT_EQ(outcome.code, 0) << transport << ": " << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  ScratchFolder folder_;
};

TEST_F(TrafficTest, HasTheSameDigestAndMeasuresOnAnyTransport) {
  ExpectTheSameOnAnyTransport([this](const std::string& on) { return Run(on); }, 80);
}

TEST_F(TrafficTest, OfPeopleWhoSeeInFogHasTheSameDigestToo) {
  const std::vector<std::string> foggy{"/steps=60", "/fog/start_s=0", "/followers/count=3",
                                       "/followers/driver=human", "/followers/style=drawn"};
  const auto run = [&](const std::string& transport, const std::string& sight) {
    std::vector<std::string> fields = foggy;
    fields.push_back("/followers/sight=" + sight);
    return RunOn(transport, "scenario/dense_fog.json", folder_.File(transport + ".lcm"), fields);
  };
  const auto direct = ExpectTheSameOnAnyTransport(
      [&](const std::string& transport) { return run(transport, "fog"); }, 60);
  EXPECT_NE(direct["digest"], run("direct", "perfect")["digest"]) << "it makes a difference";
}

TEST_F(TrafficTest, IsMeasuredCarByCarFromTheLogAlone) {
  const nlohmann::json run = Run("direct");
  const std::string log = folder_.File("direct.lcm");
  const Outcome json = RunCommand({Program("fogline"), "metrics", "--json", log});
  ASSERT_EQ(json.code, 0) << json.err;
  const auto followers = nlohmann::json::parse(json.out)[0]["metrics"]["followers"];
  EXPECT_EQ(followers, run["metrics"]["followers"]);
  ASSERT_EQ(followers.size(), 5U);
  EXPECT_EQ(followers[0]["min_gap_m"], run["metrics"]["min_follower_gap_m"]);
  EXPECT_EQ(followers[0]["max_compromised_safety_m"], run["metrics"]["max_compromised_safety_m"]);
  for (const auto& follower : followers) {
    EXPECT_GT(follower["min_gap_m"], 0);
    // A car that never approaches the car ahead has no time to collision, so the value is null.
    if (!follower["min_ttc_s"].is_null()) {
      EXPECT_GT(follower["min_ttc_s"], 0);
    }
  }
  EXPECT_FALSE(followers[0]["min_ttc_s"].is_null()) << "the host slows down on the hill";
  const Outcome text = RunCommand({Program("fogline"), "metrics", log});
  EXPECT_THAT(text.out, HasSubstr("min_ttc_s"));
}

TEST_F(TrafficTest, IsNoListOfOneCar) {
  const Outcome outcome = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--set",
                                      "/steps=20", "--transport", "direct", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_FALSE(nlohmann::json::parse(outcome.out)["metrics"].contains("followers"));
}

TEST_F(TrafficTest, IsRefusedBeforeTheRunWhereItCannotBe) {
  const auto refused = [&](const std::vector<std::string>& fields, const std::string& why) {
    for (const char* transport : {"direct", "udpm"}) {
      const std::string log = folder_.File("refused.lcm");
      std::vector<std::string> more{"--transport", transport, "--log", log};
      for (const std::string& field : fields) more.insert(more.end(), {"--set", field});
      const Outcome outcome = RunCommand(On("run", more));
      EXPECT_EQ(outcome.code, 2) << why;
      EXPECT_EQ(outcome.err, "scenario/paper.json: error: " + why + "\n");
      EXPECT_FALSE(std::filesystem::exists(log));
    }
  };
  refused({R"(/road/grade=[{"position_m":50,"grade":0},{"position_m":20,"grade":0.05}])"},
          "/road/grade/1/position_m: 20 m does not come after 50 m, the place before it; places "
          "must increase");
  refused({"/step_s=0.001", "/host_vehicle/car=truck"},
          "/step_s: 0.001 s is too short for /host_vehicle: actuator: the delay is longer than 254 "
          "steps");
  refused({"/step_s=0.002", "/followers/driver=human", "/followers/style=cautious"},
          "/step_s: 0.002 s is too short for a person in following car 0: human driver: the "
          "reaction time is longer than 254 steps");
}

TEST_F(TrafficTest, IsRefusedByCheckInTheSameWords) {
  const std::vector<std::string> hill{
      "--set", R"(/road/grade=[{"position_m":50,"grade":0},{"position_m":20,"grade":0.05}])"};
  std::vector<std::string> more = hill;
  more.push_back("--json");
  const Outcome outcome = RunCommand(On("check", more));
  EXPECT_EQ(outcome.code, 2);
  const auto diagnostics = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0]["rule"], "impossible");
  EXPECT_EQ(diagnostics[0]["pointer"], "/road/grade/1/position_m");
  EXPECT_EQ(diagnostics[0]["message"],
            "20 m does not come after 50 m, the place before it; places must increase");
}

class CompareTest : public testing::Test {
 protected:
  /// Makes the log of a host that keeps 20 m/s and a gap of 3 m + 1.5 s * speed, exact to
  /// millimetres.
  void SetUp() override {
    std::ofstream(folder_.File("calm.json")) << R"({"version": 1, "steps": 41,
        "world": {"host_speed_mps": 20, "host_gap_m": 33},
        "lead": {"profile": "recorded", "recorded": {"speed_column": "Speed1", "start_s": 5,
            "speeds_mps": [20]}},
        "radar": {"bias_m": 0, "range_std_m": 0.001, "range_rate_std_mps": 0.001},
        "lidar": {"range_std_m": 0.001},
        "arbitrator": {"policy": "traded"}})";
    const Outcome run = RunCommand({Program("fogline"), "run", folder_.File("calm.json"),
                                    "--transport", "direct", "--log", folder_.File("calm.lcm")});
    ASSERT_EQ(run.code, 0) << run.err;
  }
  /// Writes the recording of a car that is always 1 m/s slower than the host. The run's 4 s begin
  /// at 5 s of the recording. In the first half of the run the car is 3 m nearer to the leader than
  /// the host is, and in the second half 3 m further away. @return the file
  std::string Recording() const {
    const std::string file = folder_.File("real.csv");
    std::ofstream out(file);
    out << "Time,Speed1,Speed2,IVS1\n0,20,19,30\n6.99,20,19,30\n7,20,19,36\n20,20,19,36\n";
    return file;
  }
  Outcome Compare(const std::vector<std::string>& more) const {
    std::vector<std::string> command{Program("fogline"), "compare", folder_.File("calm.lcm")};
    command.insert(command.end(), more.begin(), more.end());
    return RunCommand(command);
  }

  ScratchFolder folder_;
};

TEST_F(CompareTest, ReplacesNoFile) {
  const std::string recording = Recording();
  const auto size = std::filesystem::file_size(recording);
  const Outcome outcome = Compare({recording, "--out", recording});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--out: the file exists and is not replaced"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(recording), size);
}

TEST_F(CompareTest, SaysWhatARecordingWithoutAHeaderLacks) {
  const std::string file = folder_.File("real.csv");
  const auto error_of = [&](const std::string& content) {
    std::ofstream(file) << content;
    const Outcome outcome = Compare({file});
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_EQ(error_of(""),
            file + ": error: the file is empty; it needs a header line that names columns\n");
  EXPECT_EQ(error_of("\n1,2,3\n"),
            file + ": error: the first line is empty; it must name the columns\n");
  EXPECT_EQ(error_of("1,2,3\n4,5,6\n"),
            file + ": error: the first line is \"1\", \"2\", \"3\"; it must name the columns\n");
  EXPECT_EQ(error_of("Time;Speed2;IVS1\n1;20;30\n"),
            file + ": error: seems to be separated by ';', but ',' is expected\n");
}

TEST_F(CompareTest, RefusesARunBehindNoRecordedLeader) {
  const std::string log = folder_.File("paper.lcm");
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                        "--set", "/steps=20", "--log", log})
                .code,
            0);
  const Outcome outcome = RunCommand({Program("fogline"), "compare", log, Recording()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("/lead/profile"), std::string::npos) << outcome.err;
}

TEST_F(CompareTest, GivesTheRootMeanSquareOfBothDifferences) {
  const Outcome outcome = Compare({Recording(), "--json", "--out", folder_.File("both.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  // The sensors have a noise of 1 mm. This noise changes the gaps by less than kNoise in m, and the
  // speeds by less than kNoise in m/s.
  constexpr double kNoise = 0.02;
  EXPECT_EQ(json["steps"], 41);
  EXPECT_NEAR(json["speed_rmse_mps"], 1, kNoise);
  EXPECT_NEAR(json["speed_spread_mps"], 0, kNoise);
  EXPECT_NEAR(json["gap_rmse_m"], 3, kNoise);
  // The gaps differ by +3 m in 20 steps and by -3 m in 21 steps. So the mean difference is -3/41 m,
  // and the spread around this mean is 0.001 m below 3 m.
  EXPECT_NEAR(json["gap_spread_m"], 3, kNoise);
  EXPECT_NEAR(json["largest_gap_difference_m"], 3, kNoise);
  EXPECT_NEAR(json["recorded_mean_gap_m"], (20 * 30 + 21 * 36) / 41.0, 1e-9);
  std::ifstream both(folder_.File("both.csv"));
  std::string line;
  int lines = 0;
  while (std::getline(both, line)) ++lines;
  EXPECT_EQ(lines, 42);
}

TEST_F(CompareTest, SaysWhatIsWrongWithARecording) {
  const auto refusal = [&](const std::string& text, const std::vector<std::string>& more) {
    const std::string file = folder_.File("wrong.csv");
    std::ofstream(file) << text;
    std::vector<std::string> arguments{file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = Compare(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.err.find(file), 0U) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(refusal("Time,Speed2,IVS1\n0,1,1\n1,1,1\n", {}),
              HasSubstr("error: has 0 s to 1 s, but the run is from 5 s to 9 s"));
  EXPECT_THAT(refusal("Time,Speed2,IVS1\n0,1,1\n9,1,1\n8,1,1\n", {}),
              HasSubstr("error: time 9 s is followed by 8 s"));
  EXPECT_THAT(refusal("Time,Speed2,IVS1\n0,1,x\n9,1,1\n", {}), HasSubstr(":2: error: "));
  EXPECT_THAT(refusal("Time,Speed2,IVS2\n0,1,1\n9,1,1\n", {}),
              HasSubstr("no column \"IVS1\"; it has \"Time\", \"Speed2\", \"IVS2\"; did you mean "
                        "\"IVS2\"?"));
  EXPECT_THAT(refusal("", {}), HasSubstr("error: "));
  EXPECT_THAT(refusal("Time,Speed2,IVS1\n0,1,1\n9,1,1e300\n", {}),
              HasSubstr(":3: error: IVS1 is 1e+300, not between 0 and 10000"));
  EXPECT_THAT(refusal("Time,Speed2,IVS1\n0,1,-1\n9,1,1\n", {}),
              HasSubstr(":2: error: IVS1 is -1, not between 0 and 10000"));
  EXPECT_THAT(refusal("Time,Speed1,Speed2,IVS1\n0,20,1,1\n9,5,1,1\n", {}),
              HasSubstr("error: its leader is not that of the run: Speed1 is "));
  EXPECT_THAT(refusal("Time,Speed1,Speed2,IVS1\n0,20,1,1\n9,,1,1\n", {}), HasSubstr(":3: error: "));
}

}  // namespace
}  // namespace fogline::test
