// `fogline export --mcap` on the command line. mcap.test.js compares the numbers in an MCAP file
// with those of the CSV export.
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/logs/export_fixture.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class McapExportTest : public ExportTest {
 protected:
  const std::string mcap_ = folder_.File("run.mcap");
};

TEST_F(McapExportTest, WritesEqualFilesForEqualLogs) {
  const Outcome outcome = Export({"--mcap", mcap_, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["files"], nlohmann::json{mcap_});
  EXPECT_EQ(json["steps"], 230);
  EXPECT_EQ(json["complete"], true);
  const std::string again = folder_.File("again.mcap");
  ASSERT_EQ(Export({"--mcap", again}).code, 0);
  const std::string content = Content(mcap_);
  EXPECT_EQ(content, Content(again));
  // The magic bytes of the MCAP specification, at both ends of the file.
  EXPECT_THAT(content, StartsWith("\x89MCAP0\r\n"));
  EXPECT_THAT(content, EndsWith("\x89MCAP0\r\n"));
}

TEST_F(McapExportTest, ReplacesAnExportIfForcedAndNoOtherFile) {
  ASSERT_EQ(Export({"--mcap", mcap_}).code, 0);
  EXPECT_EQ(Export({"--mcap", mcap_}).err,
            mcap_ + ": error: --mcap: the file exists; --force replaces it\n");
  EXPECT_EQ(Export({"--mcap", mcap_, "--force"}).code, 0);
  // An MCAP file that another program has written.
  std::ofstream(mcap_) << "\x89MCAP0\r\n\1\20another program";
  const Outcome outcome = Export({"--mcap", mcap_, "--force"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, mcap_ +
                             ": error: --mcap: the file is no export and is not replaced, even "
                             "with --force\n");
}

TEST_F(McapExportTest, WantsOneKindOfExport) {
  const Outcome both = Export({"--mcap", mcap_, "--out", out_});
  EXPECT_EQ(both.code, 2);
  EXPECT_EQ(both.err, "fogline export: error: --out excludes --mcap (see fogline export --help)\n");
  const Outcome neither = Export({});
  EXPECT_EQ(neither.code, 2);
  EXPECT_EQ(neither.err,
            "fogline export: error: --out or --mcap is required (see fogline export --help)\n");
}

TEST_F(McapExportTest, WritesWhatALogThatWasCutOffHasAndSaysSo) {
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  const Outcome outcome = Export({"--mcap", mcap_, "--json"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("ends after step "));
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["complete"], false);
  EXPECT_GT(json["steps"], 50);
  EXPECT_TRUE(std::filesystem::exists(mcap_));
}

TEST_F(McapExportTest, MakesNothingOfAFileThatIsNoLog) {
  std::ofstream(log_) << "no log";
  const Outcome outcome = Export({"--mcap", mcap_});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith(log_ + ": error: "));
  EXPECT_FALSE(std::filesystem::exists(mcap_));
}

}  // namespace
}  // namespace fogline::test
