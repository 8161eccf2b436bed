#include "common/file_lock.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline {
namespace {

using Kind = FileLock::Kind;

class FileLockTest : public testing::Test {
 protected:
  /// The error text of an attempt to take a lock; "" if the attempt succeeds. The function releases
  /// the lock before it returns.
  static std::string ErrorOf(const std::string& path, Kind kind) {
    return test::ErrorOf([&] { const FileLock lock(path, kind, "--log", "run"); });
  }
  static std::string Refusal(const std::string& path) {
    return path + ": error: --log: is being written by another run (pid " +
           std::to_string(getpid()) + ")";
  }

  const test::ScratchFolder folder_;
  const std::string file_ = folder_.File("run.lcm");
};

TEST_F(FileLockTest, KeepsOutOtherOwnersByNameAndLetsThoseInThatShare) {
  for (const std::string& path : {file_, folder_.path().string()}) {
    {
      const FileLock owner(path, Kind::kOwn, "--log", "run");
      EXPECT_EQ(ErrorOf(path, Kind::kOwn), Refusal(path));
      EXPECT_EQ(ErrorOf(path, Kind::kShared), "");
    }
    EXPECT_EQ(ErrorOf(path, Kind::kOwn), "") << "free in the end";
  }
}

TEST_F(FileLockTest, StaysForAsLongAsOneThatSharesItIsThere) {
  std::optional<FileLock> owner;
  owner.emplace(file_, Kind::kOwn, "--log", "run");
  const FileLock helper(file_, Kind::kShared, "--log", "run");
  owner.reset();
  EXPECT_EQ(ErrorOf(file_, Kind::kOwn), Refusal(file_));
}

TEST_F(FileLockTest, IsThatOfTheFileWhateverItsName) {
  const FileLock owner(file_, Kind::kOwn, "--log", "run");
  const std::string link = folder_.File("link.lcm");
  std::filesystem::create_symlink(file_, link);
  EXPECT_EQ(ErrorOf(link, Kind::kOwn), Refusal(link));
  EXPECT_EQ(ErrorOf(folder_.File("other.lcm"), Kind::kOwn), "");
}

TEST_F(FileLockTest, MakesTheFileAndChangesNothingInIt) {
  EXPECT_EQ(ErrorOf(file_, Kind::kOwn), "");
  EXPECT_TRUE(std::filesystem::is_empty(file_));
  std::ofstream(file_) << "log";
  EXPECT_EQ(ErrorOf(file_, Kind::kOwn), "");
  EXPECT_EQ(std::filesystem::file_size(file_), 3U);
}

TEST_F(FileLockTest, NamesAFileThatCannotBeWritten) {
  EXPECT_EQ(
      ErrorOf(folder_.File("missing/run.lcm"), Kind::kOwn),
      folder_.File("missing/run.lcm") + ": error: --log: cannot write: No such file or directory");
}

}  // namespace
}  // namespace fogline
