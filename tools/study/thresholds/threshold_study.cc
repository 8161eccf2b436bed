// Study `threshold`: compares adaptive thresholds, which depend on the situation, and fixed
// thresholds with the same redundant engagement, in a mix of situations.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "tools/stats/pareto.h"
#include "tools/study/bootstrap.h"
#include "tools/study/comparison.h"
#include "tools/study/study.h"
#include "tools/study/study_findings.h"
#include "tools/study/thresholds/equal_engagement.h"
#include "tools/study/thresholds/threshold_mix.h"

namespace fogline::study {
namespace {

/// Every member compared with the curve of fixed thresholds, in the order of MixedRuns::members.
/// Members on the curve itself are compared with nothing.
struct Beside {
  std::vector<AtEqualEngagement> si;         // in points
  std::vector<AtEqualEngagement> shortfall;  // in m; less is better
  std::vector<CurvePoint> curve;             // for SI
  std::size_t fixed = 0;                     // number of members on the curve; they are the first
                                             // ones
};

Beside BesideFixed(const MixedRuns& mixed) {
  Beside beside;
  // Less compromised safety is better, so the gain has the opposite sign.
  std::vector<std::vector<double>> spared;
  for (const RuleMember& member : mixed.members) {
    std::vector<double>& of = spared.emplace_back(member.shortfall_m);
    for (double& value : of) value = -value;
    if (member.family != 0) continue;
    ++beside.fixed;
    beside.curve.push_back({.rhe_pct = member.rhe(), .gain = member.si()});
  }
  const auto compare = [&](auto gain_of) {
    std::vector<RuleValues> all;
    for (std::size_t i = 0; i < mixed.members.size(); ++i) {
      all.push_back({.rhe_pct = mixed.members[i].rhe_pct, .gain = gain_of(i)});
    }
    const auto fixed = std::span(all).first(beside.fixed);
    std::vector<AtEqualEngagement> compared =
        AgainstFixed(fixed, std::span(all).subspan(beside.fixed));
    compared.insert(compared.begin(), beside.fixed, {});  // the curve itself
    return compared;
  };
  beside.si = compare([&](std::size_t i) { return std::span(mixed.members[i].si_pct); });
  beside.shortfall = compare([&](std::size_t i) { return std::span(spared[i]); });
  for (AtEqualEngagement& one : beside.shortfall) {
    one.difference = Turned(one.difference);
    if (one.place) one.place->gain = -one.place->gain;
  }
  return beside;
}

/// "fixed 0.341": the threshold at a place of the curve.
std::string ThresholdText(const MixedRuns& mixed, const CurvePlace& place) {
  const auto& fixed = mixed.families.front().values;
  const double threshold = place.share == 0
                               ? fixed[place.below]
                               : std::lerp(fixed[place.below], fixed[place.below + 1], place.share);
  return fmt::format("fixed {:.3g}", threshold);
}

/// Verdict on one family by the intervals, and whether it agrees with the expectation.
std::string FindingOfFamily(const MixedRuns& mixed, const Beside& beside, std::size_t family) {
  std::map<Verdict, std::vector<std::string>> by_verdict;
  std::vector<std::string> equal;
  std::vector<std::string> beyond;
  std::vector<std::string> dominated;  // among the members that are better at equal RHE
  for (std::size_t i = 0; i < mixed.members.size(); ++i) {
    const RuleMember& member = mixed.members[i];
    if (member.family != family) continue;
    const AtEqualEngagement& one = beside.si[i];
    const auto& place = one.place;
    const Estimate& difference = one.difference;
    if (!place) {
      beyond.push_back(fmt::format("{} (RHE {} %)", member.name, Text(member.rhe(), 2)));
      continue;
    }
    const std::string text = fmt::format("{} ({} points against {} ± {} at RHE {} %)", member.name,
                                         Text(difference, 2), ThresholdText(mixed, *place),
                                         Text(one.interpolation_error, 2), Text(member.rhe(), 3));
    if (difference.low == 0 && difference.high == 0) {
      equal.push_back(member.name);
      continue;
    }
    by_verdict[one.verdict()].push_back(text);
    if (one.verdict() == Verdict::kMore && one.cheaper &&
        VerdictOf(one.against_cheaper) == Verdict::kLess) {
      dominated.push_back(fmt::format("{} ({} points less than {})", member.name,
                                      Text(Turned(one.against_cheaper), 2),
                                      mixed.members[*one.cheaper].name));
    }
  }
  const std::vector<std::string>& above = by_verdict[Verdict::kMore];
  const std::vector<std::string>& below = by_verdict[Verdict::kLess];
  const std::vector<std::string>& undecided = by_verdict[Verdict::kUndecided];
  const auto part = [](std::string_view what, const std::vector<std::string>& of) {
    return of.empty() ? std::string() : fmt::format(" {}: {}.", what, ListText(of));
  };
  const std::size_t compared = above.size() + below.size() + equal.size() + undecided.size();
  std::string answer;
  if (compared > 0) {
    answer = fmt::format(
        " So at equal RHE its SI is at least that of the best fixed threshold for {} of {} values "
        "of its parameter. It is less for {}. For {} the difference is not decided.",
        above.size() + equal.size(), compared, below.size(), undecided.size());
    if (!above.empty()) {
      answer += fmt::format(
          " Of the {} values with more SI, {} are dominated: a fixed threshold engages the human "
          "no more and has more SI{}{}.",
          above.size(), dominated.size(), dominated.empty() ? "" : ": ", ListText(dominated));
    }
  }
  return fmt::format(
      "{} against the best fixed threshold of the same RHE, by SI.{}{}{}{}{}{}{}",
      Capital(mixed.families[family].name), part("More", above), part("Equal", equal),
      part("Less", below), part("Not decided", undecided),
      part("Too few runs for an interval", by_verdict[Verdict::kTooFew]),
      part("Not compared, because their RHE is beyond that of every fixed threshold", beyond),
      answer);
}

/// Describes the Pareto front of all rules, and lists the rules that cannot be told apart from a
/// rule on it.
std::string FrontText(const MixedRuns& mixed) {
  std::vector<stats::TradeOff> points;
  for (const RuleMember& member : mixed.members) points.push_back({member.rhe(), member.si()});
  const std::vector<std::size_t> front = stats::ParetoFront(points);
  std::vector<std::string> names;
  for (const std::size_t i : front) {
    const RuleMember& member = mixed.members[i];
    names.push_back(fmt::format("{} (RHE {} %, SI {} %)", member.name, Text(member.rhe(), 2),
                                Text(member.si(), 1)));
  }
  std::vector<std::string> like;
  for (std::size_t f = 0; f < mixed.families.size(); ++f) {
    std::vector<std::string> close;
    for (const RuleMember& member : mixed.members) {
      if (member.family != f) continue;
      const bool is_close = std::ranges::any_of(front, [&](std::size_t i) {
        const RuleMember& best = mixed.members[i];
        return &best != &member &&
               VerdictOf(PairedDifference(member.si_pct, best.si_pct)) == Verdict::kUndecided &&
               VerdictOf(PairedDifference(member.rhe_pct, best.rhe_pct)) == Verdict::kUndecided;
      });
      if (is_close) close.push_back(member.name);
    }
    if (close.empty()) continue;
    like.push_back(close.size() == 1 ? close.front()
                                     : fmt::format("{} values from {} to {}", close.size(),
                                                   close.front(), close.back()));
  }
  std::string text = fmt::format("The Pareto front of all rules in mean RHE and mean SI is {}{}.",
                                 front.size() == 1 ? "a single point: " : "", ListText(names));
  if (front.size() == 1) {
    text +=
        " A rule that engages the human least in clear air is also the safest, so there is no "
        "trade-off between the two.";
  }
  if (!like.empty()) {
    text += fmt::format(
        " Without a significant difference from it in both RHE and SI, by paired differences: {}.",
        ListText(like));
  }
  return text;
}

/// The members of a family in order of RHE.
std::vector<std::size_t> ByRhe(const MixedRuns& mixed, std::size_t family) {
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < mixed.members.size(); ++i) {
    if (mixed.members[i].family == family) members.push_back(i);
  }
  std::ranges::stable_sort(members, {}, [&](std::size_t i) { return mixed.members[i].rhe(); });
  return members;
}

constexpr std::string_view kRheAxis = "Redundant human engagement (RHE, %)";

report::StudyFigure FrontFigure(const MixedRuns& mixed, std::string id, std::string title,
                                std::string y_label, std::vector<double> RuleMember::*values) {
  report::StudyFigure figure{.id = std::move(id),
                             .title = std::move(title),
                             .caption =
                                 "A point for each member of a family, with the 95 % confidence "
                                 "band of its mean.",
                             .x_label = std::string(kRheAxis),
                             .y_label = std::move(y_label)};
  for (std::size_t f = 0; f < mixed.families.size(); ++f) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = mixed.families[f].name;
    for (const std::size_t i : ByRhe(mixed, f)) {
      const RuleMember& member = mixed.members[i];
      AddPoint(series, member.rhe(), EstimateOf(member.*values));
    }
  }
  return figure;
}

