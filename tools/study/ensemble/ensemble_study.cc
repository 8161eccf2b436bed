// Study `ensemble`: whether the findings of the other studies hold with every parameter set that
// meets the paper's table.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/study/ensemble/ensemble_runs.h"
#include "tools/study/ensemble/parameter_sets.h"
#include "tools/study/ensemble/robustness.h"
#include "tools/study/estimate.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

/// A large difference needs only one seed of so many.
constexpr std::int64_t kLarge = 8;

/// The findings of docs/findings.md that are examined, with the claims on which they rest.
const std::vector<ExaminedFinding>& Findings() {
  static const std::vector<ExaminedFinding> kFindings{
      {.number = 1,
       .name = "a driver who needs time",
       .central = {{"takeover", "A wait of three seconds leaves nothing of the gain.", 1,
                    Bound::kBelow},
                   {"takeover", "A wait of five seconds does harm."},
                   {"takeover",
                    "With realistic noise in bias fog a wait of five seconds still helps."}},
       .exceptions = {{"A wait of three seconds leaves nothing of the gain.",
                       {5},
                       InSet::kUndecided}},
       .why = "it is not certain there that a wait of three seconds leaves nothing of the gain."},
      {.number = 2,
       .name = "a driver who errs",
       .central = {{"driver", "In the paper's fog a human who misjudges does harm."},
                   {"policy",
                    "In bias fog with a fallible human the automation alone is safer than traded "
                    "control."},
                   {"driver", "In dense fog traded control helps: all weaknesses.", kLarge},
                   {"driver", "An imperfect human leaves more danger.", kLarge}},
       .exceptions = {},
       .why = ""},
      {.number = 3,
       .name = "a gate that stays shut",
       .central =
           {{"policy", "With a false echo a gate without a human is safer than: traded.", kLarge},
            {"policy", "With a false echo a gate without a human is safer than: request + isolate.",
             kLarge},
            {"policy", "With a false echo a gate that reopens early is worse than traded control.",
             kLarge},
            {"policy", "With a missing echo the automation alone is safer than traded control.",
             kLarge}},
       .exceptions = {{"With a false echo a gate without a human is safer than: request + isolate.",
                       {2, 5, 7, 8},
                       InSet::kOpposite},
                      {"With a false echo a gate without a human is safer than: request + isolate.",
                       {1, 3, 4, 6},
                       InSet::kUndecided},
                      {"With a missing echo the automation alone is safer than traded control.",
                       {1, 2, 3, 4, 5, 6, 7, 8},
                       InSet::kOpposite}},
       .why = "the gate is safer than traded control in all of them, but without an echo handing "
              "over is safer, and no set shows that the gate is safer than a driver who is asked "
              "while the deceived sensor is left out."},
      {.number = 4,
       .name = "the paper's threshold against a low one",
       .central = {{"threshold", "The paper's threshold is safer than a low one."}},
       .exceptions = {{"The paper's threshold is safer than a low one.", {4, 8}, InSet::kOpposite}},
       .why = "the paper's threshold is less safe than a low one there. The highest threshold is "
              "not examined."},
      {.number = 5,
       .name = "leaving out the deceived sensor",
       .central = {{"takeover", "With a false echo a wait of five seconds does harm.", kLarge},
                   {"takeover", "It costs nothing if the deceived sensor is left out meanwhile.", 1,
                    Bound::kAbove},
                   {"takeover", "That is safer than a driver without any wait.", kLarge}},
       .exceptions = {{"With a false echo a wait of five seconds does harm.",
                       {3},
                       InSet::kUndecided},
                      {"It costs nothing if the deceived sensor is left out meanwhile.",
                       {3},
                       InSet::kOpposite}},
       .why = "leaving out the deceived sensor costs safety there."},
      {.number = 6,
       .name = "a perfect human in bias fog",
       .central = {{"policy", "In bias fog traded control is safer than: none."},
                   {"policy", "In bias fog traded control is safer than: isolate."},
                   {"policy", "In bias fog traded control is safer than: none + adaptive noise."},
                   {"policy", "In bias fog shared control is safer still."},
                   {"policy",
                    "With a calibrated radar, the right sensor at the right time is the safest."}},
       .exceptions = {{"With a calibrated radar, the right sensor at the right time is the safest.",
                       {1, 4, 5, 8},
                       InSet::kOpposite},
                      {"In bias fog traded control is safer than: none + adaptive noise.",
                       {8},
                       InSet::kOpposite}},
       .why = "with a calibrated radar shared control is safer than the right sensor there, and in "
              "set 8 adaptive noise is safer than traded control."},
      {.number = 8,
       .name = "only followers with an ACC gain",
       .central = {{"followers", "In bias fog traded control helps an ACC."},
                   {"followers", "In bias fog traded control does nothing for a normal human."},
                   {"followers", "With RSS nothing is left to improve.", kLarge},
                   {"followers", "In beam fog traded control does harm with an aggressive human."},
                   {"followers", "The last car of a string brakes less hard: normal humans.",
                    kLarge}},
       .exceptions = {{"In beam fog traded control does harm with an aggressive human.",
                       {1, 5},
                       InSet::kUndecided}},
       .why =
           "it is not certain there that an aggressive follower comes closer with a false echo."},
      {.number = 9,
       .name = "a leader that brakes hard",
       .central =
           {{"vehicle", "Traded control does harm: hard braking in beam fog: point mass.", kLarge},
            {"vehicle", "Traded control does harm: hard braking in beam fog: compact.", kLarge},
            {"vehicle", "Traded control does harm: hard braking in beam fog: sedan.", kLarge},
            {"vehicle", "Traded control does harm: hard braking in beam fog: truck.", kLarge}},
       .exceptions =
           {{"Traded control does harm: hard braking in beam fog: point mass.",
             {1, 2, 4, 7},
             InSet::kOpposite},
            {"Traded control does harm: hard braking in beam fog: compact.",
             {1, 2, 4, 7},
             InSet::kOpposite},
            {"Traded control does harm: hard braking in beam fog: sedan.",
             {1, 2, 4, 7},
             InSet::kOpposite},
            {"Traded control does harm: hard braking in beam fog: point mass.",
             {5, 8},
             InSet::kUndecided},
            {"Traded control does harm: hard braking in beam fog: compact.",
             {5, 8},
             InSet::kUndecided},
            {"Traded control does harm: hard braking in beam fog: sedan.",
             {5, 8},
             InSet::kUndecided},
            {"Traded control does harm: hard braking in beam fog: truck.",
             {5, 8},
             InSet::kUndecided},
            {"Traded control does harm: hard braking in beam fog: truck.", {4}, InSet::kOpposite},
            {"Traded control does harm: hard braking in beam fog: truck.", {7}, InSet::kUndecided}},
       .why = "handing over makes a sedan safer in sets 1, 2, 4 and 7, and no difference is "
              "certain in sets 5 and 8, where cars collide."},
      {.number = 10,
       .name = "a smooth transfer",
       .central = {{"transfer", "In the paper's scenario the step is comfortable."},
                   {"transfer", "In dense fog the step is comfortable, too.", kLarge},
                   {"transfer", "In the paper's scenario a linear ramp costs safety."},
                   {"transfer", "In dense fog the gate costs no safety.", kLarge, Bound::kBelow}},
       .exceptions = {},
       .why = ""},
  };
  return kFindings;
}

