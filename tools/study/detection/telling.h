// Finds detectors that have the same alarms, because such detectors count as one detector. Also
// finds the conditions that rank detectors. A condition ranks detectors if some detector finds
// enough fogs, and if the delays of the detectors differ enough to put the detectors into an order.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace fogline::study {

/// Time of the first alarm of a detector in each run, s; negative in a run without an alarm.
struct AlarmTimes {
  std::vector<double> common;   // in the runs that all detectors have
  std::vector<double> further;  // in runs that only some detectors have; empty without such runs
};

/// For each detector, the index of the detector that it counts as. Detectors with the same alarms
/// count as one of them, the one with the most runs. A detector whose alarms no other detector has
/// counts as itself. Two detectors have the same alarms if their lists `common` are equal, and if
/// their lists `further` are equal or have different lengths. Lists `further` of different lengths
/// are not compared, because they come from different runs.
std::vector<std::size_t> OneOfEqualAlarms(std::span<const AlarmTimes> detectors);

/// Whether the results of a condition are good enough to rank the detectors; if not, the reason.
enum class Telling {
  kRanks,
  kAllAtOnce,  // nine of ten detectors raise the alarm at about the same time as the first one
  kHardlyAny,  // every detector finds less than a tenth of the fogs
};
/// "ranked", "all raise the alarm at once" or "hardly any alarm".
std::string_view Text(Telling telling);

/// Mean delay of a detector in a condition, and the share of the fogs that the detector finds.
struct DelayAndShare {
  double delay_s;
  double share;
};
/// @param shortest_s delays that differ by less than this time count as the same time
/// @return kHardlyAny if every detector finds less than a tenth of the fogs. Otherwise kAllAtOnce
/// if the delays of nine of ten detectors count as the same time. Otherwise, and if there are no
/// detectors, kRanks.
Telling TellingOf(std::span<const DelayAndShare> detectors, double shortest_s);

}  // namespace fogline::study
