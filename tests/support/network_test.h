// Common parts of tests on simulated machines.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>
#include <string>
#include <vector>

#include "tests/support/machine.h"
#include "tests/support/network.h"

namespace fogline::test {

/// Fixture of tests on simulated machines. If these machines cannot be made, the tests are skipped
/// or fail, with the reason (MachineLacks()).
class NetworkTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = WhyNoMachines(); !why.empty()) {
      return MachineLacks("root, network namespaces or nftables: " + why);
    }
  }

  /// The command line of a run of the paper's scenario with a log of its own.
  std::vector<std::string> Run(const std::vector<std::string>& more) {
    ++logs_;
    std::vector<std::string> command{Program("fogline"),
                                     "run",
                                     "scenario/paper.json",
                                     "--json",
                                     "--stall-timeout",
                                     stall_timeout_s_,
                                     "--log",
                                     Log()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }

  /// The log of the last run.
  std::string Log() const { return folder_.File(std::to_string(logs_) + ".lcm"); }

  /// The JSON result that a run printed.
  static nlohmann::json Result(const Outcome& outcome) {
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
  static nlohmann::json ResultOf(Background& run) {
    const int code = run.Wait();
    return Result({code, run.Out(), run.Err()});
  }

  /// The number of lines on stderr, without the warnings that the runner was held up. On a busy
  /// machine, any run may print these warnings.
  static int LinesBesideDelays(const std::string& err) {
    int lines = 0;
    std::istringstream in(err);
    for (std::string line; std::getline(in, line);) {
      lines += line.starts_with("warning: the runner was held up for ") ? 0 : 1;
    }
    return lines;
  }

  /// The digest of a run of the paper's scenario with the options `more`, in one process and
  /// without messages.
  std::string Undisturbed(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--transport", "direct"});
    return Result(RunCommand(Run(more)))["digest"];
  }

  std::string stall_timeout_s_ = "30";

 private:
  ScratchFolder folder_;
  int logs_ = 0;
};

}  // namespace fogline::test
