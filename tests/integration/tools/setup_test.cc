// tools/setup installs the packages of package-lock.json once, and again if node_modules/ is not
// complete.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

/// The file that npm installs.
constexpr const char* kFile = "node_modules/chart/chart.js";

/// A clone of Fogline on a simulated machine, for a user other than root. Every Debian package
/// counts as installed, except npm. The machine has an npm from another source. The machine has
/// only the programs that the constructor makes. In these programs `$user` is the user who calls
/// the program.
class SetupTest : public testing::Test {
 protected:
  SetupTest() {
    for (const char* folder : {"tools", "bin", "tmp"}) {
      std::filesystem::create_directory(machine_.path() / folder);
    }
    for (const char* file : {"tools/setup", "tools/progress", "package-lock.json"}) {
      std::filesystem::copy_file(SourceDirectory() / file, machine_.path() / file);
    }
    for (const char* program : {"bash", "cat", "cmp", "cp", "dirname", "env", "find", "mkdir",
                                "mktemp", "rm", "sh", "sort", "touch"}) {
      std::filesystem::create_symlink(std::filesystem::path("/usr/bin") / program,
                                      machine_.path() / "bin" / program);
    }
    Write("id", "echo 1000");
    Write("sudo", "user=root exec \"$@\"");
    Write("dpkg-query", "for name; do :; done; [ $name = npm ] || echo installed");
    Write("apt-get", "echo $user apt-get $* >>calls; [ $1 = update ] || cp tmp/npm bin/npm");
    Write("npm", std::string("[ $1 = ci ] || exit 0; echo $user npm $* >>calls\n") +
                     "mkdir -p node_modules/chart; echo chart >" + kFile);
  }

  std::string File(const std::string& name) const { return machine_.File(name); }

  /// Makes a program of the simulated machine.
  void Write(const std::string& program, const std::string& script) const {
    const std::string file = File("bin/" + program);
    std::ofstream(file) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }

  Outcome Setup(const std::string& purpose = "run") const {
    return RunCommand({"/usr/bin/env", "-i", "-C", machine_.path().string(), "user=driver",
                       "PATH=" + File("bin"), "TMPDIR=" + File("tmp"), "tools/setup", purpose});
  }

  /// Runs Setup(), which must succeed. @return the calls of npm and apt-get
  std::string Calls(const std::string& purpose = "run") const {
    std::filesystem::remove(File("calls"));
    const Outcome outcome = Setup(purpose);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Content(File("calls"));
  }

 private:
  ScratchFolder machine_;
};

TEST_F(SetupTest, InstallsOnceAsTheUser) {
  const Outcome outcome = Setup();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "npm ci: installing the packages of package-lock.json ...\n");
  EXPECT_THAT(Content(File("calls")), MatchesRegex("driver npm ci [^\n]*\n"));
  for (const char* option :
       {" --prefer-offline", " --ignore-scripts", " --no-audit", " --no-fund"}) {
    EXPECT_THAT(Content(File("calls")), HasSubstr(option));
  }
  EXPECT_TRUE(std::filesystem::is_empty(File("tmp")));

  // WHEN every call of npm fails, THEN setup succeeds, because it calls npm only if a package is
  // missing
  Write("npm", "exit 1");
  const Outcome again = Setup();
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.out + again.err, "");
}

TEST_F(SetupTest, InstallsAgainWhatIsNotWhole) {
  EXPECT_THAT(Calls(), HasSubstr("npm ci"));
  EXPECT_EQ(Calls(), "");
  std::filesystem::remove(File(kFile));
  EXPECT_THAT(Calls(), HasSubstr("npm ci")) << "after a file was lost";
  std::ofstream(File(kFile)) << "ch";
  EXPECT_THAT(Calls(), HasSubstr("npm ci")) << "after a file was cut";
  std::filesystem::remove_all(File("node_modules"));
  EXPECT_THAT(Calls(), HasSubstr("npm ci")) << "after all was lost";
  std::ofstream(File("package-lock.json"), std::ios::app) << "\n";
  EXPECT_THAT(Calls(), HasSubstr("npm ci")) << "after the lock file changed";
  EXPECT_EQ(Calls(), "");
}

TEST_F(SetupTest, InstallsPackagesThatOnlyTestsUseOnlyForTests) {
  EXPECT_THAT(Calls("run"), HasSubstr(" --omit=dev"));
  EXPECT_EQ(Calls("bench"), "");
  EXPECT_THAT(Calls("test"), AllOf(HasSubstr("npm ci"), Not(HasSubstr("--omit"))));
  // A whole installation is enough for every purpose.
  for (const char* purpose : {"run", "test", "bench", "all"}) EXPECT_EQ(Calls(purpose), "");
  std::filesystem::remove(File(kFile));
  EXPECT_THAT(Calls("all"), AllOf(HasSubstr("npm ci"), Not(HasSubstr("--omit"))));
}

