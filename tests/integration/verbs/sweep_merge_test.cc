// `fogline sweep --shard` and `--merge`: several machines make one file.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/integration/verbs/sweep_fixture.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using SweepMergeTest = SweepFixture;

TEST_F(SweepMergeTest, MergesSevenShardsIntoTheFileOfTheWholeSweep) {
  const Words sweep = kShort + kThresholds + Words{"--seeds", "1:30"};
  const std::string whole = Made("whole.csv", sweep);
  Words shards = Shards(7, sweep);
  std::ranges::rotate(shards, shards.begin() + 3);
  const Outcome merge = Merge(shards, "merged.csv");
  EXPECT_EQ(merge.code, 0) << merge.err;
  EXPECT_EQ(merge.out, "90 rows\n" + File("merged.csv") + "\n");
  EXPECT_EQ(Content(File("merged.csv")), whole);
  EXPECT_EQ(Content(File("merged.csv.json")), Content(File("whole.csv.json")));
  EXPECT_EQ(Content(File("merged.csv.sums")), Content(File("whole.csv.sums")));
}

TEST_F(SweepMergeTest, NoticesADigitThatAShardHasNotWritten) {
  const Words shards = Shards(2, kShort + Words{"--seeds", "1:4"});
  std::string text = Content(File(shards[1]));
  text[text.size() - 2] = text[text.size() - 2] == '1' ? '2' : '1';
  std::ofstream(File(shards[1])) << text;
  const Outcome merge = Merge(shards, "merged.csv");
  EXPECT_EQ(merge.code, 2);
  EXPECT_EQ(merge.err, File(shards[1]) +
                           ":3: error: the line differs from the one that its sweep wrote there\n");
  EXPECT_FALSE(std::filesystem::exists(File("merged.csv")));
}

TEST_F(SweepMergeTest, MergesShardsOfWhichSomeHaveNothingToDo) {
  const Words sweep = kShort + Words{"--seeds", "1:3"};
  const std::string whole = Made("whole.csv", sweep);
  EXPECT_EQ(Merge(Shards(5, sweep), "merged.csv").code, 0);
  EXPECT_EQ(Content(File("merged.csv")), whole);
  const Outcome empty = Sweep("empty.csv", sweep + Words{"--shard", "1/5"});
  EXPECT_EQ(empty.code, 0);
  EXPECT_THAT(empty.err,
              HasSubstr("fogline sweep: warning: --shard 1/5: no rows, because the sweep "
                        "can be divided into at most 3 parts\n"));
  EXPECT_THAT(Sweep("one.csv", kShort + Words{"--seeds", "1"}).out, StartsWith("1 row in "));
}

