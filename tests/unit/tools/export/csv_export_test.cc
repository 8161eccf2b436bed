#include "tools/export/csv_export.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/unit/tools/export/example_tables.h"

namespace fogline {
namespace {

TEST(CsvExportTest, HasAColumnForEachFieldAndForEachItemOfAList) {
  const test::ScratchFolder folder;
  exports::WriteCsv(ExampleTables(2), folder.path());
  EXPECT_EQ(test::Content(folder.path() / "TRUTH.csv"),
            "header.run_id,header.step,header.utime,host_gap_m,follower_gap_m.0,follower_gap_m.1\n"
            "7,0,0,30,10,20\n"
            "7,1,100000,31,11,21\n");
  EXPECT_EQ(test::Content(folder.path() / "scenario.json"), "{}\n");
}

TEST(CsvExportTest, HasEmptyCellsInTheRowOfAMissingMessage) {
  const test::ScratchFolder folder;
  exports::RunTables tables = ExampleTables(2);
  tables.channels.front().gaps = {1};
  exports::WriteCsv(tables, folder.path());
  const std::string text = test::Content(folder.path() / "TRUTH.csv");
  EXPECT_EQ(text.substr(text.rfind('\n', text.size() - 2) + 1), "7,1,100000,,,\n");
}

}  // namespace
}  // namespace fogline
