// fogline calibrate finds the parameters that produced a table, and writes them into a file.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using nlohmann::json;

// The paper's experiment, shortened to 30 s and without noise. The follower reaches its desired gap
// within seconds.
constexpr const char* kScenario = R"({
  "$schema": "scenario.schema.json",
  "version": 1,
  "title": "Without noise",
  "steps": 300,
  "fog": { "model": "bias", "profile": "half_sine", "start_s": 9, "duration_s": 11, "bias_m": 0.3 },
  "radar": { "bias_m": 0.95, "range_std_m": 0, "range_rate_std_mps": 0 },
  "lidar": { "range_std_m": 0 },
  "follower": {
    "headway_s": 1.5,
    "weight_control": 1
  }
}
)";

class CalibrateTest : public testing::Test {
 protected:
  CalibrateTest() { std::ofstream(scenario_) << kScenario; }

  static Outcome RunFogline(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), Program("fogline"));
    return RunCommand(arguments);
  }

  /// Writes the table of the scenario with these fields as the target.
  void MakeTarget(const std::vector<std::string>& overrides, const std::string& seeds) const {
    std::vector<std::string> arguments{"table",   scenario_, "--thresholds", "0.3,0.4,0.5,0.6,0.7",
                                       "--seeds", seeds,     "--json"};
    Append(arguments, "--set", overrides);
    const Outcome outcome = RunFogline(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    std::ofstream(target_) << outcome.out;
  }

  /// Calibrates the scenario to the target.
  json Calibrate(const std::vector<std::string>& free, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"calibrate", scenario_, "--target", target_, "--json"};
    Append(arguments, "--free", free);
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = RunFogline(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }

  /// The error text of a command line that is refused with exit code 2.
  std::string ErrorOf(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"calibrate", scenario_});
    const Outcome outcome = RunFogline(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  }

  const ScratchFolder folder_;
  const std::string scenario_ = folder_.File("scenario.json");
  const std::string target_ = folder_.File("table.json");
  const std::string out_ = folder_.File("found.json");

 private:
  static void Append(std::vector<std::string>& arguments, const char* option,
                     const std::vector<std::string>& values) {
    for (const std::string& value : values) {
      arguments.insert(arguments.end(), {option, value});
    }
  }
};

// The share of a field's range by which the search may miss the true value: 0.4 mm for the offset,
// 1.5 mm for the fog's bias, 4 ms for the headway. A search ends when every number of the table is
// within 0.001 points of the target. At that moment a field may still differ from its true value by
// a few thousandths of its range, because the field changes the table only a little: 1 % of the
// offset's range changes the table by 0.07 points.
constexpr double kShareOfRange = 5e-3;

TEST_F(CalibrateTest, RecoversTheFogAndTheOffsetBetweenTheSensors) {
  MakeTarget({"/fog/bias_m=0.377", "/radar/bias_m=0.9321"}, "1");
  const json found = Calibrate({"/fog/bias_m=0.2:0.5", "/radar/bias_m=0.9:0.98"}, {"--seeds", "1"});
  EXPECT_NEAR(found["fields"][0]["value"], 0.377, kShareOfRange * 0.3);
  EXPECT_NEAR(found["fields"][1]["value"], 0.9321, kShareOfRange * 0.08);
  for (const json& row : found["rows"]) {
    EXPECT_NEAR(row["si_difference_pct"], 0, 1e-3);
    EXPECT_NEAR(row["rhe_difference_pct"], 0, 1e-3);
  }
}

TEST_F(CalibrateTest, RecoversHeadwayAndWeightOfTheFollower) {
  MakeTarget({"/follower/headway_s=1.43", "/follower/weight_control=3"}, "1");
  const json found = Calibrate(
      {"/follower/headway_s=1.2:2", "/follower/weight_control=0.1:100:log"}, {"--seeds", "1"});
  EXPECT_NEAR(found["fields"][0]["value"], 1.43, kShareOfRange * 0.8);
  // The range goes from 0.1 to 100, three decades on a logarithmic scale. So kShareOfRange of this
  // range means a factor of 1.035.
  EXPECT_NEAR(found["fields"][1]["value"], 3, 0.035 * 3);
}

