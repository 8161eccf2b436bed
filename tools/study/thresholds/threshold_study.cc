// Study `threshold`: asks whether a threshold that changes with the situation (adaptive) is better
// than a fixed threshold. Both are compared at equal redundant human engagement, in a mix of
// situations.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include "tools/study/bootstrap.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/engagement/fog_modes.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"
#include "tools/study/thresholds/both_humans.h"
#include "tools/study/thresholds/equal_engagement.h"
#include "tools/study/thresholds/threshold_mix.h"

namespace fogline::study {
namespace {

/// Comparisons of each rule in MixedRuns::members with the curve of the fixed thresholds, in the
/// order of MixedRuns::members. The fixed thresholds are members, too. Their comparisons are empty.
struct Beside {
  std::vector<AtEqualEngagement> si;         // in percentage points
  std::vector<AtEqualEngagement> shortfall;  // in m; less is better
  std::vector<CurvePoint> curve;             // for SI
  std::size_t fixed = 0;                     // number of members on the curve; they come first
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
    compared.insert(compared.begin(), beside.fixed, {});  // the members on the curve itself
    return compared;
  };
  beside.si = compare([&](std::size_t i) { return std::span(mixed.members[i].si_pct); });
  beside.shortfall = compare([&](std::size_t i) { return std::span(spared[i]); });
  for (AtEqualEngagement& one : beside.shortfall) {
    Estimate& difference = one.difference;
    difference.mean = -difference.mean;
    std::tie(difference.low, difference.high) = std::pair(-difference.high, -difference.low);
    if (one.place) one.place->gain = -one.place->gain;
  }
  return beside;
}

/// Name of the threshold at a place of the curve, such as "fixed 0.341".
std::string ThresholdText(const MixedRuns& mixed, const CurvePlace& place) {
  const auto& fixed = mixed.families.front().values;
  const double threshold = place.share == 0
                               ? fixed[place.below]
                               : std::lerp(fixed[place.below], fixed[place.below + 1], place.share);
  return fmt::format("fixed {:.3g}", threshold);
}

constexpr std::string_view kThresholdAnswer =
    "No. In a mix of situations, a rule that engages the human less in clear air is nearly always "
    "safer, and the best rule hardly ever hands over, even to a human who never errs; with two "
    "parameter sets of study ensemble the paper's threshold is safer than such a rule. At equal "
    "engagement an adaptive threshold does not beat a fixed one; dropping the deceived sensor "
    "gains a little.";
constexpr std::string_view kThresholdWouldChange =
    "Situations in which the automation is deceived for longer.";

/// The claim on the difference in SI between a rule and the fixed threshold that has the same RHE.
Claim AtEqualRhe(const MixedRuns& mixed, const Beside& beside, std::string says,
                 std::string_view rule, Sign sign, double margin = 0) {
  const AtEqualEngagement& one = beside.si[RuleNamed(mixed, rule)];
  return {.says = std::move(says),
          .compared = fmt::format("{} against the fixed threshold of equal RHE, SI (points)", rule),
          .sign = sign,
          .difference = one.difference,
          .margin = margin,
          .p = {},
          .hindrance = !one.place ? "its RHE is beyond that of every fixed threshold"
                       : one.verdict() == Verdict::kUndecided && sign != Sign::kEqual
                           ? "not farther from 0 than the possible error of the curve"
                           : ""};
}

std::vector<Claim> ThresholdClaims(const MixedRuns& mixed, const Beside& beside) {
  constexpr double kNothing = 3;  // points of SI, as in study transfer
  const auto against = [&](std::string says, std::string_view a, std::string_view b, Sign sign,
                           double margin = 0) {
    return RuleClaim(mixed, "", std::move(says), a, b, sign, margin);
  };
  std::vector<Claim> claims = ClaimsOnFixed(mixed, "");
  const auto more = {
      against("A threshold of 0.99 is safer than the adaptive rule.", "fixed 0.99", "adaptive 0.5",
              Sign::kMore),
      against("A threshold of 0.99 is safer than the rule by costs.", "fixed 0.99", "bayes 1",
              Sign::kMore),
      against("A threshold of 0.99 is as safe as dropping the sensor at threshold 0.98.",
              "fixed 0.99", "availability 0.98", Sign::kEqual, kNothing),
      AtEqualRhe(mixed, beside, "At equal engagement, dropping the deceived sensor gains a little.",
                 "availability 0.5", Sign::kMore),
      AtEqualRhe(mixed, beside,
                 "An adaptive rule with a low threshold (0.35) is less safe at equal engagement.",
                 "adaptive 0.35", Sign::kLess),
  };
  claims.insert(claims.end(), more.begin(), more.end());
  return claims;
}

/// The two claims of ClaimsOnFixed() for each human and each radar.
std::vector<Claim> ClaimsOnHumans(std::span<const HumanMix> mixes) {
  std::vector<Claim> claims;
  for (const HumanMix& mix : mixes) {
    for (Claim& claim : ClaimsOnFixed(mix.runs, mix.Name())) claims.push_back(std::move(claim));
  }
  return claims;
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

std::string ThresholdCsv(const MixedRuns& mixed, const Beside& beside) {
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
      csv += fmt::format(",{},{},{},{}", mean.n, CsvText(mean.mean), CsvText(mean.low),
                         CsvText(mean.high));
    }
    csv += fmt::format(",{}", member.collisions);
    const std::optional<CurvePlace>& place = beside.si[i].place;
    csv += fmt::format(",{}", place ? ThresholdText(mixed, *place) : "");
    for (const AtEqualEngagement* one : {&beside.si[i], &beside.shortfall[i]}) {
      const std::optional<CurvePlace>& at = one->place;
      const Estimate& difference = one->difference;
      csv += fmt::format(",{},{},{},{}", at ? CsvText(at->gain) : "", CsvText(difference.mean),
                         CsvText(difference.low), CsvText(difference.high));
    }
    csv += "\n";
  }
  return csv;
}

