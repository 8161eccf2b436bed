// `fogline sweep` as a person uses it: the real program, which the tests kill, resume, and call
// with bad arguments. The tests compare the bytes of the file that the sweep writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/integration/verbs/sweep_fixture.h"

namespace fogline::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using SweepTest = SweepFixture;

TEST_F(SweepTest, WritesTheSameFileWhateverTheNumberOfJobs) {
  const Words sweep =
      kShort + kThresholds + Words{"--grid", "/fog/bias_m=0.2,0.3", "--seeds", "1:40"};
  const std::string one = Made("one.csv", sweep + Words{"--jobs", "1"});
  EXPECT_EQ(CountLines(one), 1 + 3 * 2 * 40);
  EXPECT_EQ(Made("two.csv", sweep + Words{"--jobs", "2"}), one);
  EXPECT_EQ(Made("many.csv", sweep + Words{"--jobs", "9"}), one);
  EXPECT_EQ(Content(File("two.csv.json")), Content(File("one.csv.json")));
}

TEST_F(SweepTest, OrdersRowsByTheOtherAxesThenSeedThenTheArbitratorsAxes) {
  std::istringstream rows(
      Made("rows.csv", kShort + Words{"--grid", "/arbitrator/threshold=0.5,0.2", "--grid",
                                      "/fog/bias_m=0.3,0.1", "--seeds", "4:5"}));
  std::string row;
  std::getline(rows, row);
  EXPECT_THAT(row, StartsWith("/arbitrator/threshold,/fog/bias_m,seed,si_pct,steps,"));
  for (const char* key : {"0.5,0.3,4,", "0.2,0.3,4,", "0.5,0.3,5,", "0.2,0.3,5,", "0.5,0.1,4,",
                          "0.2,0.1,4,", "0.5,0.1,5,", "0.2,0.1,5,"}) {
    std::getline(rows, row);
    EXPECT_THAT(row, StartsWith(key));
  }
  EXPECT_FALSE(std::getline(rows, row));
}

TEST_F(SweepTest, GoesOnAfterAKillWithoutLosingOrRepeatingARow) {
  const Words sweep = kThresholds + Words{"--seeds", "1:1500", "--jobs", "2"};
  const std::string whole = Made("whole.csv", sweep);
  for (const int lines : {2, 700}) {
    // GIVEN a sweep that is killed in its middle
    const std::string name = "killed" + std::to_string(lines) + ".csv";
    Background killed(Command(name, sweep));
    ASSERT_TRUE(WaitForLines(name, lines));
    killed.Signal(SIGKILL);
    ASSERT_EQ(killed.Wait(), 128 + SIGKILL) << "it had ended before";
    ASSERT_LT(CountLines(Content(File(name))), CountLines(whole));
    // WHEN the same command is called again
    const Outcome resumed = Sweep(name, sweep);
    // THEN the sweep reports how many rows the file had, and the file equals that of an undisturbed
    // sweep
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("of 4500 rows are there\n"));
    EXPECT_TRUE(Content(File(name)) == whole) << lines;
  }
}

TEST_F(SweepTest, GoesOnWhereverAKillHasTornTheFile) {
  const Words sweep = kShort + kThresholds + Words{"--seeds", "1:3", "--jobs", "1"};
  const std::string whole = Made("torn.csv", sweep);
  const std::size_t header = whole.find('\n') + 1;
  const std::size_t second_row = whole.find('\n', header) + 1;
  // The file is cut in the header, after the header, in the first row, after the first row, and at
  // regular distances. The cut after the first row is in the middle of a unit of work, which has
  // three rows.
  std::vector<std::size_t> cuts{0,          1,          header - 1,       header,
                                header + 1, second_row, whole.size() - 1, whole.size()};
  for (std::size_t cut = 0; cut < whole.size(); cut += whole.size() / 13) cuts.push_back(cut);
  for (const std::size_t cut : cuts) {
    std::filesystem::resize_file(File("torn.csv"), cut);
    EXPECT_EQ(Made("torn.csv", sweep), whole) << "cut at " << cut;
  }
}

TEST_F(SweepTest, EndsAtCtrlCWithWholeUnitsAndGoesOn) {
  const Words sweep = kThresholds + Words{"--seeds", "1:1500", "--jobs", "2"};
  const std::string whole = Made("whole.csv", sweep);
  Background stopped(Command("stopped.csv", sweep));
  ASSERT_TRUE(WaitForLines("stopped.csv", 300));
  stopped.Signal(SIGINT);
  EXPECT_EQ(stopped.Wait(), 130);
  EXPECT_THAT(stopped.Err(), HasSubstr("call it again to go on\n"));
  const std::string part = Content(File("stopped.csv"));
  EXPECT_TRUE(whole.starts_with(part));
  EXPECT_EQ((CountLines(part) - 1) % 3, 0);
  EXPECT_TRUE(Made("stopped.csv", sweep) == whole);
}

