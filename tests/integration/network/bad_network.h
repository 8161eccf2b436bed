// The lockstep on networks that lose, repeat, reorder, delay and damage messages. The run gets
// slower, and its result stays the same.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

class BadNetworkTest : public testing::Test {
 protected:
  /// Runs the first `steps` steps of the paper's scenario. @return the JSON result
  nlohmann::json Run(const std::vector<std::string>& more, int steps) {
    std::vector<std::string> command{Program("fogline"),
                                     "run",
                                     "scenario/paper.json",
                                     "--json",
                                     "--log",
                                     folder_.File(std::to_string(++logs_) + ".lcm"),
                                     "--stall-timeout",
                                     "30",
                                     "--set",
                                     "/steps=" + std::to_string(steps)};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = RunCommand(command, std::chrono::seconds(240));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  void ExpectLossDuplicatesOvertakingAndDelayChangeNoResult(int steps) {
    const auto good = Run({"--transport", "direct"}, steps);
    for (const char* transport : {"udpm", "memq"}) {
      const auto bad = Run(
          {"--transport", transport, "--faults", "loss=0.3,duplicate=0.1,reorder=0.1,delay_ms=5"},
          steps);
      EXPECT_EQ(bad["digest"], good["digest"]) << transport;
      EXPECT_EQ(bad["steps"], good["steps"]) << transport;
      EXPECT_GT(bad["repairs"], 3 * bad["steps"].get<int>()) << "was anything lost?";
    }
  }

  void ExpectDamagedMessagesChangeNoResultOfASignedRun(int steps) {
    const std::string key = folder_.File("key");
    ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
    const auto good = Run({"--transport", "direct"}, steps);
    for (const char* transport : {"udpm", "memq"}) {
      const auto bad = Run(
          {"--transport", transport, "--key", key, "--faults", "flip=0.02,truncate=0.02"}, steps);
      EXPECT_EQ(bad["digest"], good["digest"]) << transport;
      EXPECT_GT(bad["refused"]["badly_signed"], 0) << transport;
      EXPECT_GT(bad["refused"]["not_signed"], 0) << transport;
      EXPECT_EQ(bad["refused"]["malformed"], 0) << transport;
    }
  }

 private:
  ScratchFolder folder_;
  int logs_ = 0;
};

}  // namespace fogline::test
