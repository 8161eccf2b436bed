// Variants of who drives, compared in several cases over many seeds: what most studies are made of.
// All variants of a case see the same noise, seed by seed, and are paired with the same run without
// traded control.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"
#include "services/measures/event_share.h"
#include "tools/report/study_page.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline {

/// A scenario file and what is different in it.
struct StudyCase {
  std::string name;
  std::string file;
  std::vector<std::string> overrides;  // as of --set
  std::string group;  // cases that differ in one thing only, such as those in the same fog
};

/// Who drives, and how. Its overrides concern the arbitrator alone: the run without traded control
/// is the same for all variants of a case.
struct StudyVariant {
  std::string name;
  std::vector<std::string> overrides;
};

/// The override that makes a run one without traded control.
inline constexpr std::string_view kWithoutTradedControl = "/arbitrator/policy=none";

/// Which measure of a run. The safety improvement and "collided" (1 or 0) stand beside those of
/// VisitMeasures().
struct ComparedMeasure {
  std::string name;
  std::string unit;
  std::string description;
};
std::span<const ComparedMeasure> ComparedMeasures();
/// @throws std::out_of_range
std::size_t PlaceOfMeasure(std::string_view name);

/// One variant in one case.
struct Cell {
  std::size_t test_case = 0;
  std::size_t variant = 0;
};

class Comparison {
 public:
  /// Runs everything. @throws InputError, StudyStopped
  Comparison(const StudyContext& context, std::vector<StudyCase> cases,
             std::vector<StudyVariant> variants);
  /// Of runs that are made already. @param values by case, variant, measure and seed
  /// @throws std::invalid_argument if there are not as many
  Comparison(std::vector<StudyCase> cases, std::vector<StudyVariant> variants, std::int64_t seeds,
             std::vector<double> values);

  const std::vector<StudyCase>& cases() const { return cases_; }
  const std::vector<StudyVariant>& variants() const { return variants_; }
  std::int64_t seeds() const { return seeds_; }
  /// Runs made, with those that others were paired with.
  std::int64_t runs() const;

  /// A measure in the runs of a cell, seed by seed; NaN where the run has none.
  std::span<const double> Values(Cell cell, std::string_view measure) const;
  Estimate Mean(Cell cell, std::string_view measure) const;
  /// Of a - b, seed by seed.
  Estimate Difference(Cell a, Cell b, std::string_view measure) const;
  /// How often a car collides.
  EventShare Collisions(Cell cell) const;
  /// How often a measure is at most `limit`, of the runs that have it. runs is 0 if none has.
  EventShare AtMost(Cell cell, std::string_view measure, double limit) const;
  /// Whether two cells have the same runs: every measure, seed by seed.
  bool HasSameRuns(Cell a, Cell b) const;
  /// In how many pairs of runs at least one of the two ends early: it collides, or the two have
  /// not as many steps. What is summed or averaged over time leaves out what would have followed.
  std::int64_t PairsCutShort(Cell a, Cell b) const;
  /// Place of the variant of that name. @throws std::out_of_range
  std::size_t VariantNamed(std::string_view name) const;

  /// A summary of every measure of every cell, and its difference from variant `reference`.
  std::string Csv(std::size_t reference) const;
  /// Points with intervals: the variants on the x axis and a series for each case, or the other way
  /// about.
  StudyFigure FigureOf(std::string_view measure, std::string id, std::string title,
                       bool cases_on_axis = false) const;
  /// A row for each variant (or, of a single variant, for each case) with means and intervals.
  StudyTable TableOfCase(std::size_t test_case, std::span<const std::string_view> measures) const;
  StudyTable TableOfVariant(std::size_t variant, std::span<const std::string_view> measures) const;

 private:
  /// All values of a cell, measure by measure.
  std::span<const double> AllOf(Cell cell) const;
  StudyTable TableOf(std::string caption, std::span<const Cell> rows, bool name_cases,
                     std::span<const std::string_view> measures) const;

  std::vector<StudyCase> cases_;
  std::vector<StudyVariant> variants_;
  std::int64_t seeds_ = 0;
  std::vector<double> values_;  // by case, variant, measure, seed
};

/// "safety improvement (SI)": how findings and figures call a measure.
std::string NameForReaders(std::string_view measure);

}  // namespace fogline
