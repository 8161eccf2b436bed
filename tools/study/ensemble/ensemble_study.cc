// Study `ensemble`: examines whether the findings of the other studies hold with every parameter
// set that meets the paper's table.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/study/detection/conflict_runs.h"
#include "tools/study/ensemble/ensemble_runs.h"
#include "tools/study/ensemble/examined_findings.h"
#include "tools/study/ensemble/parameter_sets.h"
#include "tools/study/ensemble/robustness.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

constexpr std::string_view kEnsembleAnswer =
    "The headings of six of the ten findings hold with every parameter set; the heading on a slow "
    "driver is undecided with one set; the heading on leaving out the deceived sensor is opposite "
    "with one set, the heading on the paper's threshold with two sets, and the heading on a leader "
    "that brakes hard with four sets. The side claims hold with every set for a driver who errs, "
    "for leaving out the deceived sensor, and for the window and the sign of the Degree of "
    "Conflict. With a false or a missing echo some side claims are opposite with every set, "
    "because there some rules that hand over are a little safer than the gate or the automation "
    "alone.";
constexpr std::string_view kEnsembleWouldChange =
    "Other parameter sets that meet the table, or other sensors in dense fog.";

using JudgedClaims = std::vector<std::vector<JudgedInSet>>;

/// A part of a finding, and the places of its claims among all claims.
struct Placed {
  const ExaminedFinding& finding;
  Part part;
  std::size_t first = 0;

  std::size_t count() const { return finding.Of(part).claims.size(); }
  std::size_t end() const { return first + count(); }
  std::string Name() const {
    return fmt::format("{}, {}: {}", finding.number, Text(part), finding.name);
  }
};

std::vector<Placed> Places() {
  std::vector<Placed> places;
  for (const ExaminedFinding& finding : ExaminedFindings()) {
    for (const Part part : {Part::kHeading, Part::kSide}) {
      places.push_back({finding, part, places.empty() ? 0 : places.back().end()});
    }
  }
  return places;
}

/// The verdict on a part of a finding in one set, such as "holds". If the part has several claims
/// and not all hold, the text also counts the outcomes: "opposite (3 hold, 1 opposite, 2
/// undecided)".
std::string VerdictText(const Placed& placed, const JudgedClaims& judged, std::size_t set) {
  std::vector<InSet> outcomes;
  for (std::size_t c = placed.first; c < placed.end(); ++c) {
    outcomes.push_back(judged[c][set].outcome);
  }
  const InSet verdict = VerdictOn(outcomes);
  if (verdict == InSet::kHolds || outcomes.size() == 1) return std::string(Text(verdict));
  return fmt::format("{} ({} hold, {} opposite, {} undecided)", Text(verdict),
                     std::ranges::count(outcomes, InSet::kHolds),
                     std::ranges::count(outcomes, InSet::kOpposite),
                     std::ranges::count(outcomes, InSet::kUndecided));
}

std::vector<std::string> ColumnsOf(std::string_view first, std::span<const EnsembleSet> sets) {
  std::vector<std::string> columns{std::string(first)};
  for (const EnsembleSet& set : sets) columns.push_back(set.name);
  return columns;
}

/// A table of the verdict on each part of each finding in each set.
report::StudyTable VerdictTable(std::span<const EnsembleSet> sets, const JudgedClaims& judged,
                                std::int64_t seeds) {
  report::StudyTable table{
      .caption = fmt::format("Verdicts on the heading and on the side claims of each finding ({} "
                             "seeds, with the exceptions that the method names)",
                             seeds),
      .columns = ColumnsOf("finding", sets)};
  for (const Placed& placed : Places()) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(placed.Name());
    for (std::size_t s = 0; s < sets.size(); ++s) row.push_back(VerdictText(placed, judged, s));
  }
  return table;
}

/// A table of the outcome and the difference of each claim in each set.
report::StudyTable OutcomeTable(std::span<const EnsembleSet> sets,
                                std::span<const ClaimInSets> claims, const JudgedClaims& judged) {
  report::StudyTable table{.caption = "Each claim in each parameter set",
                           .columns = ColumnsOf("claim", sets)};
  for (const Placed& placed : Places()) {
    for (std::size_t c = placed.first; c < placed.end(); ++c) {
      std::vector<std::string>& row = table.rows.emplace_back();
      row.push_back(fmt::format("{}, {}: {}", placed.finding.number, claims[c].quoted.study,
                                claims[c].quoted.says));
      for (std::size_t s = 0; s < sets.size(); ++s) {
        row.push_back(
            fmt::format("{}: {}", Text(judged[c][s].outcome), Text(claims[c].sets[s].difference)));
      }
    }
  }
  return table;
}

/// A figure of the first comparison of each finding: the difference in each parameter set, divided
/// by the largest difference in any set.
report::StudyFigure SetsFigure(std::span<const EnsembleSet> sets,
                               std::span<const ClaimInSets> claims) {
  report::StudyFigure figure{
      .id = "ensemble-sets",
      .title = "The first comparison of each finding in each parameter set",
      .caption =
          "Difference as a share of the largest one of all sets, with its 95 % confidence "
          "interval. Above 0: as the finding says; a finding that two values are equal allows "
          "small "
          "values below 0, too. There is no point if runs end in collisions.",
      .x_label = "",
      .y_label = "Share of the largest difference"};
  for (const EnsembleSet& set : sets) figure.series.emplace_back().name = set.name;
  for (const Placed& placed : Places()) {
    if (placed.part != Part::kHeading) continue;
    const std::vector<Claim>& in_sets = claims[placed.first].sets;
    const auto x = static_cast<double>(figure.categories.size());
    figure.categories.push_back(fmt::format("{}: {}", placed.finding.number, placed.finding.name));
    double largest = 0;
    for (const Claim& claim : in_sets) {
      if (!claim.p) largest = std::max(largest, std::abs(claim.difference.mean));
    }
    for (std::size_t s = 0; s < sets.size(); ++s) {
      // A claim that has Claim::p compares shares of seeds. Its difference is not a difference in
      // safety, so the figure has no point for this claim.
      const Estimate in_set = in_sets[s].p ? Estimate{} : in_sets[s].difference;
      const bool is_turned = in_sets[s].sign == Sign::kLess;
      report::StudySeries& series = figure.series[s];
      series.x.push_back(x);
      series.y.push_back((is_turned ? -in_set.mean : in_set.mean) / largest);
      series.low.push_back((is_turned ? -in_set.high : in_set.low) / largest);
      series.high.push_back((is_turned ? -in_set.low : in_set.high) / largest);
    }
  }
  return figure;
}

