// Runs programs for a benchmark, and gives the folder for their files.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace fogline::benchmarks {

/// The path of a program of this build, such as "fogline".
std::string ProgramPath(const std::string& name);

/// Result of a program that ended with exit code 0.
struct ProgramResult {
  std::string out;
  double wall_s;          // from its start to its end
  double peak_memory_mb;  // largest resident set, in MB of 10^6 bytes
};

/// Runs a program to its end. A name without a slash is looked up in PATH.
/// @throws std::runtime_error if the program cannot start, ends by a signal, or has an exit code
/// other than 0. If the program has started, the text contains the last line of its stderr
ProgramResult RunProgram(const std::vector<std::string>& command);

/// A folder for the files of this process. It is removed when the process ends.
const std::filesystem::path& ScratchFolder();

/// Wall-clock seconds that `work` takes.
template <class Work>
double SecondsOf(Work&& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

}  // namespace fogline::benchmarks
