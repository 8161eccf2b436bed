#include "tools/sweep/sweep_csv.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"
#include "tools/sweep/merge.h"
#include "tools/sweep/row_sums.h"

namespace fogline {
namespace {

using test::ErrorOf;
using ::testing::EndsWith;

/// Two rows in each of four units.
sweep::SweepPlan PlanOfFourUnits() {
  Scenario scenario;
  scenario.steps = 20;
  return {scenario, {sweep::ParseAxis("/arbitrator/threshold=0.2,0.8")}, {.first = 1, .last = 4}};
}

class SweepFileTest : public testing::Test {
 protected:
  /// Opens a sweep's file and writes the units that the file lacks, up to `end`.
  /// @return the first unit that the file lacked
  std::int64_t Write(const std::string& file, std::int64_t end, const sweep::Shard& shard = {}) {
    sweep::SweepFile csv(file, plan_, shard, /*force=*/false);
    sweep::SweepWorker worker(plan_);
    const std::int64_t first = csv.next_unit();
    std::vector<sweep::SweepRow> rows;
    while (csv.next_unit() < end) {
      worker.Compute(csv.next_unit(), rows);
      csv.Append(rows);
    }
    return first;
  }
  void Replace(const std::string& file, const std::string& content) const {
    std::ofstream(file, std::ios::binary) << content;
  }
  static std::size_t LinesIn(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  const sweep::SweepPlan plan_ = PlanOfFourUnits();
  const test::ScratchFolder folder_;
  const std::string file_ = folder_.File("sweep.csv");
};

TEST_F(SweepFileTest, GoesOnAfterTheLastWholeUnitWhereverItIsCut) {
  Write(file_, 4);
  const std::string whole = test::Content(file_);
  const std::string sums = test::Content(sweep::SumsFile(file_));
  for (std::size_t size = whole.find('\n') + 1; size <= whole.size(); size += 97) {
    Replace(file_, whole.substr(0, size));
    const std::size_t rows = LinesIn(whole.substr(0, size)) - 1;
    EXPECT_EQ(Write(file_, 4), static_cast<std::int64_t>(rows / 2)) << size << " bytes";
    ASSERT_EQ(test::Content(file_), whole) << size << " bytes";
    EXPECT_EQ(test::Content(sweep::SumsFile(file_)), sums);
  }
}

TEST_F(SweepFileTest, GoesOnWithNoRowOfAnotherPlan) {
  Write(file_, 2);
  std::string rows = test::Content(file_);
  const std::size_t seed = rows.rfind("\n0.2,2,");
  ASSERT_NE(seed, rows.npos);
  rows.replace(seed, 7, "\n0.2,3,");
  Replace(file_, rows);
  std::filesystem::remove(sweep::SumsFile(file_));  // so that only the plan shows the error
  EXPECT_EQ(ErrorOf([&] { Write(file_, 4); }),
            file_ +
                ":4: error: --out: the line differs from the one that this sweep writes "
                "there; --force starts over");
}

TEST_F(SweepFileTest, HasOneWriterAtATime) {
  const sweep::SweepFile first(file_, plan_, {}, /*force=*/false);
  EXPECT_EQ(ErrorOf([&] { sweep::SweepFile(file_, plan_, {}, /*force=*/false); }),
            file_ + ": error: --out: cannot write: another sweep is writing it");
}

TEST_F(SweepFileTest, IsNotMergedWithMoreOrFewerRowsThanItsShardHas) {
  const std::string shards[] = {folder_.File("one.csv"), folder_.File("two.csv")};
  Write(shards[0], 2, {.index = 1, .count = 2});
  Write(shards[1], 4, {.index = 2, .count = 2});
  const auto merge = [&] { sweep::MergeShards({shards[0], shards[1]}, file_, /*force=*/true); };
  EXPECT_EQ(ErrorOf(merge), "");
  Write(folder_.File("whole.csv"), 4);
  EXPECT_EQ(test::Content(file_), test::Content(folder_.File("whole.csv")));

  // A shard without checksums, so that only the number of rows shows the error.
  std::filesystem::remove(sweep::SumsFile(shards[1]));
  const std::string rows = test::Content(shards[1]);
  const std::size_t last = rows.rfind('\n', rows.size() - 2) + 1;
  Replace(shards[1], rows + rows.substr(last));
  EXPECT_THAT(ErrorOf(merge), EndsWith("two.csv: error: has more than its 4 rows"));
  Replace(shards[1], rows.substr(0, last));
  EXPECT_THAT(ErrorOf(merge), EndsWith("has 3 of 4 rows; run its sweep again to finish it"));
}

}  // namespace
}  // namespace fogline