/// A text as a cell of a CSV file: in quotes, with each quote inside the text doubled.
std::string QuotedCell(std::string_view text) {
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

std::string EnsembleCsv(std::span<const EnsembleSet> sets, std::span<const ClaimInSets> claims,
                        const JudgedClaims& judged) {
  std::string csv =
      "finding,part,study,claim,set,n,difference,difference_ci95_low,difference_ci95_high,p,p_holm,"
      "outcome\n";
  for (const Placed& placed : Places()) {
    for (std::size_t c = placed.first; c < placed.end(); ++c) {
      const QuotedClaim& quoted = claims[c].quoted;
      for (std::size_t s = 0; s < sets.size(); ++s) {
        const JudgedInSet& one = judged[c][s];
        const Estimate& difference = claims[c].sets[s].difference;
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", placed.finding.number,
                           Text(placed.part), quoted.study, QuotedCell(quoted.says), sets[s].name,
                           difference.n, CsvText(difference), CsvText(one.p), CsvText(one.p_holm),
                           Text(one.outcome));
      }
    }
  }
  return csv;
}

std::string EnsembleMethod(std::int64_t seeds, std::size_t comparisons, std::size_t sets) {
  return fmt::format(
      "{0} seeds (exceptions below) of the {1} comparisons that decide on the findings of "
      "docs/findings.md, with each of the {2} parameter sets of scenario/ensemble. Scenarios, "
      "rules and measures are those of the study that makes the claim. In paper.json all fields of "
      "a set get the set's values. dense_fog.json describes another fog and other sensors, so a "
      "field that dense_fog.json contains keeps its value; the set replaces only the controllers, "
      "the driver, the window, the safety floor and the filter's noise of the radar's range rate, "
      "and the gaps follow from them. The changes that a case makes stay, such as realistic noise. "
      "A calibrated radar does not have the offset of the set. A comparison holds in a set if its "
      "difference has the sign that the finding says, at 5 % after Holm's correction for all {3} "
      "comparisons in all sets together. It is opposite if the difference has the other sign at "
      "the same level, and undecided otherwise. The heading of a finding has a verdict of its own, "
      "and so have the other claims below it together (side claims): they hold in a set if each of "
      "them holds, are opposite if at least one is opposite, and are undecided otherwise. A wait "
      "leaves nothing of the gain if the remaining gain is below the margin; a rule costs nothing "
      "if its cost is below the margin. Comparisons whose differences are large use only the first "
      "of {4} parts of the seeds (column n of ensemble.csv). If runs end in collisions, the runs "
      "of each seed are compared: a run that collides is less safe than one that does not, and two "
      "runs that do not collide are compared by their compromised safety (exact test of McNemar). "
      "Each row of the claims shows the least certain one of its comparisons that hold or are "
      "opposite: the one with the largest p-value. Finding 4: {5} situations for each set, because "
      "SI varies much between situations. Finding 7: bias fog with near-range noise. The study "
      "itself fixes this noise, so a set affects the result only through the window, the offset, "
      "the motion and the size of the fog's effect. Its thresholds come from {6} runs in clear air "
      "for each seed, and its delays are means over all visibilities.",
      seeds, comparisons, sets, comparisons * sets, kLarge, seeds * kManySituations,
      kDelayClearAir);
}

}  // namespace

StudyResult RunEnsembleStudy(const StudyContext& context) {
  const std::vector<EnsembleSet> sets = ReadEnsembleSets(context.scenarios);
  std::vector<QuotedClaim> quoted;
  for (const Placed& placed : Places()) {
    const std::vector<QuotedClaim>& claims = placed.finding.Of(placed.part).claims;
    quoted.insert(quoted.end(), claims.begin(), claims.end());
  }
  const EnsembleRuns ensemble = RunEnsemble(context, sets, quoted);
  const std::span<const ClaimInSets> claims = ensemble.claims;
  const JudgedClaims judged = JudgeInSets(claims);
  StudyResult result;
  result.runs = ensemble.runs;
  for (const Placed& placed : Places()) {
    result.claims.push_back(ClaimOnPart(placed.finding, placed.part,
                                        claims.subspan(placed.first, placed.count()),
                                        std::span(judged).subspan(placed.first, placed.count())));
  }
  report::StudySection& section = result.section;
  section.answer = kEnsembleAnswer;
  section.would_change = kEnsembleWouldChange;
  section.figures = {SetsFigure(sets, claims)};
  section.tables = {VerdictTable(sets, judged, context.seeds.count()),
                    OutcomeTable(sets, claims, judged)};
  section.method = EnsembleMethod(context.seeds.count(), quoted.size(), sets.size());
  result.files = {{"ensemble.csv", EnsembleCsv(sets, claims, judged)}};
  return result;
}

}  // namespace fogline::study
