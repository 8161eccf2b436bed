// The command line of a run of the paper's scenario, at a URL that the test chooses.
#pragma once

#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

inline std::vector<std::string> PaperRun(const std::string& url, const std::string& log,
                                         const std::vector<std::string>& more) {
  std::vector<std::string> command{
      Program("fogline"), "run", "scenario/paper.json", "--json", "--lcm-url", url, "--log", log};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

}  // namespace fogline::test
