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

/// Name of a set, such as "bias, near-range noise".
std::string NameOfSet(const ConflictSet& set);
/// The names of this detector and of all detectors with the same alarms (ConflictSet::counts_as).
std::string NamesOf(const ConflictSet& set, std::size_t detector);
/// The detectors that have a threshold, the shortest mean delay first. If no condition of the set
/// permits such an order (ConflictSet::Ranks(), telling.h), the list has the order of Detectors().
/// Of several detectors with the same alarms, the list has only one.
std::vector<std::size_t> Ranked(const ConflictSet& set);

/// An entry of kDocParts: a detector, and its name in the table. The list kDocParts begins with the
/// distance of a single step, and ends with the Degree of Conflict. Each detector has one part of
/// the Degree of Conflict more than the detector before it.
struct DocPart {
  std::string_view name;
  std::string_view detector;
};
inline constexpr std::array<DocPart, 4> kDocParts{
    {{"distance of one step", "distance"},
     {"with its window", "distance + window"},
     {"and its sign", "distance + window + sign"},
     {"and its sigmoid (equal by definition)", "doc"}}};

/// A table of the effect of each part of the Degree of Conflict. It has only the sets in which the
/// detectors can be put into an order by their delays (ConflictSet::Ranks()).
report::StudyTable TableOfParts(std::span<const ConflictSet> sets);
/// A table that shows in which conditions the detectors can be put into an order by their delays
/// (telling.h).
report::StudyTable TableOfConditions(std::span<const ConflictSet> sets);
/// A table of mean delays from fog to alarm. It has one row for each measure that uses a single
/// step. Its columns are the measure as it is, with window, with sign, and with both.
report::StudyTable TableOfOptions(const ConflictSet& set);
/// A table of the detectors of a set, in the order of Ranked(). Detectors with the same alarms
/// share a row. The detectors without a threshold come last.
report::StudyTable TableOfDetectors(const ConflictSet& set);

/// Figures of the delay, the AUC and the ROC of each measure. The figures do not show the
/// combinations of a measure with window and sign.
std::vector<report::StudyFigure> FiguresOf(const ConflictSet& set);

std::string ConflictCsv(std::span<const ConflictSet> sets);
/// The ROC of the measures as CSV, only for the sets with the noise kUsualNoise.
std::string RocCsv(std::span<const ConflictSet> sets);

}  // namespace fogline::study
