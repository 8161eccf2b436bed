// The scripts in tools/ print their help, and then do nothing else.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/process/programs.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A folder with only the programs that a script needs to print a text. If a script tries to do
/// more, such as to build something, it fails, because the program for this is not in the folder.
class BareShell {
 public:
  BareShell() {
    for (const char* program : {"bash", "cat", "dirname"}) {
      std::filesystem::create_symlink(std::filesystem::path("/usr/bin") / program,
                                      folder_.path() / program);
    }
  }
  Outcome Run(const std::string& script, const std::string& argument) const {
    return RunCommand({"/usr/bin/env", "PATH=" + folder_.path().string(), script, argument});
  }

 private:
  ScratchFolder folder_;
};

class ToolTest : public testing::TestWithParam<const char*> {};

TEST_P(ToolTest, PrintsItsHelpAndDoesNothingElse) {
  const std::string script = std::string("tools/") + GetParam();
  const Outcome help = BareShell().Run(script, "--help");
  EXPECT_EQ(help.code, 0) << help.err;
  EXPECT_EQ(help.err, "");
  EXPECT_THAT(help.out, StartsWith("usage: " + script));
  EXPECT_THAT(help.out, HasSubstr("\nExample"));
}

INSTANTIATE_TEST_SUITE_P(Scripts, ToolTest,
                         testing::Values("demo", "test", "bench", "build", "progress", "fresh",
                                         "format", "soak", "pictures", "mutate", "setup"),
                         [](const auto& script) { return std::string(script.param); });

TEST(ToolsTest, RefuseAnArgumentThatTheyDoNotKnowBeforeTheyDoAnything) {
  const BareShell shell;
  for (const std::string script :
       {"tools/demo", "tools/test", "tools/build", "tools/progress", "tools/fresh", "tools/format",
        "tools/soak", "tools/pictures", "tools/mutate", "tools/setup"}) {
    const Outcome outcome = shell.Run(script, "--fast");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err,
              script + ": error: unknown argument --fast; see " + script + " --help\n");
  }
}

TEST(ToolsTest, RefuseAnEmptyArgument) {
  for (const std::string script :
       {"tools/demo", "tools/test", "tools/build", "tools/format", "tools/setup"}) {
    const Outcome outcome = BareShell().Run(script, "");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, script + ": error: unknown argument ; see " + script + " --help\n");
  }
}

TEST(ToolsTest, SetupNeedsOnePurpose) {
  for (const std::string arguments : {"", " run test"}) {
    const Outcome outcome = RunCommand({"bash", "-c", "tools/setup" + arguments});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "tools/setup: error: one PURPOSE is needed; see tools/setup --help\n");
  }
}

/// A folder with tools/build, with a configured build, and with a program `ninja` that the test
/// makes.
class BuildFolder {
 public:
  explicit BuildFolder(const std::string& ninja) {
    for (const char* part : {"tools", "build", "bin"}) {
      std::filesystem::create_directory(folder_.path() / part);
    }
    for (const char* script : {"build", "lock", "progress"}) {
      const std::filesystem::path source = std::filesystem::path("tools") / script;
      std::filesystem::copy_file(SourceDirectory() / source, folder_.path() / source);
    }
    std::ofstream(folder_.path() / "build/build.ninja") << "";
    std::ofstream(folder_.path() / "bin/ninja") << "#!/bin/sh\n" << ninja << "\n";
    std::filesystem::permissions(folder_.path() / "bin/ninja", std::filesystem::perms::owner_all);
  }
  /// The command that calls tools/build for a target.
  std::vector<std::string> Command(const std::string& target = "all") const {
    return {"env",
            "-C",
            folder_.path().string(),
            "PATH=" + folder_.File("bin") + ":" + std::getenv("PATH"),
            "tools/build",
            target};
  }
  std::filesystem::path path() const { return folder_.path(); }

 private:
  ScratchFolder folder_;
};