report::StudyFigure DifferenceFigure(const MixedRuns& mixed, const Beside& beside) {
  report::StudyFigure figure{
      .id = "threshold-equal-rhe",
      .title = "Rules against the best fixed threshold of the same RHE",
      .caption = "Difference of SI, with 95 % bootstrap bands. Above 0: more.",
      .x_label = std::string(kRheAxis),
      .y_label = "SI of the rule minus SI of the fixed threshold (points)"};
  for (std::size_t f = 1; f < mixed.families.size(); ++f) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = mixed.families[f].name;
    for (const std::size_t i : ByRhe(mixed, f)) {
      AddPoint(series, mixed.members[i].rhe(), beside.si[i].difference);
    }
  }
  return figure;
}

std::string RulesCsv(const MixedRuns& mixed, const Beside& beside) {
  std::string csv =
      "family,member,situations,rhe_n,rhe_pct,rhe_ci95_low,rhe_ci95_high,si_n,si_pct,si_ci95_low,"
      "si_ci95_high,compromised_n,compromised_safety_fog_m,compromised_ci95_low,"
      "compromised_ci95_high,collisions,fixed_of_equal_rhe,fixed_si_pct,si_minus_fixed,"
      "si_minus_fixed_ci95_low,si_minus_fixed_ci95_high,fixed_compromised_m,"
      "compromised_minus_fixed,compromised_minus_fixed_ci95_low,compromised_minus_fixed_ci95_high"
      "\n";
  for (std::size_t i = 0; i < mixed.members.size(); ++i) {
    const RuleMember& member = mixed.members[i];
    csv +=
        fmt::format("{},{},{}", mixed.families[member.family].name, member.name, mixed.situations);
    for (const auto values :
         {&RuleMember::rhe_pct, &RuleMember::si_pct, &RuleMember::shortfall_m}) {
      const Estimate mean = EstimateOf(member.*values);
      csv += fmt::format(",{},{}", mean.n, CsvText(mean));
    }
    csv += fmt::format(",{}", member.collisions);
    const std::optional<CurvePlace>& place = beside.si[i].place;
    csv += fmt::format(",{}", place ? ThresholdText(mixed, *place) : "");
    for (const AtEqualEngagement* one : {&beside.si[i], &beside.shortfall[i]}) {
      const std::optional<CurvePlace>& at = one->place;
      csv += fmt::format(",{},{}", at ? CsvText(at->gain) : "", CsvText(one->difference));
    }
    csv += "\n";
  }
  return csv;
}