TEST_F(CalibrateTest, RecoversFogAndOffsetFromMeansOverNoisySeeds) {
  const std::vector<std::string> noise{"/radar/range_std_m=0.02", "/lidar/range_std_m=0.01"};
  std::vector<std::string> truth = noise;
  truth.insert(truth.end(), {"/fog/bias_m=0.377", "/radar/bias_m=0.9321"});
  MakeTarget(truth, "1:4");
  // WHEN the search uses the seeds of the target, THEN it can meet the target to the last digit
  const json found =
      Calibrate({"/fog/bias_m=0.2:0.5", "/radar/bias_m=0.9:0.98"},
                {"--seeds", "1:4", "--spread-weight", "0", "--set", noise[0], "--set", noise[1]});
  EXPECT_NEAR(found["fields"][0]["value"], 0.377, kShareOfRange * 0.3);
  EXPECT_NEAR(found["fields"][1]["value"], 0.9321, kShareOfRange * 0.08);
}

TEST_F(CalibrateTest, WritesTheScenarioWithWhatItFound) {
  MakeTarget({"/fog/bias_m=0.377"}, "1");
  const json found = Calibrate({"/fog/bias_m=0.2:0.5"},
                               {"--seeds", "1", "--out", out_, "--set", "/title=\"Found\""});
  // THEN the file differs from the scenario only by the found value and the override
  std::string expected = kScenario;
  expected.replace(expected.find("0.3 }"), 3, found["fields"][0]["value"].dump());
  expected.replace(expected.find("Without noise"), 13, "Found");
  EXPECT_EQ(Content(out_), expected);
  EXPECT_EQ(RunFogline({"check", out_}).code, 0);
  // AND the table of this file equals the table that calibrate reported
  const Outcome table =
      RunFogline({"table", out_, "--thresholds", "0.3,0.4,0.5,0.6,0.7", "--seeds", "1", "--json"});
  const json rows = json::parse(table.out)["rows"];
  ASSERT_EQ(rows.size(), found["rows"].size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i]["si_pct"], found["rows"][i]["si_pct"]);
    EXPECT_EQ(rows[i]["rhe_pct"], found["rows"][i]["rhe_pct"]);
  }
}

TEST_F(CalibrateTest, HasTheSameResultOnAnyNumberOfThreads) {
  MakeTarget({"/fog/bias_m=0.377"}, "1:3");
  const std::vector<std::string> free{"/fog/bias_m=0.2:0.5"};
  const std::vector<std::string> more{
      "--seeds", "1:3", "--evaluations", "30", "--set", "/radar/range_std_m=0.02", "--jobs"};
  const auto with_jobs = [&](const char* jobs) {
    std::vector<std::string> arguments = more;
    arguments.emplace_back(jobs);
    return Calibrate(free, arguments);
  };
  const json one = with_jobs("1");
  EXPECT_EQ(one["evaluations"], 30);
  EXPECT_EQ(with_jobs("2"), one);
}