TEST_F(SweepTest, HasNothingLeftToDoWhenItsFileIsComplete) {
  const Words sweep = kShort + Words{"--seeds", "1:5", "--json"};
  const std::string whole = Made("whole.csv", sweep);
  const Outcome again = Sweep("whole.csv", sweep);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out)["runs"], 0);
  EXPECT_EQ(Content(File("whole.csv")), whole);
}

TEST_F(SweepTest, DoesNotReplaceTheFileOfAnotherSweepUnlessForced) {
  const std::string first = Made("file.csv", kShort + Words{"--seeds", "1:4"});
  for (const Words& other : {kShort + Words{"--seeds", "1:5"},
                             kShort + Words{"--seeds", "1:4", "--set", "/fog/bias_m=0.1"},
                             kShort + Words{"--seeds", "1:4", "--shard", "1/2"}}) {
    const Outcome refused = Sweep("file.csv", other);
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.err, File("file.csv") +
                               ": error: --out: the file exists and is not of this sweep; "
                               "--force replaces it\n");
    EXPECT_EQ(Content(File("file.csv")), first);
  }
  const Words other = kShort + Words{"--seeds", "1:5"};
  const std::string forced = Made("file.csv", other + Words{"--force"});
  EXPECT_EQ(forced, Made("fresh.csv", other));
  EXPECT_EQ(Content(File("file.csv.json")), Content(File("fresh.csv.json")));
}

TEST_F(SweepTest, ReplacesNoFileThatIsNoSweepWhateverIsForced) {
  std::ofstream(File("scenario.json")) << "{}";
  for (const Words& force : {Words{}, Words{"--force"}}) {
    const Outcome refused = Sweep("scenario.json", kShort + force);
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(refused.err,
              File("scenario.json") +
                  ": error: --out: the file is no sweep and is not replaced, even with --force\n");
    EXPECT_EQ(Content(File("scenario.json")), "{}");
  }
}

TEST_F(SweepTest, RefusesAFileThatIsBeingWritten) {
  const Words sweep = kThresholds + Words{"--seeds", "1:100000"};
  Background writer(Command("file.csv", sweep));
  ASSERT_TRUE(WaitForLines("file.csv", 2));
  const Outcome second = Sweep("file.csv", sweep);
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(second.err,
            File("file.csv") + ": error: --out: cannot write: another sweep is writing it\n");
}

TEST_F(SweepTest, NoticesALineThatItHasNotWritten) {
  const Words sweep = kShort + Words{"--seeds", "1:4"};
  std::string text = Made("file.csv", sweep);
  text.replace(text.find("\n3,"), 3, "\n4,");
  std::ofstream(File("file.csv")) << text;
  const Outcome refused = Sweep("file.csv", sweep);
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.err, File("file.csv") +
                             ":4: error: --out: the line differs from the one that this sweep "
                             "writes there; --force starts over\n");
  EXPECT_EQ(Content(File("file.csv")), text);
}

TEST_F(SweepTest, NoticesADigitThatItHasNotWritten) {
  const Words sweep = kShort + kThresholds + Words{"--seeds", "1:4"};
  const std::string whole = Made("file.csv", sweep);
  // GIVEN a file that ends early, and in which one digit was altered. The digit is near the end of
  // a row in the middle of the file, far from the axis values and the seed at the beginning of the
  // row
  std::string text = whole.substr(0, whole.rfind('\n', whole.size() - 2) + 1);
  const std::size_t digit = text.find_last_of("123456789", text.find('\n', text.size() / 2) - 1);
  text[digit] = text[digit] == '1' ? '2' : '1';
  std::ofstream(File("file.csv")) << text;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(digit), '\n');
  const Outcome refused = Sweep("file.csv", sweep);
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.err, File("file.csv") + ":" + std::to_string(line) +
                             ": error: --out: the line differs from the one that this sweep has "
                             "written there; --force starts over\n");
  EXPECT_EQ(Content(File("file.csv")), text);
  // AND without the checksum file the sweep accepts the rows as they are, and makes checksums for
  // later checks
  std::filesystem::remove(File("file.csv.sums"));
  EXPECT_EQ(Sweep("file.csv", sweep).code, 0);
  std::filesystem::resize_file(File("file.csv"), text.size());
  EXPECT_EQ(CountLines(Made("file.csv", sweep)), CountLines(whole));
}

