// The scripts in tools/ print their help, and then do nothing else.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A folder with the programs that a script needs to print a text. These programs install, build
/// and run nothing.
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
                                         "format", "soak", "pictures", "mutate"),
                         [](const auto& script) { return std::string(script.param); });

TEST(ToolsTest, RefuseAnArgumentThatTheyDoNotKnowBeforeTheyDoAnything) {
  const BareShell shell;
  for (const std::string script :
       {"tools/demo", "tools/test", "tools/build", "tools/progress", "tools/fresh", "tools/format",
        "tools/soak", "tools/pictures", "tools/mutate"}) {
    const Outcome outcome = shell.Run(script, "--fast");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err,
              script + ": error: unknown argument --fast; see " + script + " --help\n");
  }
}

TEST(ToolsTest, BuildSaysHowFarItIsAndWhatTheCompilerSaysWhereErrorsAreLookedFor) {
  // GIVEN a ninja that begins the line of its first command as it is told, and then reports an
  // error of the compiler
  const ScratchFolder folder;
  const std::string ninja = folder.File("ninja");
  std::ofstream(ninja) << "#!/bin/sh\n"
                       << "echo \"$NINJA_STATUS\" | sed 's/%f/1/; s/%t/2/; s/$/a.o/'\n"
                       << "echo 'b.cc:1: error: mistake'\nexit 1\n";
  std::filesystem::permissions(ninja, std::filesystem::perms::owner_all);
  const Outcome outcome = RunCommand(
      {"env", "PATH=" + folder.path().string() + ":" + std::getenv("PATH"), "tools/build", "all"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err,
              testing::MatchesRegex("building: 1 of 2[^\n]*\nb.cc:1: error: mistake\n"));
}

TEST(ToolsTest, SayHowFarLongWorkIsAndPassOnWhatElseItSays) {
  const Outcome outcome = RunCommand(
      {"bash", "-c",
       "printf '@1 40 a.cc\\n@20 40 b.cc\\nb.cc:1: error\\n@40 40\\n' | tools/progress building"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "b.cc:1: error\n");
  // A time left may follow on a busy machine.
  EXPECT_THAT(outcome.err,
              testing::MatchesRegex(
                  "building: 1 of 40[^\n]*\nbuilding: 20 of 40[^\n]*\nbuilding: 40 of 40[^\n]*\n"));
}

// The time left is known after two seconds. On a busy machine the reader may start later.
constexpr const char* kHalfOfIt = "{ echo @1 40; sleep 4; echo @20 40; } | tools/progress building";

TEST(ToolsTest, SayHowLongLongWorkTakesYet) {
  const Outcome outcome = RunCommand({"bash", "-c", kHalfOfIt});
  EXPECT_THAT(outcome.err,
              testing::MatchesRegex("building: 1 of 40\nbuilding: 20 of 40, 0:[0-9][0-9] left\n"));
}

TEST(ToolsTest, DrawABarOnATerminal) {
  const Outcome outcome = RunCommand({"script", "--quiet", "--command", kHalfOfIt, "/dev/null"});
  EXPECT_THAT(outcome.out,
              testing::ContainsRegex("building \\[={15} {15}\\] 20 of 40, 0:[0-9][0-9] left"));
}

}  // namespace
}  // namespace fogline::test
