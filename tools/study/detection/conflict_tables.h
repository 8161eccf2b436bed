// Tables, figures and CSV files of study `conflict`.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/study_page.h"
#include "tools/study/detection/conflict_runs.h"

namespace fogline::study {

/// "bias, near-range noise".
std::string NameOfSet(const ConflictSet& set);
/// The names of all detectors that count as this one.
std::string NamesOf(const ConflictSet& set, std::size_t detector);
/// The detectors that have a threshold, the shortest mean delay first. Those with the same alarms
/// are one.
std::vector<std::size_t> Ranked(const ConflictSet& set);

/// The detectors between a distance of a single step and the Degree of Conflict: each has one more
/// of its parts.
struct DocPart {
  std::string_view name;
  std::string_view detector;
};
inline constexpr std::array<DocPart, 4> kDocParts{{{"distance of one step", "distance"},
                                                   {"with its window", "distance + window"},
                                                   {"and its sign", "distance + window + sign"},
                                                   {"and its sigmoid", "doc"}}};

/// What each part of the Degree of Conflict changes, for the sets that rank detectors.
report::StudyTable TableOfParts(std::span<const ConflictSet> sets);
/// Which conditions rank detectors.
report::StudyTable TableOfConditions(std::span<const ConflictSet> sets);
/// Mean delays of each measure of a single step with and without window and sign.
report::StudyTable TableOfOptions(const ConflictSet& set);
/// Every detector of a set, in order of rank.
report::StudyTable TableOfDetectors(const ConflictSet& set);

/// Delay, AUC and ROC of the measures; the options of window and sign are in the tables only.
std::vector<report::StudyFigure> FiguresOf(const ConflictSet& set);

std::string ConflictCsv(std::span<const ConflictSet> sets);
/// The ROC of the measures with the usual noise.
std::string RocCsv(std::span<const ConflictSet> sets);

}  // namespace fogline::study