TEST_F(SweepMergeTest, RefusesAWrongMergeInOneLineAndLeavesNoFile) {
  const Words sweep = kShort + Words{"--seeds", "1:9"};
  const Words shards = Shards(3, sweep);
  Made("other.csv", kShort + Words{"--seeds", "1:8", "--shard", "3/3"});
  Made("quarter.csv", sweep + Words{"--shard", "3/4"});
  std::ofstream(File("plain.csv")) << "a,b\n1,2\n";
  std::filesystem::copy(File(shards[2]), File("torn.csv"));
  std::filesystem::copy(File(shards[2] + ".json"), File("torn.csv.json"));
  std::filesystem::resize_file(File("torn.csv"), Content(File("torn.csv")).size() - 1);
  std::filesystem::copy(File(shards[2]), File("long.csv"));
  std::filesystem::copy(File(shards[2] + ".json"), File("long.csv.json"));
  std::ofstream(File("long.csv"), std::ios::app) << "10,\n";
  std::filesystem::copy(File(shards[2]), File("damaged.csv"));
  std::ofstream(File("damaged.csv.json")) << R"({"sweep": {}, "shard": [1]})";
  const Words before = FilesInFolder();

  const auto error = [&](const Words& files) {
    const Outcome merge = Merge(files, "merged.csv");
    EXPECT_EQ(merge.code, 2) << merge.err;
    EXPECT_EQ(merge.out, "");
    EXPECT_EQ(CountLines(merge.err), 1) << merge.err;
    EXPECT_EQ(FilesInFolder(), before);
    return merge.err;
  };
  EXPECT_EQ(error({shards[0], shards[2]}),
            "fogline sweep: error: --merge: shard 2 of 3 is missing\n");
  EXPECT_EQ(error({shards[0], shards[1], shards[1], shards[2]}),
            File(shards[1]) + ": error: shard 2 of 3, the same as " + File(shards[1]) + "\n");
  EXPECT_EQ(error({shards[0], shards[1], "torn.csv"}),
            File("torn.csv") + ": error: has 2 of 3 rows; run its sweep again to finish it\n");
  EXPECT_EQ(error({shards[0], shards[1], "long.csv"}),
            File("long.csv") + ": error: has more than its 3 rows\n");
  EXPECT_EQ(error({shards[0], shards[1], "other.csv"}),
            File("other.csv") + ": error: not of the same sweep as " + File(shards[0]) + "\n");
  EXPECT_EQ(
      error({shards[0], shards[1], "quarter.csv"}),
      File("quarter.csv") + ": error: shard 3 of 4, but " + File(shards[0]) + " is a shard of 3\n");
  EXPECT_EQ(error({shards[0], "plain.csv"}),
            File("plain.csv") + ": error: not the result of a sweep: " + File("plain.csv.json") +
                " is missing\n");
  EXPECT_EQ(error({shards[0], "damaged.csv"}), File("damaged.csv") +
                                                   ": error: not the result of a sweep: " +
                                                   File("damaged.csv.json") + " is damaged\n");
  EXPECT_EQ(error({shards[0], "nowhere.csv"}), File("nowhere.csv") +
                                                   ": error: not the result of a sweep: " +
                                                   File("nowhere.csv.json") + " is missing\n");
}

TEST_F(SweepMergeTest, DoesNotMergeOverAFileThatIsThere) {
  const Words shards = Shards(2, kShort + Words{"--seeds", "1:4"});
  const std::string first = Content(File(shards[0]));
  std::ofstream(File("there.csv")) << "precious";
  EXPECT_EQ(Merge(shards, "there.csv").err,
            File("there.csv") + ": error: --out: the file exists; --force replaces it\n");
  EXPECT_EQ(Content(File("there.csv")), "precious");
  const Words forced{Program("fogline"), "sweep",         "--force", "--merge",
                     File(shards[0]),    File(shards[1]), "--out"};
  EXPECT_EQ(RunCommand(forced + Words{File("there.csv")}).err,
            File("there.csv") +
                ": error: --out: the file is no sweep and is not replaced, even with --force\n");
  EXPECT_EQ(Content(File("there.csv")), "precious");
  Made("sweep.csv", kShort + Words{"--seeds", "7:7"});
  EXPECT_EQ(RunCommand(forced + Words{File("sweep.csv")}).code, 0);
  EXPECT_EQ(CountLines(Content(File("sweep.csv"))), 1 + 4);
  const Outcome onto_shard =
      RunCommand({Program("fogline"), "sweep", "--force", "--out", File(shards[0]), "--merge",
                  File(shards[0]), File(shards[1])});
  EXPECT_EQ(onto_shard.code, 2);
  EXPECT_EQ(onto_shard.err, File(shards[0]) + ": error: --out: is one of the shards\n");
  EXPECT_EQ(Content(File(shards[0])), first);
}