TEST_F(SweepTest, HasTheSameChecksumsWhereverAKillHasTornThem) {
  const Words sweep = kShort + kThresholds + Words{"--seeds", "1:3", "--jobs", "1"};
  const std::string whole = Made("torn.csv", sweep);
  const std::string sums = Content(File("torn.csv.sums"));
  EXPECT_EQ(CountLines(sums), 9);
  for (std::size_t cut = 1; cut <= sums.size(); cut += 4) {
    std::filesystem::resize_file(File("torn.csv.sums"), cut);
    EXPECT_EQ(Made("torn.csv", sweep), whole) << "cut at " << cut;
    EXPECT_EQ(Content(File("torn.csv.sums")), sums) << "cut at " << cut;
  }
}

TEST_F(SweepTest, FailsWhenItsFileIsRemovedMeanwhile) {
  for (const char* how : {"removed", "replaced"}) {
    Background sweep(Command("file.csv", kThresholds + Words{"--seeds", "1:100000"}));
    ASSERT_TRUE(WaitForLines("file.csv", 2));
    if (std::string(how) == "removed") {
      std::filesystem::remove(File("file.csv"));
    } else {
      std::ofstream(File("other")) << "precious";
      std::filesystem::rename(File("other"), File("file.csv"));
    }
    EXPECT_EQ(sweep.Wait(), 3) << how;
    EXPECT_THAT(sweep.Err(), HasSubstr("file.csv: the file was removed or replaced while the sweep "
                                       "wrote it, and its rows are lost"));
  }
  EXPECT_EQ(Content(File("file.csv")), "precious");
}

