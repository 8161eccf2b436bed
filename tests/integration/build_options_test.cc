// What a person may choose when he configures the build.
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The commands that a build with these options would run.
std::string CompileCommands(const std::vector<std::string>& options) {
  const ScratchFolder build;
  std::vector<std::string> command{"cmake",
                                   "-S",
                                   SourceDirectory().string(),
                                   "-B",
                                   build.path().string(),
                                   "-DFOGLINE_TESTS=OFF"};
  command.insert(command.end(), options.begin(), options.end());
  const Outcome configured = RunCommand(command);
  EXPECT_EQ(configured.code, 0) << configured.err;
  std::ifstream file(build.File("compile_commands.json"));
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("-Wall"));
  return text.str();
}

TEST(BuildOptionsTest, TakeWarningsForErrorsWhereThatIsWanted) {
  EXPECT_THAT(CompileCommands({"-DFOGLINE_WERROR=ON"}), HasSubstr(" -Werror"));
  EXPECT_THAT(CompileCommands({"-DFOGLINE_WERROR=OFF"}), Not(HasSubstr("-Werror")));
}

TEST(BuildOptionsTest, DoNotTakeTheWarningsOfAnotherCompilerForErrors) {
  EXPECT_THAT(CompileCommands({"-DCMAKE_CXX_COMPILER=clang++"}), Not(HasSubstr("-Werror")));
}

}  // namespace
}  // namespace fogline::test
