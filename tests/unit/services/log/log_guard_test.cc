// Tests what happens to the file of a log while a run writes it.
#include "services/log/log_guard.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline::test {
namespace {

namespace fs = std::filesystem;
using log::LogGuard;
using log::TakeBackOlder;

TEST(LogGuardTest, OfARunThatNeverBeganIsRemovedAndALinkToItStays) {
  const ScratchFolder folder;
  const fs::path log = folder.File("run.lcm");
  const fs::path link = folder.File("link.lcm");
  fs::create_symlink(log, link);
  { const LogGuard run(link); }
  EXPECT_FALSE(fs::exists(log));
  EXPECT_TRUE(fs::is_symlink(link));
}

/// A log, and runs that shall replace this log.
class OlderLogTest : public testing::Test {
 protected:
  OlderLogTest() { WriteShortLog(log_); }

  LogGuard Replace() const {
    return LogGuard::InPlaceOf(
        log_, std::make_unique<FileLock>(log_, FileLock::Kind::kOwn, "--log", "run"));
  }
  /// A process begins to replace the log, calls `work`, and ends without cleanup, as after kill -9.
  template <class Work>
  void ReplaceAndBeKilled(const Work& work) const {
    const pid_t process = fork();
    if (process == 0) {
      const LogGuard run = Replace();
      work();
      _exit(0);
    }
    waitpid(process, nullptr, 0);
  }
  std::ptrdiff_t FilesInFolder() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string aside_ = fs::canonical(folder_.path()) / ".fogline-older-run.lcm";
};

TEST_F(OlderLogTest, IsGoneAsSoonAsTheNewLogHasAStep) {
  LogGuard run = Replace();
  EXPECT_EQ(FilesInFolder(), 2);
  WriteShortLog(log_);
  run.RemoveOlder();
  EXPECT_EQ(FilesInFolder(), 1);
  EXPECT_TRUE(log::HasSteps(log_));
}

TEST_F(OlderLogTest, ComesBackAfterAKillBeforeTheFirstStep) {
  const std::string older = Content(log_);
  const std::string back = log_ +
                           ": the older log is back: the run that was to replace it was "
                           "killed before its first step";
  // Three cases: the new log is empty, has only a scenario, or was removed by the user.
  ReplaceAndBeKilled([] {});
  ASSERT_EQ(Content(log_), "");
  EXPECT_EQ(TakeBackOlder(log_, "--log"), back);
  EXPECT_EQ(Content(log_), older);
  ReplaceAndBeKilled([this] {
    WriteShortLog(log_, {.has = [](std::string_view, std::int64_t) { return false; }});
  });
  ASSERT_NE(Content(log_), older);
  EXPECT_EQ(TakeBackOlder(log_, "--log"), back);
  EXPECT_EQ(Content(log_), older);
  ReplaceAndBeKilled([] {});
  fs::remove(log_);
  EXPECT_EQ(TakeBackOlder(log_, "--log"), back);
  EXPECT_EQ(Content(log_), older);
  EXPECT_EQ(FilesInFolder(), 1);
  EXPECT_EQ(TakeBackOlder(log_, "--log"), "");
}

TEST_F(OlderLogTest, ComesBackWhereALinkLeads) {
  const std::string older = Content(log_);
  const std::string link = folder_.File("link.lcm");
  fs::create_symlink("run.lcm", link);
  ReplaceAndBeKilled([] {});
  EXPECT_NE(TakeBackOlder(link, "--log"), "");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(Content(log_), older);
  EXPECT_EQ(FilesInFolder(), 2);
}

TEST_F(OlderLogTest, IsNamedIfAnotherLogHasItsPlace) {
  const std::string older = Content(log_);
  ReplaceAndBeKilled([this] { WriteShortLog(log_); });
  EXPECT_EQ(TakeBackOlder(log_, "--log"),
            log_ + ": a killed run has left " + aside_ +
                ", an older log of this name; remove it if you do not need it");
  EXPECT_TRUE(log::HasSteps(log_));
  EXPECT_EQ(Content(aside_), older);
}

TEST_F(OlderLogTest, StaysWhileItsRunGoesOn) {
  const LogGuard run = Replace();
  EXPECT_EQ(ErrorOf([&] { TakeBackOlder(log_, "--resume"); }),
            log_ + ": error: --resume: is being written by another run (pid " +
                std::to_string(getpid()) + ")");
  EXPECT_EQ(FilesInFolder(), 2);
}

TEST_F(OlderLogTest, IsNoFileOfAnotherKind) {
  const std::string before = Content(log_);
  std::ofstream(aside_) << "precious";
  EXPECT_EQ(TakeBackOlder(log_, "--log"), "");
  EXPECT_EQ(Content(aside_), "precious");
  // A file of another kind has the name under which the older log would be kept. So the run will
  // overwrite the log. Before the run begins, both files are unchanged.
  Replace();
  EXPECT_EQ(Content(aside_), "precious");
  EXPECT_EQ(Content(log_), before);
}

TEST_F(OlderLogTest, LeavesNoEmptyFileOfARunThatWasKilledBeforeItMovedTheLog) {
  const std::string before = Content(log_);
  std::ofstream(aside_).flush();
  EXPECT_EQ(TakeBackOlder(log_, "--log"), "");
  EXPECT_FALSE(fs::exists(aside_));
  EXPECT_EQ(Content(log_), before);
}

}  // namespace
}  // namespace fogline::test
