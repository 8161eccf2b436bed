// The scenarios that Fogline ships, and the digest of a scenario that runs in this process.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/runtime/wire/digest.h"

namespace fogline::test {

/// A recorded leader drives for many minutes. For a test the first kMostSteps steps are enough.
inline constexpr std::int64_t kMostSteps = 1000;

struct Shipped {
  std::string name;
  Scenario scenario;
};

/// Every scenario in a folder, by name, at most kMostSteps long. A scenario with cars of SUMO is
/// left out: it needs SUMO, whose library also allocates memory (tests/campaign/sumo_test.cc).
inline std::vector<Shipped> ShippedScenarios(const std::filesystem::path& folder) {
  std::vector<Shipped> shipped;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& file = entry.path();
    if (file.extension() != ".json" || file.stem().extension() == ".schema") continue;
    const Scenario whole = LoadScenario(file);
    if (whole.lead.profile == LeadProfile::kSumo) continue;
    const std::int64_t steps = std::min(whole.steps, kMostSteps);
    shipped.push_back(
        {file.stem().string(), LoadScenario(file, {"/steps=" + std::to_string(steps)})});
  }
  std::ranges::sort(shipped, {}, &Shipped::name);
  return shipped;
}

/// Runs the loop to the end. @return the digest. @pre `loop` is new or restarted
inline std::string DigestOf(closed_loop::ClosedLoop& loop) {
  runtime::Digest digest;
  std::vector<std::uint8_t> buffer;
  loop.Run(0, [&](const closed_loop::StepView& step) {
    step.ForEachMessage([&](const auto& message) {
      runtime::Encode(message, buffer);
      digest.Add(buffer);
    });
  });
  return digest.Hex();
}

/// The digest of the run of a new loop.
inline std::string FreshDigest(const Scenario& scenario) {
  closed_loop::ClosedLoop loop(scenario);
  return DigestOf(loop);
}

}  // namespace fogline::test
