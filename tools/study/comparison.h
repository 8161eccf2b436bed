// Compares variants (rules that decide who drives) in several cases over many seeds. Most studies
// consist of such comparisons. For each seed, all variants of a case have the same noise, and are
// paired with the same run without traded control.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/metrics/event_share.h"
#include "tools/report/study_page.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline::study {

/// A scenario file with overrides.
struct StudyCase {
  std::string name;
  std::string file;
  std::vector<std::string> overrides;  // in the form of --set
  std::string group;                   // name of a group of cases, such as all cases in one fog
};

/// A rule that decides who drives. Its overrides change the arbitrator; some also change the
/// fusion. All variants of a case share one run without traded control and without these overrides.
struct StudyVariant {
  std::string name;
  std::vector<std::string> overrides;
};

/// The override for a run without traded control.
inline constexpr std::string_view kWithoutTradedControl = "/arbitrator/policy=none";

/// The measure of safety in most findings.
inline constexpr std::string_view kShortfall = "mean_compromised_safety_fog_m";

/// The measure that is 1 if a run ends in a collision, and otherwise 0.
inline constexpr std::string_view kCollided = "collided";

/// The measure of VisitMetrics() that says which cars have collided, as a code. A mean of codes has
/// no meaning, so comparisons leave it out.
inline constexpr std::string_view kCollisionCode = "collision";

/// A measure of a run: a measure of VisitPairedMetrics(), "collided" (1 or 0), or a measure of
/// VisitMetrics() other than kCollisionCode.
struct ComparedMetric {
  std::string name;
  std::string unit;
  std::string description;
};
std::span<const ComparedMetric> ComparedMetrics();
/// Index of a measure in ComparedMetrics(). @throws std::out_of_range if there is no such measure
std::size_t PlaceOfMetric(std::string_view name);

/// One variant in one case.
struct Cell {
  std::size_t test_case = 0;
  std::size_t variant = 0;
};

/// A cell with its name in a table.
struct NamedCell {
  std::string name;
  Cell cell;
};

class Comparison {
 public:
  /// Runs all cells. @throws InputError, StudyStopped; std::invalid_argument if a name has a comma,
  /// because commas separate the cells of a CSV file
  Comparison(const StudyContext& context, std::vector<StudyCase> cases,
             std::vector<StudyVariant> variants);
  /// Takes the values of finished runs.
  /// @param values of all measures in all runs, ordered by case, then by variant, measure and seed
  /// @throws std::invalid_argument if the number of values is wrong
  Comparison(std::vector<StudyCase> cases, std::vector<StudyVariant> variants, std::int64_t seeds,
             std::vector<double> values);

  const std::vector<StudyCase>& cases() const { return cases_; }
  const std::vector<StudyVariant>& variants() const { return variants_; }
  std::int64_t seeds() const { return seeds_; }
  /// Number of runs, including those without traded control.
  std::int64_t runs() const;

  /// The values of a measure in the runs of a cell, seed by seed; NaN for a run without a value.
  std::span<const double> Values(Cell cell, std::string_view measure) const;
  Estimate Mean(Cell cell, std::string_view measure) const;
  /// The difference a - b, paired seed by seed.
  Estimate Difference(Cell a, Cell b, std::string_view measure) const;
  /// Share of runs with a collision.
  metrics::EventShare Collisions(Cell cell) const;
  /// The mean of a measure with its interval, for figures and files. It equals Mean(), except that
  /// the interval of "collided" comes from Collisions().
  Estimate Point(Cell cell, std::string_view measure) const;
  /// Number of pairs of runs that end early. A pair ends early if at least one of its runs
  /// collides, or if the two runs differ in length. Sums and means over time then lack the steps
  /// after the end.
  std::int64_t PairsCutShort(Cell a, Cell b) const;
  /// p-value of the difference of `collided`, by the exact test of McNemar over the pairs.
  double PValueOfCollisions(Cell a, Cell b) const;
  /// For each seed 1 if the run of `a` is less safe than that of `b`, else 0. Collisions come
  /// first: a run that collides is less safe than one that does not. Two runs that do not collide
  /// are compared by their compromised safety. Two runs that collide are equally safe.
  std::vector<double> LessSafe(Cell a, Cell b) const;
  /// Index of the case, or of the variant, with this name. @throws std::out_of_range
  std::size_t CaseNamed(std::string_view name) const;
  std::size_t VariantNamed(std::string_view name) const;

  /// Number of differences from variant `reference` that have a p-value.
  std::int64_t Comparisons(std::size_t reference) const;
  /// A CSV file with a row for each measure in each cell. A row has a summary of the measure, and
  /// its difference from the same measure of variant `reference` in the same case. A difference has
  /// an interval, an effect size (mean divided by standard deviation of the paired differences,
  /// Cohen's d_z), and a p-value. The p-value is also adjusted by Holm for all differences of the
  /// file. The p-value of `collided` comes from McNemar's test, and all other p-values come from
  /// the t test. If pairs of runs end early (PairsCutShort()), the file has the number of these
  /// pairs. Then the differences of all measures other than `collided` have no p-value.
  std::string Csv(std::size_t reference) const;
  /// A figure of a measure: points with intervals. If `cases_on_axis` is true, the cases are on the
  /// x axis and each variant is a series. Otherwise the variants are on the x axis and each case is
  /// a series.
  report::StudyFigure FigureOf(std::string_view measure, std::string id, std::string title,
                               bool cases_on_axis = false) const;
  /// A table with one row for each of these cells. A row has the mean and the interval of each
  /// measure.
  report::StudyTable TableOf(std::string caption, std::string kind, std::span<const NamedCell> rows,
                             std::span<const std::string_view> measures) const;
  /// TableOfCase(): a table of one case, with one row for each variant. TableOfVariant(): a table
  /// of one variant, with one row for each case.
  report::StudyTable TableOfCase(std::size_t test_case,
                                 std::span<const std::string_view> measures) const;
  report::StudyTable TableOfVariant(std::size_t variant,
                                    std::span<const std::string_view> measures) const;

 private:
  /// The difference of a variant from variant `reference` in one measure, and the result of the
  /// test of this difference.
  struct PairedTest {
    Estimate difference;
    std::int64_t cut_short = 0;  // number of pairs (PairsCutShort())
    std::optional<double> p;
  };
  /// The tests of all variants against variant `reference`, by case, variant and measure. The tests
  /// of variant `reference` itself are empty.
  std::vector<PairedTest> TestsAgainst(std::size_t reference) const;

  std::vector<StudyCase> cases_;
  std::vector<StudyVariant> variants_;
  std::int64_t seeds_ = 0;
  std::vector<double> values_;  // by case, variant, measure, seed
};

/// Adds an estimate at `x` to a series.
void AddPoint(report::StudySeries& series, double x, const Estimate& estimate);

/// The name of a measure in findings and figures, such as "safety improvement (SI)".
std::string NameForReaders(std::string_view measure);

}  // namespace fogline::study
