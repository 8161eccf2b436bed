// Files that are there as a whole or not at all, and whether they could be.
#include "tools/sweep/whole_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "scenario/loader.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

class WholeFileTest : public testing::Test {
 protected:
  static std::string Content(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool IsEmpty() const { return std::filesystem::is_empty(folder_.path()); }

  /// What is said of a file that cannot be written.
  template <class Call>
  static std::string ErrorOf(const Call& call) {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const test::ScratchFolder folder_;
  const std::string file_ = folder_.File("result.csv");
};

TEST_F(WholeFileTest, HasItsNameOnlyWhenItIsFinished) {
  {
    WholeFile file(file_);
    file.Write("half");
    EXPECT_FALSE(std::filesystem::exists(file_));
  }
  EXPECT_TRUE(IsEmpty());
  WholeFile file(file_);
  file.Write("whole");
  file.Finish();
  EXPECT_EQ(Content(file_), "whole");
}

TEST_F(WholeFileTest, ReplacesNeitherAFolderNorADevice) {
  const std::string folder = folder_.path().string();
  EXPECT_EQ(ErrorOf([&] { WholeFile file(folder); }),
            folder + ": error: cannot write: it is a folder");
  EXPECT_EQ(ErrorOf([&] { WholeFile file("/dev/null"); }),
            "/dev/null: error: cannot write: it is no regular file");
}

TEST_F(WholeFileTest, IsTriedBeforehandWithoutATrace) {
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_, "--out"); }), "");
  EXPECT_TRUE(IsEmpty());
  std::ofstream(file_) << "of before";
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_, "--out"); }), "");
  EXPECT_EQ(Content(file_), "of before");
  // A folder for files is made if it is missing.
  EXPECT_EQ(ErrorOf([&] { RequireWritableFolder(folder_.File("figures"), "--png"); }), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "figures"));
}

TEST_F(WholeFileTest, NeedsItsFolderForAMissingOneIsLikelyToBeASlip) {
  const std::string slip = folder_.File("nonexist/dir");
  const std::string none = ": error: --out: there is no folder " + slip;
  EXPECT_EQ(ErrorOf([&] { RequireWritable(slip + "/result.csv", "--out"); }),
            slip + "/result.csv" + none);
  EXPECT_EQ(ErrorOf([&] { RequireWritableFolder(slip + "/figures", "--out"); }),
            slip + "/figures" + none);
  EXPECT_EQ(ErrorOf([&] { RequireWritableFolder(slip + "/figures/", "--out"); }),
            slip + "/figures" + none);
  EXPECT_TRUE(IsEmpty());
  EXPECT_EQ(ErrorOf([&] { RequireWritableFolder(folder_.File("figures/"), "--out"); }), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "figures"));
}

TEST_F(WholeFileTest, IsTriedBeforehandWithoutTouchingTheHalfThatSomebodyElseWrites) {
  const std::string part = file_ + ".part";
  std::ofstream(part) << "half of another's";
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_, "--out"); }), "");
  EXPECT_EQ(Content(part), "half of another's");
}

TEST_F(WholeFileTest, IsRefusedBeforehandByTheNameOfItsOption) {
  std::ofstream(file_) << "no folder";
  const std::string folder = folder_.path().string();
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_ + "/below", "--out"); }),
            file_ + "/below: error: --out: cannot write: Not a directory");
  EXPECT_EQ(ErrorOf([&] { RequireWritable(folder, "--out"); }),
            folder + ": error: --out: cannot write: it is a folder");
  EXPECT_EQ(ErrorOf([&] { RequireWritableFolder(file_, "--png"); }),
            file_ + ": error: --png: cannot write: Not a directory");
  // Where folders exist but no file can be made, whoever asks.
  EXPECT_EQ(ErrorOf([&] { RequireWritable("/proc/result.csv", "--out"); }),
            "/proc/result.csv: error: --out: cannot write: No such file or directory");
  EXPECT_EQ(ErrorOf([&] { RequireWritableFolder("/proc", "--logs"); }),
            "/proc: error: --logs: cannot write: No such file or directory");
}

}  // namespace
}  // namespace fogline
