// The options with which CMake configures the build.
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

/// A build folder on a machine without make, like a fresh Debian system.
class ConfiguredBuild {
 public:
  explicit ConfiguredBuild(const std::vector<std::string>& options) {
    std::vector<std::string> command = WithoutMake(folder_);
    command.insert(command.end(), {"cmake", "-S", SourceDirectory().string(), "-B", Folder(), "-G",
                                   "Ninja", "-DFOGLINE_TESTS=OFF"});
    command.insert(command.end(), options.begin(), options.end());
    const Outcome configured = RunCommand(command);
    EXPECT_EQ(configured.code, 0) << configured.err;
  }

  /// The commands that the build would run.
  std::string CompileCommands() const {
    std::ifstream file(Folder() + "/compile_commands.json");
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_THAT(text.str(), HasSubstr("-Wall"));
    return text.str();
  }

  /// All files from which the build makes a target.
  std::string InputsOf(const std::string& target) const {
    const Outcome inputs = RunCommand({"ninja", "-C", Folder(), "-t", "inputs", target});
    EXPECT_EQ(inputs.code, 0) << inputs.err;
    return inputs.out;
  }

 private:
  std::string Folder() const { return folder_.File("build"); }

  ScratchFolder folder_;
};

std::string CompileCommands(const std::vector<std::string>& options) {
  return ConfiguredBuild(options).CompileCommands();
}

TEST(BuildOptionsTest, TakeWarningsForErrorsWhereThatIsWanted) {
  EXPECT_THAT(CompileCommands({"-DFOGLINE_WERROR=ON"}), HasSubstr(" -Werror"));
  EXPECT_THAT(CompileCommands({"-DFOGLINE_WERROR=OFF"}), Not(HasSubstr("-Werror")));
}

TEST(BuildOptionsTest, DoNotTakeTheWarningsOfAnotherCompilerForErrors) {
  EXPECT_THAT(CompileCommands({"-DCMAKE_CXX_COMPILER=clang++"}), Not(HasSubstr("-Werror")));
}

TEST(BuildOptionsTest, CompileFilesTogetherUnlessEachIsToBeCompiledAlone) {
  EXPECT_THAT(CompileCommands({}), HasSubstr("fogline_world.dir/Unity/"));
  const std::string alone = CompileCommands({"-DFOGLINE_UNITY=OFF"});
  EXPECT_THAT(alone, Not(HasSubstr("/Unity/")));
  EXPECT_THAT(alone, HasSubstr("services/world/fog_schedule.cc"));
}

TEST(BuildOptionsTest, BuildForARunNeitherThePageNorTheRelay) {
  const ConfiguredBuild build({});
  const std::string run = build.InputsOf("fogline_run");
  const std::string demo = build.InputsOf("fogline_demo");
  for (const char* part : {"fogline-world.dir", "fogline-recorder.dir", "fogline_report"}) {
    EXPECT_THAT(run, HasSubstr(part));
  }
  for (const char* part : {"fogline_web", "fogline-web", "fogline_relay", "boost_asio"}) {
    EXPECT_THAT(run, Not(HasSubstr(part)));
    EXPECT_THAT(demo, HasSubstr(part));
  }
}

TEST(BuildOptionsTest, BuildForTheDemoNeitherStudiesNorCalibrationNorBenchmarks) {
  const ConfiguredBuild build({});
  const std::string demo = build.InputsOf("fogline_demo");
  EXPECT_THAT(demo, HasSubstr("fogline-world.dir"));
  EXPECT_THAT(demo, HasSubstr("fogline_report"));
  for (const char* part : {"fogline_study", "fogline_calibrate", "fogline_trials", "benchmarks"}) {
    EXPECT_THAT(demo, Not(HasSubstr(part)));
    if (std::string_view(part) == "benchmarks") continue;
    EXPECT_THAT(build.InputsOf("fogline_programs"), HasSubstr(part));
  }
}

}  // namespace
}  // namespace fogline::test
