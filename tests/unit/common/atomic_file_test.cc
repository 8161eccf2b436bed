// Tests of files that exist either completely or not at all. The tests also cover the check whether
// such a file can be written.
#include "common/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/input_errors.h"

namespace fogline {
namespace {

using test::ErrorOf;

class AtomicFileTest : public testing::Test {
 protected:
  static std::string Content(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool IsEmpty() const { return std::filesystem::is_empty(folder_.path()); }

  const test::ScratchFolder folder_;
  const std::string file_ = folder_.File("result.csv");
};

TEST_F(AtomicFileTest, HasItsNameOnlyWhenItIsFinished) {
  {
    AtomicFile file(file_);
    file.Write("half");
    EXPECT_FALSE(std::filesystem::exists(file_));
  }
  EXPECT_TRUE(IsEmpty());
  AtomicFile file(file_);
  file.Write("whole");
  file.Finish();
  EXPECT_EQ(Content(file_), "whole");
}

TEST_F(AtomicFileTest, OnlyTheFirstOfTwoNewFilesGetsTheName) {
  {
    AtomicFile first(file_);
    AtomicFile second(file_);
    first.Write("first");
    second.Write("second");
    EXPECT_TRUE(first.FinishNew());
    EXPECT_FALSE(second.FinishNew());
    EXPECT_EQ(Content(file_), "first");
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(AtomicFileTest, KnowsTheNamesOfItsTemporaryFiles) {
  const AtomicFile file(file_);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_TRUE(AtomicFile::IsTemporary(entry.path())) << entry.path();
  }
  EXPECT_FALSE(IsEmpty());
  EXPECT_FALSE(AtomicFile::IsTemporary(file_));
  EXPECT_FALSE(AtomicFile::IsTemporary(".fogline-older-run.lcm"));
  EXPECT_FALSE(AtomicFile::IsTemporary(".fogline-older-of-the-very-long-names.lcm"));
}

TEST_F(AtomicFileTest, ReplacesNoFolder) {
  const std::string folder = folder_.path().string();
  EXPECT_EQ(ErrorOf([&] { AtomicFile file(folder); }),
            folder + ": error: cannot write: it is a folder");
}

TEST_F(AtomicFileTest, FollowsNoLinkThatLiesWhereItWrites) {
  // GIVEN links with names that an attacker could expect for the temporary file
  const std::string precious = folder_.File("precious");
  std::ofstream(precious) << "precious";
  for (const char* ending : {".part", ".tmp", "~"}) {
    std::filesystem::create_symlink(precious, file_ + ending);
  }
  AtomicFile file(file_);
  file.Write("page");
  file.Finish();
  EXPECT_EQ(Content(precious), "precious");
  EXPECT_EQ(Content(file_), "page");
}

TEST_F(AtomicFileTest, TwoAtOnceEachWriteAWholeFile) {
  AtomicFile one(file_);
  AtomicFile two(file_);
  one.Write("one, ");
  two.Write("two, ");
  one.Write("whole");
  two.Write("whole");
  one.Finish();
  EXPECT_EQ(Content(file_), "one, whole");
  two.Finish();
  EXPECT_EQ(Content(file_), "two, whole");
}

TEST_F(AtomicFileTest, HasTheRightsOfAnyNewFile) {
  const mode_t before = umask(027);
  {
    AtomicFile file(file_);
    file.Finish();
  }
  umask(before);
  EXPECT_EQ(std::filesystem::status(file_).permissions(), std::filesystem::perms(0640));
}

TEST_F(AtomicFileTest, KeepsTheRightsOfTheFileThatItReplaces) {
  std::ofstream(file_) << "answers";
  std::filesystem::permissions(file_, std::filesystem::perms(0600));
  AtomicFile file(file_);
  file.Finish();
  EXPECT_EQ(std::filesystem::status(file_).permissions(), std::filesystem::perms(0600));
}

TEST_F(AtomicFileTest, ReplacesTheFileThatALinkLeadsToAndLeavesTheLink) {
  std::filesystem::create_directory(folder_.File("elsewhere"));
  const std::string target = folder_.File("elsewhere/target.csv");
  std::ofstream(target) << "old";
  std::filesystem::create_symlink("elsewhere/target.csv", file_);
  {
    EXPECT_EQ(ErrorOf([&] { RequireWritable(file_, "--out"); }), "");
    AtomicFile file(file_);
    file.Write("new");
    file.Finish();
  }
  EXPECT_TRUE(std::filesystem::is_symlink(file_));
  EXPECT_EQ(Content(target), "new");
  std::filesystem::remove(target);
  EXPECT_THAT(ErrorOf([&] { AtomicFile file(file_); }),
              testing::EndsWith(", which does not exist"));
}

TEST_F(AtomicFileTest, HandsEverythingToADeviceAtTheEnd) {
  AtomicFile nothing("/dev/null");
  nothing.Write("page");
  nothing.Finish();
  AtomicFile full("/dev/full");
  full.Write("page");
  EXPECT_THROW(full.Finish(), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, HandsEverythingToThePipeThatAProcessReads) {
  const std::string pipe = folder_.File("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(ErrorOf([&] { AtomicFile file(pipe); }),
            pipe + ": error: cannot write: no process reads this pipe");
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  {
    EXPECT_EQ(ErrorOf([&] { RequireWritable(pipe, "--out"); }), "");
    AtomicFile file(pipe);
    file.Write("page");
    char byte = 0;
    EXPECT_EQ(read(reader, &byte, 1), -1) << "half of it is not to be seen";
    file.Finish();
  }
  std::array<char, 8> page{};
  EXPECT_EQ(read(reader, page.data(), page.size()), 4);
  EXPECT_EQ(std::string(page.data()), "page");
  close(reader);
}

TEST_F(AtomicFileTest, GoesOnBehindWhatAnOpenDescriptorHasWritten) {
  const int out = open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_EQ(write(out, "before ", 7), 7);
  {
    AtomicFile file("/dev/fd/" + std::to_string(out));
    file.Write("page");
    file.Finish();
  }
  ASSERT_EQ(write(out, " after", 6), 6);
  close(out);
  EXPECT_EQ(Content(file_), "before page after");
}

TEST_F(AtomicFileTest, ReplacesByForceOnlyWhatIsOfItsKind) {
  const auto is_page = [](const std::filesystem::path& file) {
    return Content(file.string()).starts_with("page");
  };
  const auto error = [&](bool force) {
    return ErrorOf([&] { RefuseToReplace(file_, "--out", force, "page", is_page); });
  };
  EXPECT_EQ(error(false), "");
  std::ofstream(file_) << "page one";
  EXPECT_EQ(error(false), file_ + ": error: --out: the file exists; --force replaces it");
  EXPECT_EQ(error(true), "");
  std::ofstream(file_) << "thesis";
  EXPECT_EQ(error(true),
            file_ + ": error: --out: the file is no page and is not replaced, even with --force");
  EXPECT_EQ(ErrorOf([&] { RefuseToReplace("/dev/null", "--out", false, "page", is_page); }), "");
  for (const bool force : {false, true}) {
    EXPECT_EQ(ErrorOf([&] { RefuseToReplace("/tmp", "--out", force, "page", is_page); }),
              "/tmp: error: --out: cannot write: it is a folder");
  }
}

TEST_F(AtomicFileTest, IsTriedBeforehandWithoutATrace) {
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_, "--out"); }), "");
  EXPECT_TRUE(IsEmpty());
  std::ofstream(file_) << "of before";
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_, "--out"); }), "");
  EXPECT_EQ(Content(file_), "of before");
}