TEST_F(CalibrateTest, TakesThePublishedRowsAsTarget) {
  const Outcome outcome =
      RunFogline({"calibrate", "scenario/paper.json", "--free", "/fog/bias_m=0.2:0.5", "--seeds",
                  "1:2", "--evaluations", "3"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* text : {"3 evaluations", "/fog/bias_m", "[0.2, 0.5] m", "80.79", "10.23",
                           "Points that 1 % of a field's range changes", "SI 0.5", "RHE 0.8"}) {
    EXPECT_THAT(outcome.out, testing::HasSubstr(text));
  }
  EXPECT_THAT(outcome.err, testing::StartsWith("objective at the start: "));
}

TEST_F(CalibrateTest, EndsWithTheBestSoFarOnCtrlC) {
  Background calibrate({Program("fogline"), "calibrate", "scenario/paper.json", "--free",
                        "/fog/bias_m=0.2:0.5", "--free", "/radar/bias_m=0.9:1", "--evaluations",
                        "1000000", "--out", out_, "--json"});
  ASSERT_TRUE(calibrate.WaitForErr("objective at the start: ")) << calibrate.Err();
  calibrate.Signal(SIGINT);
  EXPECT_EQ(calibrate.Wait(), 130);
  EXPECT_THAT(calibrate.Err(),
              testing::ContainsRegex("fogline calibrate: interrupted; these are the best "
                                     "values of [0-9]+ evaluation"));
  const json found = json::parse(calibrate.Out(), nullptr, false);
  EXPECT_EQ(found["interrupted"], true);
  EXPECT_LE(found["objective"], found["objective_at_start"]);
  EXPECT_EQ(RunFogline({"check", out_}).code, 0);
}

class EnsembleOfCalibrateTest : public CalibrateTest {
 protected:
  /// The arguments of a search for sets of parameters whose tables are near the target.
  std::vector<std::string> Search(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"calibrate",     scenario_,
                                       "--target",      target_,
                                       "--free",        "/fog/bias_m=0.2:0.5",
                                       "--free",        "/radar/bias_m=0.9:0.98",
                                       "--seeds",       "1",
                                       "--fresh",       "2:3",
                                       "--within",      "40",
                                       "--apart",       "0.05",
                                       "--evaluations", "60",
                                       "--out",         sets_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  const std::string sets_ = folder_.File("sets");
};

TEST_F(EnsembleOfCalibrateTest, WritesItsSetsAndTheirTable) {
  MakeTarget({}, "1");
  const Outcome outcome = RunFogline(Search({"--ensemble", "2", "--json"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out, nullptr, false);
  ASSERT_EQ(found["sets"].size(), 2U);
  EXPECT_GE(found["least_distance"], 0.05);
  for (const json& set : found["sets"]) {
    // Each set of parameters is a scenario file. Its table equals the table that calibrate
    // reported.
    const std::string file = sets_ + "/" + set["file"].get<std::string>();
    EXPECT_EQ(RunFogline({"check", file}).code, 0);
    const Outcome table = RunFogline(
        {"table", file, "--thresholds", "0.3,0.4,0.5,0.6,0.7", "--seeds", "2:3", "--json"});
    const json rows = json::parse(table.out)["rows"];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i]["si_pct"], set["fresh"]["rows"][i]["si_pct"]);
    }
    EXPECT_LE(set["search"]["distance"], 40);
    EXPECT_LE(set["fresh"]["distance"], 40);
    EXPECT_THAT(Content(file), testing::HasSubstr("Made by: fogline calibrate " + scenario_));
  }
  EXPECT_THAT(Content(sets_ + "/sets.csv"), testing::StartsWith("quantity,unit,lowest,"));
  // AND calibrate replaces the sets only with --force
  const Outcome again = RunFogline(Search({"--ensemble", "1"}));
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.err, sets_ + ": error: --out: the folder has sets; --force replaces them\n");
  const Outcome forced = RunFogline(Search({"--ensemble", "1", "--force"}));
  EXPECT_EQ(forced.code, 0) << forced.err;
  EXPECT_THAT(forced.out, testing::HasSubstr("1 of 1 sets, within 40 points"));
  EXPECT_FALSE(std::filesystem::exists(sets_ + "/set-2.json"));
}

TEST_F(EnsembleOfCalibrateTest, EndsWith1IfItFindsTooFew) {
  MakeTarget({}, "1");
  const Outcome outcome = RunFogline(Search({"--ensemble", "50", "--starts", "4"}));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, testing::ContainsRegex("only [0-4] of 50 sets were found"));
}