/// The finding whose comparisons need other runs than these.
constexpr std::string_view kNotExamined = "7: the window and the sign of the Degree of Conflict";
constexpr std::ptrdiff_t kRowNotExamined = 6;

constexpr std::string_view kEnsembleAnswer =
    "What the findings say of a driver who errs and of a smooth transfer holds with every "
    "parameter "
    "set. What they say of a slow driver, of a low threshold, of leaving out the deceived sensor, "
    "of "
    "followers and of a calibrated radar does not hold with some sets. What they say of a missing "
    "echo holds with none, and what they say of a leader that brakes hard holds with few.";
constexpr std::string_view kEnsembleWouldChange =
    "Other parameter sets that meet the table, or other sensors in dense fog.";

using JudgedClaims = std::vector<std::vector<JudgedInSet>>;

/// Each finding with the place of its first claim among all claims.
std::vector<std::pair<const ExaminedFinding*, std::size_t>> Places() {
  std::vector<std::pair<const ExaminedFinding*, std::size_t>> places;
  std::size_t first = 0;
  for (const ExaminedFinding& finding : Findings()) {
    places.emplace_back(&finding, first);
    first += finding.central.size();
  }
  return places;
}

std::string RowName(const ExaminedFinding& finding) {
  return fmt::format("{}: {}", finding.number, finding.name);
}

