// On a machine without SUMO, only a scenario with cars from SUMO is refused.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

class WithoutSumoTest : public testing::Test {
 protected:
  /// Copies the program into a folder without the module for SUMO.
  WithoutSumoTest() {
    std::filesystem::create_directory(folder_.path() / "bin");
    std::filesystem::copy_file(Program("fogline"), fogline_);
  }

  const ScratchFolder folder_;
  const std::string fogline_ = folder_.File("bin/fogline");
  const std::string error_ =
      "scenario/sumo_queue.json: error: /lead/profile: \"sumo\" needs SUMO, and this build of "
      "Fogline has none: install Debian's package sumo, and build again "
      "(tools/build fogline_programs)\n";
};

TEST_F(WithoutSumoTest, AScenarioWithCarsFromSumoIsRefusedByThePackagesName) {
  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{"check"}, {"run", "--transport", "direct"}, {"table"}}) {
    std::vector<std::string> command{fogline_};
    command.insert(command.end(), verb.begin(), verb.end());
    command.emplace_back("scenario/sumo_queue.json");
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2) << verb[0];
    EXPECT_EQ(outcome.err, error_) << verb[0];
  }
}

TEST_F(WithoutSumoTest, AnotherScenarioRuns) {
  const Outcome outcome = RunCommand({fogline_, "run", "scenario/paper.json", "--transport",
                                      "direct", "--quiet", "--log", folder_.File("run.lcm")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

}  // namespace
}  // namespace fogline::test