TEST_F(AtomicFileTest, OfAFolderThatIsMissingHasAFolderThatStaysOnlyWithFiles) {
  for (const char* name : {"figures", "figures/"}) {
    {
      const OutputFolder figures(folder_.File(name), "--png");
      EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "figures"));
    }
    EXPECT_TRUE(IsEmpty()) << name;
  }
  {
    const OutputFolder figures(folder_.File("figures"), "--png");
    std::ofstream(folder_.File("figures/figure.png")) << "a figure";
  }
  EXPECT_EQ(Content(folder_.File("figures/figure.png")), "a figure");
  // An empty folder stays if it existed before.
  std::filesystem::remove(folder_.File("figures/figure.png"));
  { const OutputFolder figures(folder_.File("figures"), "--png"); }
  EXPECT_TRUE(std::filesystem::exists(folder_.File("figures")));
}

TEST_F(AtomicFileTest, OfSeveralReplacesNoneIfOneDoesNotFit) {
  const std::string other = folder_.File("other.csv");
  std::ofstream(file_) << "old";
  std::ofstream(other) << "old";
  {
    const test::FileSizeLimit limit(10);
    AtomicFiles files;
    files.Add(file_).Write("new");
    files.Add(other).Write("far too long");
    EXPECT_EQ(ErrorOf<std::runtime_error>([&] { files.Finish(); }),
              other + ": cannot write: File too large");
  }
  EXPECT_EQ(Content(file_), "old");
  EXPECT_EQ(Content(other), "old");
  AtomicFiles files;
  files.Add(file_).Write("new");
  files.Add(other).Write("newer");
  files.Finish();
  EXPECT_EQ(Content(file_), "new");
  EXPECT_EQ(Content(other), "newer");
}

