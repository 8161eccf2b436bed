// The kinds of faults of a soak.
#pragma once

#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/soak/soaked_run.h"

namespace fogline::test {

/// Limits of the random parameters.
struct Limits {
  double freeze_s = 60;     // longest time for which all processes stand still
  double partition_s = 20;  // longest time for which a machine is cut off
};

struct FaultKind {
  std::string_view name;
  std::string_view what;
  bool three_machines;  // it needs three machines; the other kinds run on one machine or on three
  bool one_machine;
  /// Options of `fogline run` that make the fault; empty if `strike` makes it.
  std::vector<std::string> (*options)(std::mt19937_64& random);
  /// Makes the fault once. @pre the run still goes on
  void (*strike)(SoakedRun& run, std::mt19937_64& random, const Limits& limits);
  int most_strikes;  // in a run
};

std::span<const FaultKind> FaultKinds();

}  // namespace fogline::test