TEST_F(SweepTest, ChoosesANameOfItsOwnBesideAnotherSweep) {
  const auto sweep = [&](const Words& more) {
    const Outcome outcome = RunCommand(
        Words{"sh", "-c", "cd '" + folder_.path().string() + "' && exec \"$@\"", "sh",
              Program("fogline"), "sweep", (SourceDirectory() / "scenario/paper.json").string()} +
        kShort + more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out.substr(outcome.out.find('\n') + 1);
  };
  EXPECT_EQ(sweep({"--seeds", "1:2"}), "paper-sweep.csv\n");
  EXPECT_EQ(sweep({"--seeds", "1:3"}), "paper-sweep-2.csv\n");
  EXPECT_EQ(sweep({"--seeds", "1:2"}), "paper-sweep.csv\n") << "it goes on with its own";
  std::ofstream(File("paper-sweep-3.csv")) << "no sweep";
  EXPECT_EQ(sweep({"--seeds", "1:4"}), "paper-sweep-4.csv\n");
}

TEST_F(SweepTest, SaysWhatIsWrongWithItsArgumentsInOneLine) {
  const auto error = [&](const Words& more) {
    const Outcome outcome = Sweep("none.csv", more);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(FilesInFolder(), Words{});
    return outcome.err;
  };
  EXPECT_EQ(error({"--grid", "threshold=1"}),
            "fogline sweep: error: --grid threshold=1: neither /pointer=a,b,c nor "
            "/pointer=first:last:count\n");
  EXPECT_EQ(error({"--grid", "/arbitrator/treshold=0.2"}),
            "fogline sweep: error: /arbitrator/treshold: no field of a scenario; did you mean "
            "/arbitrator/threshold?\n");
  EXPECT_EQ(error({"--grid", "/arbitrator/threshold=0.2,2"}),
            "fogline sweep: error: --grid /arbitrator/threshold=2: 2 is outside [0, 1]\n");
  EXPECT_THAT(error({"--grid", "/arbitrator/threshold=0.2,,0.3"}), HasSubstr("an empty value\n"));
  EXPECT_THAT(
      error({"--grid", "/arbitrator/threshold=0:1:1"}),
      HasSubstr("not first:last:count with two finite numbers and a count from 2 to 1000000\n"));
  EXPECT_EQ(error({"--grid", "/fog/bias_m=1", "--grid", "/fog/bias_m=2"}),
            "fogline sweep: error: --grid /fog/bias_m: given twice\n");
  EXPECT_EQ(error({"--grid", "/seed=1,2"}),
            "fogline sweep: error: --grid /seed: seeds are given by --seeds\n");
  EXPECT_EQ(error({"--grid", "/steps=1,2"}),
            "fogline sweep: error: --grid /steps: runs of one sweep are equally long\n");
  EXPECT_EQ(
      error({"--grid", "/title=a"}),
      "fogline sweep: error: /title cannot be \"a\" here: only numbers, choices and flags can "
      "be varied\n");
  EXPECT_EQ(error({"--seeds", "5:4"}),
            "fogline sweep: error: --seeds 5:4: neither A:B with 0 <= A <= B <= 9007199254740991 "
            "nor one seed\n");
  for (const std::string text : {"1..5", "1-5"}) {
    EXPECT_THAT(error({"--seeds", text}), testing::EndsWith("nor one seed; did you mean 1:5?\n"));
  }
  for (const std::string text : {"1.5", "5-1", "-5", "1-5-9", ".."}) {
    EXPECT_THAT(error({"--seeds", text}), testing::EndsWith("nor one seed\n"));
  }
  EXPECT_EQ(error({"--seeds", "1:9007199254740992"}),
            "fogline sweep: error: --seeds 1:9007199254740992: neither A:B with 0 <= A <= B <= "
            "9007199254740991 "
            "nor one seed\n");
  EXPECT_EQ(error({"--seeds", "1:1000000000", "--grid", "/fog/bias_m=0:1:101"}),
            "fogline sweep: error: --seeds 1:1000000000: more than 100000000000 rows in all\n");
  EXPECT_EQ(error({"--grid", "/fog/bias_m=0:1:5000", "--grid", "/lidar/bias_m=0:1:5000", "--grid",
                   "/radar/bias_m=0:1:5000"}),
            "fogline sweep: error: --grid: more than 100000000000 rows\n");
  for (const std::string field : {"/lead/recorded/start_s", "/step_s"}) {
    EXPECT_EQ(RunCommand({Program("fogline"), "sweep", "scenario/recorded_lead.json", "--out",
                          File("recorded.csv"), "--grid", field + "=0.05,0.1"})
                  .err,
              "fogline sweep: error: --grid " + field +
                  ": the recording of the leader is read once, before the runs\n");
  }
  EXPECT_EQ(error({"--shard", "4/3"}),
            "fogline sweep: error: --shard 4/3: not I/N with 1 <= I <= N <= 1000000\n");
  EXPECT_THAT(error({"--jobs", "0"}), StartsWith("fogline sweep: error: --jobs: "));
  EXPECT_THAT(error({"--merge", "part.csv"}),
              StartsWith("fogline sweep: error: SCENARIO excludes --merge"));
  EXPECT_EQ(RunCommand({Program("fogline"), "sweep"}).err,
            "fogline sweep: error: SCENARIO is required\n");
  EXPECT_EQ(RunCommand({Program("fogline"), "sweep", "--merge", "x"}).err,
            "fogline sweep: error: --merge needs --out\n");
  EXPECT_THAT(RunCommand({Program("fogline"), "sweep", "--help"}).out, HasSubstr("Examples:"));
}

TEST_F(SweepTest, VariesTheFieldsOfAListsItems) {
  const Words cars{"--set", R"(/followers/cars=[{"driver":"human"},{"driver":"acc"}])"};
  const Words axis{"--grid", "/followers/cars/0/style=normal,aggressive", "--seeds", "1:1"};
  const std::string rows = Made("rows.csv", kShort + cars + axis);
  // A row begins with the value of the grid. After this value, the row has the same cells as a
  // sweep of the same cars without a grid.
  const Words aggressive{
      "--set", R"(/followers/cars=[{"driver":"human","style":"aggressive"},{"driver":"acc"}])",
      "--seeds", "1:1"};
  const std::string alone = Made("alone.csv", kShort + aggressive);
  const std::string row = alone.substr(alone.find('\n') + 1);
  EXPECT_THAT(rows, EndsWith("\naggressive," + row));
  EXPECT_THAT(rows, Not(HasSubstr("\nnormal," + row)));
  const Outcome outcome =
      Sweep("none.csv", kShort + cars + Words{"--grid", "/followers/cars/2/style=normal"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            "fogline sweep: error: --grid /followers/cars/2/style=normal: no such item: "
            "/followers/cars has 2 items, counted from 0\n");
}

TEST_F(SweepTest, NamesTheFirstRowThatCannotBeComputedAndKeepsThoseBefore) {
  // GIVEN two values of the weight of the distance. With the second value the optimisation problem
  // of the ACC is ill-conditioned
  const Words sweep = kShort + Words{"--set",   "/step_s=1",
                                     "--set",   "/acc/horizon_steps=60",
                                     "--set",   "/acc/headway_s=0",
                                     "--set",   "/acc/engine_gain=10",
                                     "--set",   "/acc/weight_speed=0",
                                     "--set",   "/acc/weight_acceleration=0",
                                     "--set",   "/acc/weight_control=1e-6",
                                     "--set",   "/acc/weight_control_change=0",
                                     "--grid",  "/acc/weight_distance=0,1e6",
                                     "--seeds", "1:4"};
  for (const char* jobs : {"1", "2"}) {
    const Outcome outcome = Sweep(jobs, sweep + Words{"--jobs", jobs});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err,
                StartsWith("scenario/paper.json: error: ACC: the weights make an ill-conditioned"));
    EXPECT_THAT(outcome.err, EndsWith(" (at /acc/weight_distance=1e6, seed 1)\n"));
    EXPECT_EQ(CountLines(Content(File(jobs))), 1 + 4) << jobs;
  }
}

TEST_F(SweepTest, SaysThatTheDiskIsFullAndGoesOnWhenThereIsRoom) {
  const Words sweep = kShort + kThresholds + Words{"--seeds", "1:100"};
  const std::string whole = Made("whole.csv", sweep);
  ASSERT_GT(whole.size(), 32 * 1024U);
  // GIVEN a limit of 16 KiB for a file. Beyond this limit a write fails as on a full disk
  const Outcome full =
      RunCommand(Words{"bash", "-c", "trap '' XFSZ; ulimit -f 16; exec \"$@\"", "-"} +
                 Command("full.csv", sweep));
  EXPECT_EQ(full.code, 3);
  EXPECT_EQ(full.err, "fogline sweep: error: " + File("full.csv") +
                          ": cannot write: File too large; call it again to continue at the end "
                          "of the file\n");
  EXPECT_EQ(Content(File("full.csv")), whole.substr(0, 16 * 1024U));
  // WHEN the limit is lifted THEN the sweep continues
  EXPECT_EQ(Made("full.csv", sweep), whole);
}

TEST_F(SweepTest, SaysThatADeviceHasNoSpaceLeft) {
  std::filesystem::create_symlink("/dev/full", File("device.csv"));
  const Outcome full = Sweep("device.csv", kShort);
  EXPECT_EQ(full.code, 3);
  EXPECT_THAT(full.err, HasSubstr("device.csv: cannot write: No space left on device"));
}

/// The rows of a CSV file. Each row is a map from the name of a column to a text.
std::vector<std::map<std::string, std::string>> Rows(const std::string& csv) {
  std::istringstream lines(csv);
  std::vector<std::map<std::string, std::string>> rows;
  std::string line;
  Words columns;
  while (std::getline(lines, line)) {
    std::istringstream cells(line + ",");
    Words values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
    if (columns.empty()) {
      columns = values;
      continue;
    }
    rows.emplace_back();
    for (std::size_t i = 0; i < columns.size(); ++i) rows.back()[columns[i]] = values.at(i);
  }
  return rows;
}

/// Expects that a cell has the value of a JSON number; the cell is empty for null.
void ExpectSame(const std::string& cell, const nlohmann::json& value, const std::string& what) {
  if (value.is_null()) {
    EXPECT_EQ(cell, "") << what;
  } else {
    EXPECT_EQ(std::stod(cell), value.get<double>()) << what << ": " << cell;
  }
}

TEST_F(SweepTest, HasInEachRowWhatTheSameRunMeasuresAndTheTableSays) {
  // GIVEN a sweep over a field of the arbitrator and another field
  const auto rows = Rows(
      Made("rows.csv", kThresholds + Words{"--grid", "/fog/bias_m=0.2,0.34", "--seeds", "3:4"}));
  ASSERT_EQ(rows.size(), 12U);
  for (const auto& row : rows) {
    const std::string threshold = row.at("/arbitrator/threshold");
    const Words settings{"scenario/paper.json", "--json", "--seed",
                         row.at("seed"),        "--set",  "/fog/bias_m=" + row.at("/fog/bias_m")};
    // WHEN the run of a row takes place alone THEN every measure has the same value
    const Outcome run =
        RunCommand(Words{Program("fogline"), "run"} + settings +
                   Words{"--transport", "direct", "--set", "/arbitrator/threshold=" + threshold});
    const auto measures = nlohmann::json::parse(run.out)["metrics"];
    EXPECT_GE(measures.size(), 15U);
    for (const auto& [name, value] : measures.items()) {
      ExpectSame(row.at(name), value, "threshold " + threshold + " " + name);
    }
    // AND the safety improvement equals that in the table
    const Outcome table = RunCommand(Words{Program("fogline"), "table"} + settings +
                                     Words{"--thresholds", threshold});
    ExpectSame(row.at("si_pct"), nlohmann::json::parse(table.out)["rows"][0]["si_pct"],
               "threshold " + threshold + " si_pct");
  }
}

}  // namespace
}  // namespace fogline::test