TEST(ToolsTest, BuildNamesATargetThatIsNotThere) {
  const BuildFolder folder("exec " + FindProgram("ninja").string() + " \"$@\"");
  std::ofstream(folder.path() / "build/build.ninja") << "build programs: phony\n";
  const Outcome there = RunCommand(folder.Command("programs"));
  EXPECT_EQ(there.code, 0);
  EXPECT_EQ(there.err, "");
  const Outcome missing = RunCommand(folder.Command("elephants"));
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(missing.err,
            "tools/build: error: unknown target 'elephants'; see tools/build --help\n");
  const Outcome misspelled = RunCommand(folder.Command("program"));
  EXPECT_EQ(misspelled.code, 2);
  EXPECT_EQ(misspelled.err,
            "tools/build: error: unknown target 'program', did you mean 'programs'?\n");
}

TEST(ToolsTest, BuildSaysHowFarItIsAndWhatTheCompilerSaysWhereErrorsAreLookedFor) {
  // GIVEN a ninja that first prints its progress, in the format of the variable NINJA_STATUS, and
  // then an error of the compiler
  const BuildFolder folder(
      "echo \"$NINJA_STATUS\" | sed 's/%f/1/; s/%t/2/; s/$/a.o/'\n"
      "echo 'b.cc:1: error: mistake'\nexit 1");
  const Outcome outcome = RunCommand(folder.Command());
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  // On a busy machine the first line may also show the time left.
  EXPECT_THAT(outcome.err,
              testing::MatchesRegex("building: 1 of 2[^\n]*\nb.cc:1: error: mistake\n"));
}

TEST(ToolsTest, BuildsOfAFolderRunOneAfterTheOther) {
  const BuildFolder folder(
      "echo begins >>calls; until [ -e go ]; do sleep 0.05; done; echo ends >>calls");
  const std::filesystem::path calls = folder.path() / "calls";
  Background first(folder.Command());
  ASSERT_TRUE(ComesToHave("begins\n", calls)) << first.Err();
  Background second(folder.Command());
  EXPECT_TRUE(second.WaitForErr("waiting for another tools/build in this folder ..."));
  EXPECT_EQ(Content(calls), "begins\n");
  std::ofstream(folder.path() / "go") << "";
  EXPECT_EQ(first.Wait(), 0) << first.Err();
  EXPECT_EQ(second.Wait(), 0) << second.Err();
  EXPECT_EQ(Content(calls), "begins\nends\nbegins\nends\n");
}

TEST(ToolsTest, BuildGoesOnWhereThereIsNoFlock) {
  const BuildFolder folder("exit 0");
  std::ofstream(folder.path() / "bin/flock") << "#!/bin/sh\nexit 127\n";
  std::filesystem::permissions(folder.path() / "bin/flock", std::filesystem::perms::owner_all);
  const Outcome outcome = RunCommand(folder.Command());
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
}

TEST(ToolsTest, SayHowFarLongWorkIsAndPassOnWhatElseItSays) {
  const Outcome outcome = RunCommand(
      {"bash", "-c",
       "printf '@1 40 a.cc\\n@20 40 b.cc\\nb.cc:1: error\\n@40 40\\n' | tools/progress building"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "b.cc:1: error\n");
  // On a busy machine a line may also show the time left.
  EXPECT_THAT(outcome.err,
              testing::MatchesRegex("building: 1 of 40(, 0:[0-9][0-9] left)?\nbuilding: 20 of "
                                    "40[^\n]*\nbuilding: 40 of 40[^\n]*\n"));
}

// tools/progress shows the time left only after two seconds. This work takes four seconds, because
// on a busy machine tools/progress may start late.
constexpr const char* kHalfOfIt = "{ echo @1 40; sleep 4; echo @20 40; } | tools/progress building";

TEST(ToolsTest, SayHowLongLongWorkTakesYet) {
  const Outcome outcome = RunCommand({"bash", "-c", kHalfOfIt});
  EXPECT_THAT(
      outcome.err,
      testing::MatchesRegex(
          "building: 1 of 40(, 0:[0-9][0-9] left)?\nbuilding: 20 of 40, 0:[0-9][0-9] left\n"));
}

TEST(ToolsTest, DrawABarOnATerminal) {
  const Outcome outcome = RunCommand({"script", "--quiet", "--command", kHalfOfIt, "/dev/null"});
  EXPECT_THAT(outcome.out,
              testing::ContainsRegex("building \\[={15} {15}\\] 20 of 40, 0:[0-9][0-9] left"));
}

}  // namespace
}  // namespace fogline::test
