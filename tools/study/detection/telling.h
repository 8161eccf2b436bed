// Which detectors count once, because their alarms are the same, and which conditions rank
// detectors at all.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace fogline::study {

/// The first alarm of a detector in each run, s; negative in a run without one.
struct AlarmTimes {
  std::vector<double> common;   // in the runs of all detectors
  std::vector<double> further;  // in runs of some detectors only; empty for the others
};

/// For each detector the index of the one with which it counts: two detectors with the same alarms
/// in all runs in which they are compared are one. That one has the most runs of them. Further runs
/// are compared if both have equally many, because these are the same runs.
std::vector<std::size_t> OneOfEqualAlarms(std::span<const AlarmTimes> detectors);

/// What a condition says of the detectors.
enum class Telling {
  kRanks,
  kAllAtOnce,  // nine of ten detectors alarm within the shortest difference of the first one
  kHardlyAny,  // no detector finds one fog of ten
};
/// "ranked", "all alarm at once" or "hardly any alarm".
std::string_view Text(Telling telling);

/// Mean delay of a detector in a condition, and the share of the fogs that it finds.
struct DelayAndShare {
  double delay_s;
  double share;
};
/// @param shortest_s smaller differences of a delay rank nothing
/// @return kRanks without detectors
Telling TellingOf(std::span<const DelayAndShare> detectors, double shortest_s);

}  // namespace fogline::study
