// Tests of the scenario recorded_lead.json, whose leader moves as a real car did on a road, and of
// the recording.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

class RecordedLeadTest : public testing::Test {
 protected:
  /// Runs the scenario to its end. @return its measures
  static nlohmann::json Run(const std::vector<std::string>& more) {
    std::vector<std::string> command{Program("fogline"), "run", "scenario/recorded_lead.json",
                                     "--json", "--quiet"};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto result = nlohmann::json::parse(outcome.out, nullptr, false);
    EXPECT_EQ(result["steps"], 7000);
    return result["metrics"];
  }

  const std::vector<std::string> dense_fog_{
      "--set", "/fog/model=beam",     "--set", "/fog/start_s=100",
      "--set", "/fog/duration_s=100", "--set", "/fog/visibility_m=60"};
};

TEST_F(RecordedLeadTest, IsThereWithoutAFileFromOutsideOfTheScenarioFolder) {
  const ScratchFolder elsewhere;
  std::filesystem::copy(SourceDirectory() / "scenario", elsewhere.path() / "scenario",
                        std::filesystem::copy_options::recursive);
  const Outcome check =
      RunCommand({Program("fogline"), "check", elsewhere.File("scenario/recorded_lead.json")});
  EXPECT_EQ(check.code, 0) << check.err;
  const std::string recording = Content(elsewhere.path() / "scenario/data/acc_platoon_a.csv");
  EXPECT_TRUE(
      recording.starts_with("Time,Speed1,Speed2,Speed3,Speed4,Speed5,IVS1,IVS2,IVS3,IVS4\r\n"));
  EXPECT_EQ(std::ranges::count(recording, '\n'), 1 + 7000);
  const std::string about = Content(elsewhere.path() / "scenario/data/README.md");
  EXPECT_NE(about.find("CC0"), std::string::npos);
  EXPECT_NE(about.find("`acc_platoon_a.csv`"), std::string::npos);
}

TEST_F(RecordedLeadTest, IsInstalledWithItsRecording) {
  const ScratchFolder prefix;
  const Outcome install = RunCommand(
      {"cmake", "--install", ProgramDirectory().parent_path(), "--prefix", prefix.path().string()});
  ASSERT_EQ(install.code, 0) << install.err;
  const Outcome run = RunCommand({prefix.File("bin/fogline"), "run",
                                  prefix.File("share/fogline/scenario/recorded_lead.json"),
                                  "--transport", "direct", "--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["steps"], 7000);
}

TEST_F(RecordedLeadTest, IsFollowedFor700SecondsInClearAirWithoutACollision) {
  const ScratchFolder folder;
  const nlohmann::json metrics = Run({"--transport", "udpm", "--log", folder.File("clear.lcm")});
  EXPECT_EQ(metrics["collision"], 0);
  EXPECT_GT(metrics["min_host_gap_m"], 2.0);
  EXPECT_GT(metrics["min_follower_gap_m"], 2.0);
}

TEST_F(RecordedLeadTest, IsFollowedThroughDenseFogWithoutACollision) {
  // The run begins at 200 s of the recording. The fog lasts from 300 s to 400 s of the recording,
  // which is from 100 s to 200 s of the run.
  const ScratchFolder folder;
  std::vector<std::string> more{"--transport", "udpm", "--log", folder.File("fog.lcm")};
  more.insert(more.end(), dense_fog_.begin(), dense_fog_.end());
  const nlohmann::json metrics = Run(more);
  EXPECT_EQ(metrics["collision"], 0);
  // The error is far larger than the noise of the sensors. So the fog has deceived the LiDAR.
  EXPECT_GT(metrics["rms_fusion_error_m"], 0.5);
}

TEST_F(RecordedLeadTest, LetsTheAccDriveLikeTheRealSecondCarThatHasItsTimeGap) {
  // GIVEN an ACC with the time gap and the standstill distance of the real car. Both values come
  // from a straight line that was fitted to the gaps of this car
  const ScratchFolder folder;
  Run({"--transport", "direct", "--log", folder.File("second.lcm"), "--set", "/acc/headway_s=0.82",
       "--set", "/acc/standstill_m=6.5", "--set", "/world/host_speed_mps=17.68", "--set",
       "/world/host_gap_m=17.23"});
  const auto compared = RunCommand({Program("fogline"), "compare", folder.File("second.lcm"),
                                    "scenario/data/acc_platoon_a.csv", "--json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const auto json = nlohmann::json::parse(compared.out);
  std::printf("behind the recorded leader: RMSE of speed %.3f m/s, of gap %.3f m\n",
              json["speed_rmse_mps"].get<double>(), json["gap_rmse_m"].get<double>());
  EXPECT_EQ(json["steps"], 7000);
  // THEN ACC and real car drive alike. Car-following models that are fitted to a car have errors of
  // 11 to 29 % of the gap (Kesting & Treiber 2008).
  EXPECT_LT(json["gap_rmse_m"], 0.29 * json["recorded_mean_gap_m"].get<double>());
  EXPECT_LT(json["speed_rmse_mps"], 1);
}

TEST_F(RecordedLeadTest, TravelsWithTheScenarioSoThatOtherMachinesNeedNoFile) {
  // The 7,000 speeds travel over LCM in parts. The digest must equal that of a run in one process.
  const ScratchFolder folder;
  const auto digest = [&](const std::string& transport) {
    const Outcome outcome =
        RunCommand({Program("fogline"), "run", "scenario/recorded_lead.json", "--json", "--quiet",
                    "--transport", transport, "--log", folder.File(transport + ".lcm")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false)["digest"];
  };
  EXPECT_EQ(digest("memq"), digest("direct"));
}

}  // namespace
}  // namespace fogline::test
