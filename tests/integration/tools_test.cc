// The scripts in tools/ explain themselves, and do nothing else while they do.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A folder with what a script needs to print a text, and nothing that installs, builds or runs.
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

INSTANTIATE_TEST_SUITE_P(Scripts, ToolTest, testing::Values("demo", "test", "bench", "format"),
                         [](const auto& script) { return std::string(script.param); });

TEST(ToolsTest, RefuseAnArgumentThatTheyDoNotKnowBeforeTheyDoAnything) {
  const BareShell shell;
  for (const std::string script : {"tools/demo", "tools/test", "tools/format"}) {
    const Outcome outcome = shell.Run(script, "--fast");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err,
              script + ": error: unknown argument --fast; see " + script + " --help\n");
  }
}

}  // namespace
}  // namespace fogline::test
