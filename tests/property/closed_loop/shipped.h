// The scenarios that Fogline ships, and the digest of one in this process.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "scenario/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/runtime/digest.h"

namespace fogline::test {

/// A recorded leader drives for many minutes; so many steps of it prove as much.
inline constexpr std::int64_t kMostSteps = 1000;

struct Shipped {
  std::string name;
  Scenario scenario;
};

/// Every scenario in a folder, by name, at most kMostSteps long. One whose recorded driving is not
/// on this machine is left out.
inline std::vector<Shipped> ShippedScenarios(const std::filesystem::path& folder) {
  std::vector<Shipped> shipped;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& file = entry.path();
    if (file.extension() != ".json" || file.stem().extension() == ".schema") continue;
    std::ifstream in(file);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const Scenario plain = ParseScenario(text, file.string());
    if (plain.lead.profile == LeadProfile::kRecorded &&
        !std::filesystem::exists(file.parent_path() / plain.lead.recorded.file)) {
      continue;
    }
    const std::int64_t steps = std::min(plain.steps, kMostSteps);
    shipped.push_back(
        {file.stem().string(), LoadScenario(file, {"/steps=" + std::to_string(steps)})});
  }
  std::ranges::sort(shipped, {}, &Shipped::name);
  return shipped;
}

/// Runs to the end. @pre `loop` is new or restarted
inline std::string DigestOf(ClosedLoop& loop) {
  Digest digest;
  std::vector<std::uint8_t> buffer;
  loop.Run(0, [&](const StepView& step) {
    step.ForEachMessage([&](const auto& message) {
      Encode(message, buffer);
      digest.Add(buffer);
    });
  });
  return digest.Hex();
}

}  // namespace fogline::test
