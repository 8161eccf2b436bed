// Makes sentences about the measures of conflict as detectors of fog.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/detection/conflict_runs.h"

namespace fogline::study {

std::string_view NameOfMeasure(std::size_t measure);

/// "bias, near-range noise".
std::string NameOfSet(const ConflictSet& set);

/// Measures with a threshold, the shortest delay first.
std::vector<std::size_t> Rank(const ConflictSet& set);

/// Measures without those that are the same test as an earlier one: a twin is named with that
/// measure and counts once.
std::vector<std::size_t> WithoutTwins(std::span<const std::size_t> ranked);

/// "600 [580, 620]": the mean time to a false alarm with its bounds, in s.
std::string ArlText(const AlarmCount& clear);

/// Which of the ranked measures is first, and how the others compare with the Degree of Conflict.
std::string FindingOfSet(const ConflictSet& set, std::span<const std::size_t> ranked);

/// Says whether thresholds keep their rate of false alarms in runs from which they were not found.
std::string FindingOfArlZero(const ConflictSet& set, std::span<const std::size_t> ranked);

}  // namespace fogline::study