/// The rules of the table "Some rules".
constexpr std::array<std::string_view, 9> kTelling{
    "fixed 0.3",    "fixed 0.5", "fixed 0.8",        "fixed 0.99",       "adaptive 0.5",
    "adaptive 0.7", "bayes 1",   "availability 0.5", "availability 0.98"};

report::StudyTable TableOfRules(const MixedRuns& mixed, const Beside& beside, std::string_view name,
                                std::span<const std::size_t> rules) {
  report::StudyTable table{
      .caption = fmt::format("{}: means over the situations [95 % confidence intervals]", name),
      .columns = {"rule", "RHE (%)", "SI (%)", "fixed threshold of equal RHE",
                  "difference of SI (points)", "compromised safety in fog (m)", "collisions"}};
  for (const std::size_t i : rules) {
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

std::int64_t RunsOf(const MixedRuns& mixed) {
  return mixed.situations * static_cast<std::int64_t>(mixed.members.size() + 1);
}

std::string ThresholdMethod(const MixedRuns& mixed, const Beside& beside) {
  double widest = 0;
  for (std::size_t i = 0; i + 1 < beside.curve.size(); ++i) {
    widest = std::max(widest, std::abs(beside.curve[i].rhe_pct - beside.curve[i + 1].rhe_pct));
  }
  return fmt::format(
      "{} situations, one for each seed. {} SI has a value only in situations with fog and "
      "compromised safety. RHE (redundant human engagement) has a value in all situations with "
      "clear air. Equal RHE: the {} fixed thresholds make a curve of mean SI over mean RHE. The "
      "curve is straight between neighbours, which are at most {:.1f} points of RHE apart. A rule "
      "is compared with the point of the curve that has its RHE. If several thresholds have this "
      "RHE, the best of them counts (all thresholds that the DoC never reaches in clear air have "
      "an RHE of 0). The curve can err at that point. For each of the two thresholds beside the "
      "point, we take the distance of its value from the straight line between its two neighbours. "
      "Let h be the difference of RHE between the two thresholds, and g that between one of them "
      "and its other neighbour. If h is larger than g, the distance of this threshold is "
      "multiplied by (g + h) / (2 g). If neither threshold has two neighbours, the difference of "
      "their values takes the place of the distance. The possible error is the larger of the two "
      "distances, times 4 s (1 - s). Here s is the place of the point between the two thresholds, "
      "from 0 to 1. So the error is 0 at a threshold and largest in the middle. A claim whose "
      "interval is not farther from 0 than this error does not hold. Intervals: {} resamples of "
      "the situations, each with its own curve. So the intervals take three things into account: "
      "rule and curve meet the same situations, the RHE of both is uncertain, and each resample "
      "chooses its own best threshold. SI is a mean of ratios of small numbers, so compromised "
      "safety in metres is beside it. The tables \"Both humans\" and the file threshold-humans.csv "
      "have some of the rules. There, either the perfect or the fallible human drives in all "
      "situations, in place of the drawn human. {} These situations run with the drawn radars, and "
      "again with a realistic radar in all of them. {}",
      mixed.situations, MixText(), beside.fixed, widest, kReplicates, HumansText(),
      RealisticNoiseText());
}

}  // namespace

StudyResult RunThresholdStudy(const StudyContext& context) {
  const std::int64_t situations = context.seeds.count();
  const std::int64_t units = (1 + kHumanMixes) * situations;
  const MixedRuns mixed =
      RunMix(context.Part(0, units), RuleFamilies(), MixedHuman::kDrawn, MixedRadar::kDrawn);
  const std::vector<HumanMix> humans = RunBothHumans(context.Part(situations, units));
  const Beside beside = BesideFixed(mixed);
  StudyResult result;
  result.runs = RunsOf(mixed);
  for (const HumanMix& mix : humans) result.runs += RunsOf(mix.runs);
  report::StudySection& section = result.section;
  section.answer = kThresholdAnswer;
  section.would_change = kThresholdWouldChange;
  result.claims = ThresholdClaims(mixed, beside);
  for (Claim& claim : ClaimsOnHumans(humans)) result.claims.push_back(std::move(claim));
  section.figures = {
      DifferenceFigure(mixed, beside),
      FrontFigure(mixed, "threshold-front", "The price of safety in a mix of situations",
                  "Safety improvement (SI, %)", &RuleMember::si_pct),
      FrontFigure(mixed, "threshold-cs", "The same in metres", "Mean compromised safety in fog (m)",
                  &RuleMember::shortfall_m)};
  std::vector<std::size_t> all(mixed.members.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<std::size_t> telling;
  for (const std::string_view name : kTelling) telling.push_back(RuleNamed(mixed, name));
  section.tables = {TableOfHumans(humans, MixedRadar::kDrawn),
                    TableOfHumans(humans, MixedRadar::kRealistic),
                    TableOfRules(mixed, beside, "Some rules", telling),
                    TableOfRules(mixed, beside, "Every rule", all)};
  section.method = ThresholdMethod(mixed, beside);
  result.files = {{"threshold.csv", ThresholdCsv(mixed, beside)},
                  {"threshold-humans.csv", HumansCsv(humans)}};
  return result;
}

}  // namespace fogline::study
