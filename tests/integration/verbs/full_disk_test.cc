// On a full disk a verb names the file that does not fit, keeps the old files, and leaves no new
// files.
#include <unistd.h>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/machine.h"

namespace fogline::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// Tests with a file system of 4 MiB, which is mounted only for the commands of a test.
class FullDiskTest : public testing::Test {
 protected:
  FullDiskTest() {
    const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                    "direct", "--quiet", "--log", log_});
    EXPECT_EQ(run.code, 0) << run.err;
  }

  /// The reason why the machine cannot mount a file system; "" if it can.
  static std::string Lack() {
    if (geteuid() != 0) return "root, to mount a small file system";
    const Outcome own = RunCommand({"unshare", "--mount", "true"});
    return own.code == 0 ? "" : "mount namespaces: " + own.err;
  }
  /// Executes a script with $fogline, $log and $disk, the folder of the small file system. "fill"
  /// copies this folder and then fills it. "keep" ends the script with 97 if $disk/old differs from
  /// the copy.
  Outcome Run(const std::string& script) const {
    const std::string begin =
        "fogline=$0 log=$1 disk=$2 copy=$3\n"
        "mount -t tmpfs -o size=4m small \"$disk\" || exit 99\n"
        "fill() { cp -r \"$disk\" \"$copy\"; dd if=/dev/zero of=\"$disk/fill\" bs=1k 2>/dev/null; "
        "}\n"
        "keep() { diff -r \"$disk/old\" \"$copy/old\" || exit 97; }\n";
    return RunCommand({"unshare", "--mount", "bash", "-c", begin + script, Program("fogline"), log_,
                       disk_.path().string(), folder_.File("copy")});
  }
  std::string Error(const std::string& verb, const std::string& file) const {
    return "fogline " + verb + ": error: " + disk_.File(file) +
           ": cannot write: No space left on device\n";
  }

  const ScratchFolder folder_;
  const ScratchFolder disk_;
  const std::string log_ = folder_.File("run.lcm");
};

TEST_F(FullDiskTest, AReportKeepsTheOldFiguresAndNamesOneThatDoesNotFit) {
  if (const std::string lack = Lack(); !lack.empty()) return MachineLacks(lack);
  for (const std::string format : {"png", "svg", "pdf"}) {
    const std::string report =
        "\"$fogline\" report \"$log\" --output /dev/null --" + format + " \"$disk/old\"";
    const Outcome outcome = Run("rm -rf \"$copy\"\n" + report + " || exit 98\nfill\n" + report +
                                "; code=$?; keep; exit $code");
    EXPECT_EQ(outcome.code, 3) << format << outcome.out;
    EXPECT_THAT(outcome.err, StartsWith("fogline report: error: " + disk_.File("old/figure-")));
    EXPECT_THAT(outcome.err, EndsWith("." + format + ": cannot write: No space left on device\n"));
  }
}

TEST_F(FullDiskTest, AReportKeepsItsOldPageIfAFigureDoesNotFit) {
  if (const std::string lack = Lack(); !lack.empty()) return MachineLacks(lack);
  const Outcome outcome =
      Run("fill; echo '<!DOCTYPE html> old' > \"$copy.html\"\n"
          "\"$fogline\" report \"$log\" --output \"$copy.html\" --png \"$disk\"; code=$?\n"
          "cat \"$copy.html\"; exit $code");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_EQ(outcome.out, "<!DOCTYPE html> old\n");
}

TEST_F(FullDiskTest, NoVerbLeavesANewFolderThatIsEmpty) {
  if (const std::string lack = Lack(); !lack.empty()) return MachineLacks(lack);
  for (const std::string call :
       {"report \"$log\" --output /dev/null --png", "export \"$log\" --out"}) {
    const Outcome outcome = Run("rm -rf \"$copy\"; fill; \"$fogline\" " + call +
                                " \"$disk/new\"; code=$?; ls \"$disk\"; exit $code");
    EXPECT_EQ(outcome.code, 3) << call;
    EXPECT_EQ(outcome.out, "fill\n") << call;
    EXPECT_THAT(outcome.err, EndsWith(": cannot write: No space left on device\n")) << call;
  }
}

TEST_F(FullDiskTest, AKeyThatDoesNotFitIsAFailureAndNoBadInput) {
  if (const std::string lack = Lack(); !lack.empty()) return MachineLacks(lack);
  const Outcome outcome =
      Run("fill; \"$fogline\" keygen \"$disk/key\"; code=$?; ls \"$disk\"; exit $code");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.out, "fill\n");
  EXPECT_EQ(outcome.err, Error("keygen", "key"));
}

TEST(FullStdoutTest, IsNamedInTheSameWordsForTextsOfAnyLength) {
  for (const char* call : {"check --schema", "check --print scenario/paper.json",
                           "check scenario/paper.json", "graph"}) {
    const Outcome outcome =
        RunCommand({"sh", "-c", Program("fogline") + " " + call + " > /dev/full"});
    EXPECT_EQ(outcome.code, 3) << call;
    EXPECT_THAT(outcome.err,
                HasSubstr(": error: standard output cannot be written (a full disk?)\n"))
        << call;
  }
}

}  // namespace
}  // namespace fogline::test
