// Calls of `fogline study`, and the files that it writes.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

inline Outcome Study(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {Program("fogline"), "study"});
  return RunCommand(arguments, 2 * kPatience);
}

inline std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace fogline::test
