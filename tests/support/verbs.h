// The verbs of `fogline`, as its help lists them, and the errors of command lines that `fogline`
// refuses.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

inline std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The error text of a refused command line of `fogline`: exit code 2, nothing on stdout, one line
/// on stderr.
inline std::string ErrorOf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), Program("fogline"));
  const Outcome outcome = RunCommand(arguments);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(Lines(outcome.err), testing::SizeIs(1));
  return outcome.err;
}

inline std::vector<std::string> Verbs() {
  std::vector<std::string> verbs;
  const std::vector<std::string> lines = Lines(RunCommand({Program("fogline"), "--help"}).out);
  auto line = std::ranges::find(lines, "Subcommands:");
  for (; line != lines.end() && !line->empty(); ++line) {
    if (line->starts_with("  ")) verbs.push_back(line->substr(2, line->find(' ', 2) - 2));
  }
  return verbs;
}

}  // namespace fogline::test