TEST_F(EnsembleOfCalibrateTest, KeepsOnCtrlCWhatItHasFound) {
  MakeTarget({}, "1");
  std::vector<std::string> command = Search({"--ensemble", "1000", "--starts", "1000"});
  command.insert(command.begin(), Program("fogline"));
  Background search(command);
  ASSERT_TRUE(search.WaitForErr(" of 1000 is found")) << search.Err();
  search.Signal(SIGINT);
  EXPECT_EQ(search.Wait(), 130);
  EXPECT_THAT(search.Err(), testing::ContainsRegex(
                                "interrupted; [0-9]+ of 1000 sets were found and are written"));
  EXPECT_EQ(RunFogline({"check", sets_ + "/set-1.json"}).code, 0);
}

TEST_F(EnsembleOfCalibrateTest, SaysWhatIsWrongWithItsArguments) {
  MakeTarget({}, "1");
  const auto error = [&](const std::vector<std::string>& more) {
    const Outcome outcome = RunFogline(Search(more));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(std::filesystem::exists(sets_));
    return outcome.err;
  };
  EXPECT_THAT(error({"--ensemble", "0"}), testing::HasSubstr("--ensemble: Value 0 not in range"));
  EXPECT_THAT(error({}), testing::HasSubstr("--fresh requires --ensemble"));
  EXPECT_EQ(error({"--ensemble", "2", "--steady", "--free", "/world/host_gap_m=30:40"}),
            "fogline calibrate: error: --free /world/host_gap_m: --steady derives it\n");
  EXPECT_EQ(ErrorOf({"--target", target_, "--free", "/fog/bias_m=0:1", "--ensemble", "2"}),
            "fogline calibrate: error: --ensemble: needs --out FOLDER\n");
  EXPECT_EQ(ErrorOf({"--target", target_, "--free", "/fog/bias_m=0:1", "--ensemble", "2", "--seeds",
                     "1:4", "--fresh", "3:9", "--out", sets_}),
            "fogline calibrate: error: --fresh 3:9: overlaps --seeds 1:4\n");
}

TEST_F(CalibrateTest, SaysWhatIsWrongWithItsArguments) {
  std::ofstream(target_) << R"({"rows": [{"threshold": 0.5, "si_pct": 80}]})";
  const std::vector<std::string> target{"--target", target_, "--free"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), target.begin(), target.end());
    return ErrorOf(more);
  };
  EXPECT_EQ(with({"/fog/bias=0:1"}),
            "fogline calibrate: error: --free /fog/bias=0:1: no such field; did you mean "
            "\"/fog/bias_m\"?\n");
  EXPECT_EQ(with({"/fog/bias_m=0:200"}),
            "fogline calibrate: error: --free /fog/bias_m=0:200: 200 is outside [0, 100] m\n");
  EXPECT_THAT(with({"/fog/bias_m=0:1", "--seeds", "9:1"}),
              testing::StartsWith("fogline calibrate: error: --seeds 9:1: neither A:B "));
  EXPECT_EQ(with({"/fog/bias_m=0:1", "--out", scenario_}),
            scenario_ + ": error: --out: the file exists; --force replaces it\n");
  EXPECT_EQ(with({"/fog/bias_m=0:1", "--out", "/nowhere/x.json"}),
            "/nowhere/x.json: error: --out: there is no folder /nowhere\n");
  EXPECT_EQ(with({"/fog/bias_m=0:1", "--out", folder_.path().string(), "--force"}),
            folder_.path().string() + ": error: --out: cannot write: it is a folder\n");
  EXPECT_THAT(with({"/fog/bias_m=0:1", "--set", "/arbitrator/policy=oracle"}),
              testing::StartsWith(scenario_ + ": error: /arbitrator/policy is oracle, which uses "
                                              "no threshold; these policies do: traded, "));
  EXPECT_EQ(ErrorOf({"--free", "/fog/bias_m=0:1"}),
            scenario_ + ": error: /published: no rows, so there is no target; give a --target\n");
  EXPECT_THAT(ErrorOf({}), testing::HasSubstr("--free is required"));
  EXPECT_THAT(with({"/fog/bias_m=0:1", "--evaluations", "0"}),
              testing::HasSubstr("--evaluations: Value 0 not in range"));
}

}  // namespace
}  // namespace fogline::test