TEST_F(AtomicFileTest, OfSeveralReplacesNoneIfADeviceTakesNothing) {
  std::ofstream(file_) << "old";
  AtomicFiles files;
  files.Add(file_).Write("new");
  files.Add("/dev/full").Write("new");
  EXPECT_EQ(ErrorOf<std::runtime_error>([&] { files.Finish(); }),
            "/dev/full: cannot write: No space left on device");
  EXPECT_EQ(Content(file_), "old");
}

TEST_F(AtomicFileTest, SaysWhyTheFolderOfItsDefaultNameCannotBeMade) {
  // GIVEN a working folder in which this process may not write
  const std::filesystem::path before = std::filesystem::current_path();
  const uid_t user = geteuid();
  std::filesystem::current_path(folder_.path());
  std::filesystem::permissions(
      folder_.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const bool is_user = seteuid(user == 0 ? 65534 : user) == 0;
  const std::string error = ErrorOf([] { RequireFolderOf("logs/paper-1.lcm", "--log"); });
  ASSERT_EQ(seteuid(user), 0);
  std::filesystem::permissions(folder_.path(), std::filesystem::perms::owner_all);
  std::filesystem::current_path(before);
  ASSERT_TRUE(is_user);
  EXPECT_EQ(error, "logs: error: cannot make the folder: Permission denied");
}

TEST_F(AtomicFileTest, NeedsItsFolderForAMissingOneIsLikelyToBeASlip) {
  const std::string slip = folder_.File("nonexist/dir");
  const std::string none = ": error: --out: there is no folder " + slip;
  EXPECT_EQ(ErrorOf([&] { RequireWritable(slip + "/result.csv", "--out"); }),
            slip + "/result.csv" + none);
  EXPECT_EQ(ErrorOf([&] { OutputFolder(slip + "/figures", "--out"); }), slip + "/figures" + none);
  EXPECT_EQ(ErrorOf([&] { OutputFolder(slip + "/figures/", "--out"); }), slip + "/figures" + none);
  EXPECT_TRUE(IsEmpty());
}

TEST_F(AtomicFileTest, IsTriedBeforehandWithoutTouchingTheHalfThatAnotherProcessWrites) {
  const std::string part = file_ + ".part";
  std::ofstream(part) << "half of another's";
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_, "--out"); }), "");
  EXPECT_EQ(Content(part), "half of another's");
}

TEST_F(AtomicFileTest, IsRefusedBeforehandByTheNameOfItsOption) {
  std::ofstream(file_) << "no folder";
  const std::string folder = folder_.path().string();
  EXPECT_EQ(ErrorOf([&] { RequireWritable(file_ + "/below", "--out"); }),
            file_ + "/below: error: --out: cannot write: Not a directory");
  EXPECT_EQ(ErrorOf([&] { RequireWritable(folder, "--out"); }),
            folder + ": error: --out: cannot write: it is a folder");
  EXPECT_EQ(ErrorOf([&] { OutputFolder(file_, "--png"); }),
            file_ + ": error: --png: cannot write: it is a file, not a folder");
  // No user can create a file in /proc.
  EXPECT_EQ(ErrorOf([&] { RequireWritable("/proc/result.csv", "--out"); }),
            "/proc/result.csv: error: --out: cannot write: No such file or directory");
  EXPECT_EQ(ErrorOf([&] { OutputFolder("/proc", "--logs"); }),
            "/proc: error: --logs: cannot write: No such file or directory");
  const std::string long_name = folder_.File(std::string(300, 'x'));
  EXPECT_EQ(ErrorOf([&] { RequireWritable(long_name, "--out"); }),
            long_name + ": error: --out: cannot write: File name too long");
  EXPECT_EQ(ErrorOf([&] { OutputFolder(long_name, "--png"); }),
            long_name + ": error: --png: cannot write: File name too long");
}

}  // namespace
}  // namespace fogline
