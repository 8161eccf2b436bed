// The lockstep on networks that lose, repeat, reorder, delay and damage messages. It gets slower;
// its result stays the same. network_test.cc has networks of the kernel's own.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

class BadNetworkTest : public testing::Test {
 protected:
  /// A run of the paper's scenario. Only the campaign runs more than the first steps.
  nlohmann::json Run(const std::vector<std::string>& more, int first_steps = 40) {
    const char* steps = std::getenv("FOGLINE_TEST_STEPS");
    std::vector<std::string> command{
        Program("fogline"),
        "run",
        "scenario/paper.json",
        "--json",
        "--log",
        folder_.File(std::to_string(++logs_) + ".lcm"),
        "--stall-timeout",
        "30",
        "--set",
        "/steps=" + (steps != nullptr ? steps : std::to_string(first_steps))};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = RunCommand(command, std::chrono::seconds(240));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  ScratchFolder folder_;

 private:
  int logs_ = 0;
};

TEST_F(BadNetworkTest, LossDuplicatesOvertakingAndDelayChangeNoResult) {
  const auto good = Run({"--transport", "direct"});
  for (const char* transport : {"udpm", "memq"}) {
    const auto bad = Run(
        {"--transport", transport, "--faults", "loss=0.3,duplicate=0.1,reorder=0.1,delay_ms=5"});
    EXPECT_EQ(bad["digest"], good["digest"]) << transport;
    EXPECT_EQ(bad["steps"], good["steps"]) << transport;
    EXPECT_GT(bad["repairs"], 3 * bad["steps"].get<int>()) << "was anything lost?";
  }
}

TEST_F(BadNetworkTest, DamagedMessagesChangeNoResultOfASignedRun) {
  const std::string key = folder_.File("key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  constexpr int kSteps = 250;
  const auto good = Run({"--transport", "direct"}, kSteps);
  for (const char* transport : {"udpm", "memq"}) {
    const auto bad = Run(
        {"--transport", transport, "--key", key, "--faults", "flip=0.02,truncate=0.02"}, kSteps);
    EXPECT_EQ(bad["digest"], good["digest"]) << transport;
    EXPECT_GT(bad["refused"]["badly_signed"], 0) << transport;
    EXPECT_GT(bad["refused"]["not_signed"], 0) << transport;
    EXPECT_EQ(bad["refused"]["malformed"], 0) << transport;
  }
}

TEST_F(BadNetworkTest, IsRefusedWhereItCannotBe) {
  const auto error = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {Program("fogline"), "run", "scenario/paper.json"});
    const Outcome outcome = RunCommand(more);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(error({"--faults", "flip=0.1"}).find("truncate and flip need --key"),
            std::string::npos);
  EXPECT_NE(error({"--faults", "los=0.1"}).find("\"los\" is no kind of fault"), std::string::npos);
  EXPECT_NE(error({"--faults", "loss=0.1", "--transport", "direct"}).find("has no messages"),
            std::string::npos);
  const Outcome service = RunCommand({Program("fogline-acc"), "--faults", "loss=2"});
  EXPECT_EQ(service.code, 2);
  EXPECT_NE(service.err.find("fogline-acc: error: --faults: loss=2 is outside [0, 1)"),
            std::string::npos)
      << service.err;
}

}  // namespace
}  // namespace fogline::test