TEST_F(SweepMergeTest, DoesNotBelieveARowWithoutAChecksum) {
  const Words sweep = kShort + Words{"--seeds", "1:8"};
  const Words shards = Shards(2, sweep);
  // GIVEN checksums that end early, and a changed digit in the row after them
  std::filesystem::resize_file(File(shards[1] + ".sums"), 3 * 9);
  std::string text = Content(File(shards[1]));
  const std::string whole = text;
  text[text.size() - 2] = text[text.size() - 2] == '1' ? '2' : '1';
  std::ofstream(File(shards[1])) << text;
  const Outcome merge = Merge(shards, "merged.csv");
  EXPECT_EQ(merge.code, 2);
  EXPECT_EQ(
      merge.err,
      File(shards[1]) +
          ":5: error: the row has no checksum; run its sweep again to compute the row again\n");
  EXPECT_FALSE(std::filesystem::exists(File("merged.csv")));
  // WHEN the sweep is run again, as the error text says
  EXPECT_EQ(Made(shards[1], sweep + Words{"--shard", "2/2"}), whole);
  EXPECT_EQ(Merge(shards, "merged.csv").code, 0);
}

TEST_F(SweepMergeTest, NamesEachFileWhoseRowsItCannotCheck) {
  const Words shards = Shards(4, kShort + Words{"--seeds", "1:3"});
  const auto warning = [&](const std::string& shard) {
    return "fogline sweep: warning: " + File(shard) + ": the rows are not checked, because " +
           File(shard) + ".sums is missing or empty\n";
  };
  // GIVEN two files that were copied without their checksum files, and a file with an empty
  // checksum file. The first file has no rows, so it needs no check
  ASSERT_EQ(CountLines(Content(File(shards[0]))), 1);
  std::filesystem::remove(File(shards[0] + ".sums"));
  std::filesystem::remove(File(shards[1] + ".sums"));
  std::filesystem::resize_file(File(shards[3] + ".sums"), 0);
  const Outcome merge = Merge(shards, "merged.csv");
  EXPECT_EQ(merge.code, 0);
  EXPECT_EQ(merge.out, "3 rows\n" + File("merged.csv") + "\n");
  EXPECT_EQ(merge.err, warning(shards[1]) + warning(shards[3]));
  // AND --json names these files. The list in --json is empty if all files were checked
  const Words with_json{Program("fogline"), "sweep", "--json",
                        "--force",          "--out", File("merged.csv")};
  const Words merge_all{"--merge", File(shards[0]), File(shards[1]), File(shards[2]),
                        File(shards[3])};
  const Outcome as_json = RunCommand(with_json + merge_all);
  EXPECT_EQ(as_json.err, merge.err);
  EXPECT_EQ(nlohmann::json::parse(as_json.out)["unchecked"],
            (Words{File(shards[1]), File(shards[3])}));
  const Words whole = Shards(2, kShort + Words{"--seeds", "1:2"});
  const Outcome checked = RunCommand(with_json + Words{"--merge", File(whole[0]), File(whole[1])});
  EXPECT_EQ(checked.err, "");
  EXPECT_EQ(nlohmann::json::parse(checked.out)["unchecked"], nlohmann::json::array());
}

TEST_F(SweepMergeTest, ReplacesNoFileBesideTheMergedOneThatIsOfNoSweep) {
  const Words shards = Shards(2, kShort + Words{"--seeds", "1:4"});
  std::ofstream(File("merged.json")) << R"({"version": 1})";
  std::ofstream(File("other.sums")) << "d41d8cd98f00b204e9800998ecf8427e  thesis.tex\n";
  for (const Words& files : {Words{"merged", ".json", "sweep description"},
                             Words{"other", ".sums", "file of checksums"}}) {
    const std::string side = File(files[0]) + files[1];
    const std::string before = Content(side);
    const Outcome merge = Merge(shards, files[0]);
    EXPECT_EQ(merge.code, 2);
    EXPECT_EQ(merge.err, side + ": error: --out: the file is no " + files[2] +
                             " and is not replaced, even with --force\n");
    EXPECT_EQ(Content(side), before);
    EXPECT_FALSE(std::filesystem::exists(File(files[0])));
  }
}

}  // namespace
}  // namespace fogline::test