TEST_F(SetupTest, InstallsAgainAfterAnInterrupt) {
  // GIVEN an incomplete installation: npm kills setup in the middle of its work
  std::filesystem::copy_file(File("bin/npm"), File("tmp/npm"));
  Write("npm", "[ $1 = ci ] || exit 0; mkdir -p node_modules/chart; kill -KILL $PPID");
  EXPECT_EQ(Setup().code, 128 + 9);
  std::filesystem::rename(File("tmp/npm"), File("bin/npm"));
  EXPECT_THAT(Calls(), HasSubstr("npm ci"));
  EXPECT_EQ(Calls(), "");
}

TEST_F(SetupTest, SaysWhyNpmFailed) {
  Write("npm", "[ $1 = ci ] || exit 0; echo no network; exit 1");
  for (int round = 0; round < 2; ++round) {
    const Outcome outcome = Setup();
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("\nno network\ntools/setup: error: npm ci failed"),
                      EndsWith("so node_modules/ lacks packages of package-lock.json\n")));
  }
}

TEST_F(SetupTest, RefusesAnNpmThatCannotReadTheLockFileBeforeItInstallsAnything) {
  const std::string npm = Content(File("bin/npm"));
  const auto write_npm = [&](const std::string& version) {
    Write("npm", "[ $1 = --version ] && { echo " + version + "; exit; }\n" + npm);
  };
  // GIVEN a machine without Debian packages
  Write("dpkg-query", "true");
  write_npm("6.14.18");
  const Outcome old = Setup();
  EXPECT_EQ(old.code, 3);
  EXPECT_EQ(old.out, "");
  EXPECT_EQ(old.err,
            "tools/setup: error: npm 6.14.18 cannot read package-lock.json, which needs npm 7 or a "
            "later one\n");
  EXPECT_EQ(Content(File("calls")), "");
  // WHEN a later npm replaces this npm
  Write("dpkg-query", "echo installed");
  for (const char* version : {"7.0.0", "10.9.2"}) {
    write_npm(version);
    std::filesystem::remove_all(File("node_modules"));
    EXPECT_THAT(Calls(), HasSubstr("npm ci")) << version;
  }
  // setup accepts an old npm if no package is missing.
  write_npm("6.14.18");
  EXPECT_EQ(Calls(), "");
}

TEST_F(SetupTest, InstallsDebiansNpmOnlyIfItNeedsOneAndThereIsNone) {
  EXPECT_THAT(Calls(), Not(HasSubstr("apt-get")));
  std::filesystem::rename(File("bin/npm"), File("tmp/npm"));
  EXPECT_EQ(Calls(), "");
  std::filesystem::remove_all(File("node_modules"));
  EXPECT_THAT(Calls(), MatchesRegex("root apt-get update -qq\n"
                                    "root apt-get install .*--no-install-recommends .* npm\n"
                                    "driver npm ci [^\n]*\n"));
}

TEST_F(SetupTest, ShowsHowFarAptIsAndPrintsItsOutputOnlyIfItFails) {
  // GIVEN a machine without npm, and an apt-get that writes its progress as Debian's does
  std::filesystem::rename(File("bin/npm"), File("tmp/npm"));
  const std::string progress =
      "[ $1 = install ] || exit 0; echo what apt says\n"
      "echo dlstatus:1:50.0:npm >&3; echo pmstatus:npm:50.0:npm >&3; echo other:npm:60.0:npm >&3\n";
  Write("apt-get", progress + "cp tmp/npm bin/npm");
  const Outcome outcome = Setup();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err,
              MatchesRegex("installing 1 of [0-9]+ packages, which takes minutes the first time: "
                           "npm\napt-get update \\.\\.\\.\n"
                           "installing: 25 of 100[^\n]*\ninstalling: 75 of 100[^\n]*\n"
                           "npm ci: [^\n]*\n"));
  // WHEN apt-get fails
  std::filesystem::rename(File("bin/npm"), File("tmp/npm"));
  std::filesystem::remove_all(File("node_modules"));
  Write("apt-get", progress + "exit 100");
  const Outcome failed = Setup();
  EXPECT_EQ(failed.code, 3);
  EXPECT_THAT(failed.err, EndsWith("\nwhat apt says\n"));
}

}  // namespace
}  // namespace fogline::test