report::StudyTable TableOfRules(const MixedRuns& mixed, const Beside& beside) {
  report::StudyTable table{
      .caption = "Every rule: means over the situations [95 % confidence intervals]",
      .columns = {"rule", "RHE (%)", "SI (%)", "fixed threshold of equal RHE",
                  "difference of SI (points)", "compromised safety in fog (m)", "collisions"}};
  for (std::size_t i = 0; i < mixed.members.size(); ++i) {
    const RuleMember& member = mixed.members[i];
    const std::optional<CurvePlace>& place = beside.si[i].place;
    const Estimate& difference = beside.si[i].difference;
    table.rows.push_back(
        {member.name, Text(EstimateOf(member.rhe_pct), 2), Text(EstimateOf(member.si_pct), 1),
         place ? ThresholdText(mixed, *place) : "–", place ? Text(difference, 2) : "–",
         Text(EstimateOf(member.shortfall_m), 3),
         Text(metrics::ClopperPearson(member.collisions, mixed.situations))});
  }
  return table;
}

std::string ThresholdMethod(const MixedRuns& mixed, const Beside& beside) {
  double widest = 0;
  for (std::size_t i = 0; i + 1 < beside.curve.size(); ++i) {
    widest = std::max(widest, std::abs(beside.curve[i].rhe_pct - beside.curve[i + 1].rhe_pct));
  }
  return fmt::format(
      "{} situations, one for each seed, {}. SI has a value only in situations with fog and "
      "compromised safety, RHE in all with clear air. Equal RHE: the {} fixed thresholds make a "
      "curve of mean SI over mean RHE. The curve is straight between neighbours, which are at most "
      "{:.1f} points of RHE apart. A rule is compared with the point of the curve that has its "
      "RHE. If several thresholds have this RHE, the best of them counts (those above all conflict "
      "in clear air have an RHE of 0). The number after ± is the possible error of the curve at "
      "that point: the distance of the thresholds on either side from the curve of the others, "
      "weighted less the nearer the point is to one of them. A difference is not decided if its "
      "interval is not farther from 0 than this error. At an RHE of almost 0 the curve jumps. So a "
      "rule is also compared with the best fixed threshold of at most its RHE. The rule is called "
      "dominated if that threshold has more SI by its interval. Intervals: {} resamples of the "
      "situations, each with its own curve. So they contain the noise of equal situations, the RHE "
      "of both sides and the choice of the best. SI is a mean of ratios of small numbers, so "
      "compromised safety in metres is beside it.",
      mixed.situations, MixText(), beside.fixed, widest, kReplicates);
}

}  // namespace

StudyResult RunThresholdStudy(const StudyContext& context) {
  const MixedRuns mixed = RunMix(context);
  const Beside beside = BesideFixed(mixed);
  StudyResult result;
  result.runs = mixed.situations * static_cast<std::int64_t>(mixed.members.size() + 1);
  report::StudySection& section = result.section;
  for (std::size_t f = 1; f < mixed.families.size(); ++f) {
    section.findings.push_back(FindingOfFamily(mixed, beside, f));
  }
  section.findings.push_back(FrontText(mixed));
  section.figures = {
      DifferenceFigure(mixed, beside),
      FrontFigure(mixed, "threshold-front", "The price of safety in a mix of situations",
                  "Safety improvement (SI, %)", &RuleMember::si_pct),
      FrontFigure(mixed, "threshold-cs", "The same in metres", "Mean compromised safety in fog (m)",
                  &RuleMember::shortfall_m)};
  section.tables = {TableOfRules(mixed, beside)};
  section.method = ThresholdMethod(mixed, beside);
  result.files = {{"threshold.csv", RulesCsv(mixed, beside)}};
  return result;
}

}  // namespace fogline::study
