// The processes on a simulated machine.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/network.h"

namespace fogline::test {

/// The names of Fogline's processes in the network of a machine, without those that have ended.
inline std::vector<std::string> FoglineOn(const Machine& machine) {
  std::vector<std::string> names;
  std::error_code ignored;
  const std::string network = std::filesystem::read_symlink(machine.network(), ignored).string();
  for (const auto& entry : std::filesystem::directory_iterator("/proc", ignored)) {
    const std::string pid = entry.path().filename().string();
    if (!std::ranges::all_of(pid, [](unsigned char c) { return std::isdigit(c) != 0; })) continue;
    if (std::filesystem::read_symlink(entry.path() / "ns/net", ignored).string() != network)
      continue;
    const std::string name = Content(entry.path() / "comm");
    if (name.starts_with("fogline") && IsAlive(std::stoi(pid))) {
      names.push_back(name.substr(0, name.find('\n')));
    }
  }
  std::ranges::sort(names);
  return names;
}

/// Waits until no process of Fogline is left on a machine. @return the names of the processes that
/// are left after `limit`
inline std::vector<std::string> LeftOn(const Machine& machine,
                                       std::chrono::seconds limit = kPatience) {
  const auto end = std::chrono::steady_clock::now() + limit;
  std::vector<std::string> left = FoglineOn(machine);
  while (!left.empty() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(kLookEvery);
    left = FoglineOn(machine);
  }
  return left;
}

}  // namespace fogline::test
