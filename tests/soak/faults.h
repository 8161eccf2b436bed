// The kinds of faults of a soak.
#pragma once

#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/soak/soaked_run.h"

namespace fogline::test {

/// Limits of the random durations of faults.
struct Limits {
  double freeze_s = 60;     // longest time for which all processes are stopped
  double partition_s = 20;  // longest time for which a machine is disconnected
};

struct FaultKind {
  std::string_view name;
  std::string_view what;
  bool three_machines;  // a third of the runs are on three machines; all if `alone` is empty
  std::optional<SoakedRun::Place> alone;  // place of the other runs
  /// Options of `fogline run` that cause the fault; empty if `strike` causes the fault.
  std::vector<std::string> (*options)(std::mt19937_64& random);
  /// Causes one fault. @return whether the fault has hit the run @pre the run has not ended
  bool (*strike)(SoakedRun& run, std::mt19937_64& random, const Limits& limits);
  int most_strikes;  // most faults in one run
};

std::span<const FaultKind> FaultKinds();

}  // namespace fogline::test