/// For each finding and set: whether the finding holds, or how many of its comparisons do.
report::StudyTable SetsTable(std::span<const EnsembleSet> sets, const JudgedClaims& judged,
                             std::int64_t seeds) {
  report::StudyTable table{
      .caption =
          fmt::format("Comparisons that hold, of those on which a finding rests ({} seeds)", seeds),
      .columns = {"finding"}};
  for (const EnsembleSet& set : sets) table.columns.push_back(set.name);
  for (const auto& [finding, first] : Places()) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(RowName(*finding));
    const std::size_t all = finding->central.size();
    for (std::size_t s = 0; s < sets.size(); ++s) {
      std::size_t holding = 0;
      for (std::size_t c = first; c < first + all; ++c) {
        holding += judged[c][s].outcome == InSet::kHolds ? 1 : 0;
      }
      row.push_back(holding == all ? "all" : fmt::format("{} of {}", holding, all));
    }
  }
  std::vector<std::string> row(sets.size() + 1, "not examined");
  row[0] = kNotExamined;
  table.rows.insert(table.rows.begin() + kRowNotExamined, std::move(row));
  return table;
}

/// The first comparison of each finding in each set, as a share of the largest one.
report::StudyFigure SetsFigure(std::span<const EnsembleSet> sets,
                               std::span<const ClaimInSets> claims) {
  report::StudyFigure figure{
      .id = "ensemble-sets",
      .title = "The first comparison of each finding in each parameter set",
      .caption =
          "Difference as a share of the largest one of all sets, with its 95 % confidence "
          "interval. Above 0: as the finding says. There is no point if runs end in collisions.",
      .x_label = "",
      .y_label = "Share of the largest difference"};
  for (const EnsembleSet& set : sets) figure.series.emplace_back().name = set.name;
  for (const auto& [finding, first] : Places()) {
    const std::vector<Claim>& in_sets = claims[first].sets;
    const auto x = static_cast<double>(figure.categories.size());
    figure.categories.push_back(RowName(*finding));
    double largest = 0;
    for (const Claim& claim : in_sets) {
      if (!claim.p) largest = std::max(largest, std::abs(claim.difference.mean));
    }
    for (std::size_t s = 0; s < sets.size(); ++s) {
      // A share of seeds is no difference of safety, so it has no point.
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

/// Doubles the quotes of a text in a cell of a CSV file, and puts it in quotes.
std::string QuotedCell(std::string_view text) {
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

std::string EnsembleCsv(std::span<const EnsembleSet> sets, std::span<const ClaimInSets> claims,
                        const JudgedClaims& judged) {
  std::string csv =
      "finding,study,claim,set,n,difference,difference_ci95_low,difference_ci95_high,p,p_holm,"
      "outcome\n";
  for (const auto& [finding, first] : Places()) {
    for (std::size_t c = first; c < first + finding->central.size(); ++c) {
      const auto row = [&](std::string_view set, const Estimate& difference) {
        csv +=
            fmt::format("{},{},{},{},{},{}", finding->number, claims[c].quoted.study,
                        QuotedCell(claims[c].quoted.says), set, difference.n, CsvText(difference));
      };
      for (std::size_t s = 0; s < sets.size(); ++s) {
        const JudgedInSet& one = judged[c][s];
        row(sets[s].name, claims[c].sets[s].difference);
        csv += fmt::format(",{},{},{}\n", CsvText(one.p), CsvText(one.p_holm), Text(one.outcome));
      }
    }
  }
  return csv;
}

std::string EnsembleMethod(std::int64_t seeds, std::size_t comparisons, std::size_t sets) {
  return fmt::format(
      "{0} seeds of the {1} comparisons that decide on the findings of docs/findings.md, with each "
      "of the {2} parameter sets of scenario/ensemble. Scenarios, rules and measures are those of "
      "the study that makes the claim. In paper.json a set replaces all of its fields. "
      "dense_fog.json describes another fog and other sensors, so it keeps what it states itself; "
      "the set replaces the controllers, the driver, the window and the safety floor, and the gaps "
      "follow from them. What a case changes stays changed, such as realistic noise. A calibrated "
      "radar is one without the offset of the set. A comparison holds in a set if its difference "
      "has the sign that the finding says, at 5 % after Holm's correction for all {3} comparisons "
      "in all sets together. It is opposite if the difference has the other sign at the same "
      "level, "
      "and undecided otherwise. A finding holds in a set if all of its comparisons hold there. It "
      "is robust only if it holds in all sets. A wait leaves nothing of the gain if it does not "
      "save more than a difference that does not matter; a rule costs nothing if it does not cost "
      "more than that. Comparisons whose differences are large have one of every {4} seeds. If "
      "runs end "
      "in collisions, the runs of each seed are compared: a run that collides is less safe than "
      "one "
      "that does not, and two runs that do not collide are compared by their compromised safety "
      "(exact test of McNemar). Each claim shows the least certain comparison of those that hold. "
      "Finding 4: only the paper's threshold is compared with a low one, in {0} situations for "
      "each "
      "set. SI varies so much between situations that a comparison with the highest threshold "
      "needs "
      "about a thousand. Finding 7 is not examined. Its detectors need long runs in clear air for "
      "each set, as long as the whole study conflict. That study states the noise of the sensors "
      "itself, so a set would change little more than the window and the size of the fog's effect.",
      seeds, comparisons, sets, comparisons * sets, kLarge);
}

}  // namespace

StudyResult RunEnsembleStudy(const StudyContext& context) {
  const std::vector<EnsembleSet> sets = ReadEnsembleSets(context.scenarios);
  std::vector<QuotedClaim> quoted;
  for (const ExaminedFinding& finding : Findings()) {
    quoted.insert(quoted.end(), finding.central.begin(), finding.central.end());
  }
  const EnsembleRuns ensemble = RunEnsemble(context, sets, quoted);
  const std::span<const ClaimInSets> claims = ensemble.claims;
  const JudgedClaims judged = JudgeInSets(claims);
  StudyResult result;
  result.runs = ensemble.runs;
  for (const auto& [finding, first] : Places()) {
    const std::size_t count = finding->central.size();
    result.claims.push_back(ClaimOnFinding(*finding, claims.subspan(first, count),
                                           std::span(judged).subspan(first, count)));
  }
  report::StudySection& section = result.section;
  section.answer = kEnsembleAnswer;
  section.would_change = kEnsembleWouldChange;
  section.figures = {SetsFigure(sets, claims)};
  section.tables = {SetsTable(sets, judged, context.seeds.count())};
  section.method = EnsembleMethod(context.seeds.count(), quoted.size(), sets.size());
  result.files = {{"ensemble.csv", EnsembleCsv(sets, claims, judged)}};
  return result;
}

}  // namespace fogline::study
