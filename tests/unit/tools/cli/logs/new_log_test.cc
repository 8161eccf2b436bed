#include "tools/cli/logs/new_log.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/input_errors.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

class NewLogTest : public testing::Test {
 protected:
  std::string Refusal(const std::string& file, bool force) const {
    return ErrorOf([&] { cli::PrepareLog(file, force); });
  }
  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
};

TEST_F(NewLogTest, ReplacesALogOnlyByForce) {
  runner::RunScenario(Paper(10), Direct(log_));
  const std::string before = Content(log_);
  EXPECT_EQ(Refusal(log_, false), log_ + ": error: --log: the file exists; --force replaces it");
  {
    const log::LogGuard log = cli::PrepareLog(log_, true);
    EXPECT_EQ(log.path(), log_);
    EXPECT_EQ(Content(log_), "");
    EXPECT_THAT(Refusal(log_, true), HasSubstr("is being written by another run"));
  }
  EXPECT_EQ(Content(log_), before) << "a run that never began gives the older log back";
}

TEST_F(NewLogTest, IsMadeAndIsRemovedIfItStaysEmpty) {
  {
    const log::LogGuard log = cli::PrepareLog(log_, false);
    EXPECT_TRUE(std::filesystem::exists(log_));
  }
  EXPECT_FALSE(std::filesystem::exists(log_));
}

TEST_F(NewLogTest, ReplacesNothingElse) {
  std::ofstream(log_) << "precious";
  EXPECT_EQ(
      Refusal(log_, true),
      log_ + ": error: --log: the file is no event log and is not replaced, even with --force");
  EXPECT_EQ(Content(log_), "precious");
  EXPECT_EQ(Refusal(folder_.path().string(), true),
            folder_.path().string() + ": error: --log: not a file");
  EXPECT_THAT(Refusal(folder_.File("none/run.lcm"), false), HasSubstr("--log"));
}

TEST_F(NewLogTest, HasTheNextNumberOfItsScenario) {
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  {
    const log::LogGuard first = cli::FreshLog("scenario/paper.json");
    const log::LogGuard second = cli::FreshLog("scenario/paper.json");
    EXPECT_EQ(first.path(), "logs/paper-1.lcm");
    EXPECT_EQ(second.path(), "logs/paper-2.lcm");
    EXPECT_TRUE(std::filesystem::exists(second.path()));
  }
  std::filesystem::current_path(here);
}

}  // namespace
}  // namespace fogline::test
