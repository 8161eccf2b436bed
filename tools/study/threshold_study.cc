// Study `threshold`: thresholds that move with the situation beside every fixed one, in a mix of
// situations.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "services/runtime/random.h"
#include "tools/study/comparison.h"
#include "tools/study/findings.h"
#include "tools/study/paired_worker.h"
#include "tools/study/study.h"
#include "tools/sweep/in_order.h"
#include "tools/sweep/pareto.h"

namespace fogline {
namespace {

// The draws of the mix. Streams below 1000 are those of roles.
constexpr Stream kMix{1000};

/// What a situation is drawn from: even, or even in the logarithm.
struct Range {
  double least;
  double most;

  double Even(double u) const { return std::lerp(least, most, u); }
  double Log(double u) const { return least * std::pow(most / least, u); }
};

// The mix is our choice: from what the paper has to what is bad, in each respect.
constexpr double kClearShare = 0.25;
constexpr Range kVisibility_m{40, 300};
constexpr Range kBias_m{0.03, 0.5};  // of fog model bias; paper.json has 0.216
constexpr Range kMounting_m{0.7, 1.0};
constexpr Range kRadarStd_m{0.01, 0.1};
constexpr Range kLidarStd_m{0.01, 0.03};
// Half of the humans judge rightly and stay aware; the readiness of the others ends up here while
// the automation drives.
constexpr double kErringShare = 0.5;
constexpr Range kMonitoring{0.1, 1.0};
constexpr Range kLeadAmplitude_mps{0, 1.5};

constexpr std::string_view kShortfall = "mean_compromised_safety_fog_m";

/// Sets what varies from situation to situation.
Scenario Draw(Scenario scenario, std::int64_t seed) {
  const Random random(seed, kMix);
  const auto u = [&](std::uint32_t index) { return random.Uniform2(0, index)[0]; };
  scenario.fog.model = u(0) < 0.5 ? FogModel::kBias : FogModel::kBeam;
  if (u(1) < kClearShare) scenario.fog.duration_s = 0;
  scenario.fog.visibility_m = kVisibility_m.Log(u(2));
  scenario.fog.bias_m = kBias_m.Log(u(3));
  scenario.radar.bias_m = kMounting_m.Even(u(4));
  scenario.radar.range_std_m = kRadarStd_m.Log(u(5));
  scenario.lidar.range_std_m = kLidarStd_m.Log(u(6));
  scenario.human.awareness.monitoring = kMonitoring.Even(u(7));
  scenario.human.misjudges = scenario.human.loses_awareness = u(9) < kErringShare;
  scenario.lead.sinusoid.amplitude_mps = kLeadAmplitude_mps.Even(u(8));
  scenario.seed = seed;
  return scenario;
}

const std::vector<std::string> kMixed{"/lead/profile=sinusoid",
                                      "/human/sight=fog",
                                      "/followers/driver=drawn",
                                      "/followers/style=drawn",
                                      "/arbitrator/missing_lidar=conflict",
                                      "/arbitrator/adaptive/most=1"};

/// A rule with a parameter that trades engagement for safety.
struct Family {
  std::string name;
  std::vector<StudyVariant> members;
};

Family FamilyOf(std::string name, std::string_view policy, std::string_view pointer,
                std::span<const double> values) {
  Family family{.name = std::move(name), .members = {}};
  for (const double value : values) {
    family.members.push_back(
        {fmt::format("{} {:g}", family.name, value),
         {fmt::format("/arbitrator/policy={}", policy), fmt::format("{}={:g}", pointer, value)}});
  }
  return family;
}

std::vector<Family> Families() {
  std::vector<double> fixed;
  for (int percent = 2; percent < 100; percent += 4) fixed.push_back(percent / 100.0);
  constexpr std::array kBases{0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.98};
  constexpr std::array kCosts{0.125, 0.25, 0.5, 1.0, 2.0, 4.0};
  std::vector<Family> families{
      FamilyOf("fixed", "traded", "/arbitrator/threshold", fixed),
      FamilyOf("adaptive", "adaptive", "/arbitrator/threshold", kBases),
      FamilyOf("bayes", "bayes", "/arbitrator/bayes/human_cost", kCosts),
      FamilyOf("availability", "availability", "/arbitrator/threshold", kBases)};
  return families;
}

/// One member over all situations.
struct Member {
  std::size_t family;
  std::string name;
  std::vector<double> si_pct;
  std::vector<double> rhe_pct;
  std::vector<double> shortfall_m;
  std::int64_t collisions = 0;

  double si() const { return EstimateOf(si_pct).mean; }
  double rhe() const { return EstimateOf(rhe_pct).mean; }
};

struct Mixed {
  std::vector<Family> families;
  std::vector<Member> members;  // family by family
  std::int64_t situations = 0;
};

std::vector<Scenario> BasesOf(const StudyContext& context, const Mixed& mixed) {
  std::vector<Scenario> bases;
  std::vector<std::string> overrides = kMixed;
  overrides.emplace_back(kWithoutTradedControl);
  bases.push_back(context.Load("paper.json", overrides));
  for (const Family& family : mixed.families) {
    for (const StudyVariant& member : family.members) {
      overrides = kMixed;
      overrides.insert(overrides.end(), member.overrides.begin(), member.overrides.end());
      bases.push_back(context.Load("paper.json", overrides));
    }
  }
  return bases;
}

void Add(const RunValues& run, Member& member) {
  member.si_pct.push_back(run[PlaceOfMeasure("si_pct")]);
  member.rhe_pct.push_back(run[PlaceOfMeasure("rhe_pct")]);
  member.shortfall_m.push_back(run[PlaceOfMeasure(kShortfall)]);
  member.collisions += run[PlaceOfMeasure("collided")] > 0 ? 1 : 0;
}

Mixed RunMix(const StudyContext& context) {
  Mixed mixed{.families = Families(), .members = {}, .situations = context.seeds.count()};
  for (std::size_t f = 0; f < mixed.families.size(); ++f) {
    for (const StudyVariant& member : mixed.families[f].members) {
      mixed.members.push_back({.family = f, .name = member.name});
    }
  }
  const std::vector<Scenario> bases = BasesOf(context, mixed);
  ComputeInOrder(
      0, mixed.situations, context.jobs, [] { return PairedWorker(); },
      [&](PairedWorker& worker, std::int64_t unit) {
        const std::int64_t seed = context.seeds.first + unit;
        std::vector<Scenario> scenarios;
        for (const Scenario& base : bases) scenarios.push_back(Draw(base, seed));
        return worker.Compute(scenarios, seed);
      },
      [&](std::int64_t unit, const std::vector<RunValues>& runs) {
        for (std::size_t m = 0; m < runs.size(); ++m) Add(runs[m], mixed.members[m]);
        context.Show(unit + 1, mixed.situations);
        return true;
      });
  return mixed;
}

/// The fixed threshold with most SI among those with at most this RHE; nullptr if there is none.
const Member* BestFixed(const Mixed& mixed, double rhe_pct) {
  const Member* best = nullptr;
  for (const Member& member : mixed.members) {
    if (member.family != 0 || !(member.rhe() <= rhe_pct)) continue;
    if (best == nullptr || member.si() > best->si()) best = &member;
  }
  return best;
}

/// One member of a family beside the best fixed threshold at its RHE.
struct Beside {
  const Member* member;
  const Member* fixed;  // nullptr: no fixed threshold engages as little
  Estimate si;          // member - fixed, points
  Estimate shortfall;   // m
};

std::vector<Beside> BesideFixed(const Mixed& mixed, std::size_t family) {
  std::vector<Beside> all;
  for (const Member& member : mixed.members) {
    if (member.family != family) continue;
    Beside& one = all.emplace_back(Beside{
        .member = &member, .fixed = BestFixed(mixed, member.rhe()), .si = {}, .shortfall = {}});
    if (one.fixed == nullptr) continue;
    one.si = PairedDifference(member.si_pct, one.fixed->si_pct);
    one.shortfall = PairedDifference(member.shortfall_m, one.fixed->shortfall_m);
  }
  return all;
}

std::string FindingOf(const Mixed& mixed, std::size_t family) {
  std::vector<std::string> better;
  std::vector<std::string> worse;
  std::vector<std::string> undecided;
  std::vector<std::string> unmatched;
  for (const Beside& one : BesideFixed(mixed, family)) {
    if (one.fixed == nullptr) {
      unmatched.push_back(one.member->name);
      continue;
    }
    const std::string text = fmt::format("{} ({} points against {})", one.member->name,
                                         Text(one.si, 1), one.fixed->name);
    switch (VerdictOf(one.si)) {
      case Verdict::kMore:
        better.push_back(text);
        break;
      case Verdict::kLess:
        worse.push_back(text);
        break;
      case Verdict::kUndecided:
        undecided.push_back(text);
        break;
    }
  }
  const auto part = [](std::string_view what, const std::vector<std::string>& of) {
    return of.empty() ? std::string() : fmt::format(" {}: {}.", what, ListText(of));
  };
  return fmt::format("{} beside the best fixed threshold of at most its RHE, by SI.{}{}{}{}",
                     mixed.families[family].name, part("More", better), part("Less", worse),
                     part("Not to be told apart", undecided),
                     part("No fixed threshold engages as little as", unmatched));
}

/// Which families have members on the front of all.
std::string FrontText(const Mixed& mixed) {
  std::vector<TradeOff> points;
  for (const Member& member : mixed.members) points.push_back({member.rhe(), member.si()});
  std::vector<std::string> names;
  for (const std::size_t i : ParetoFront(points)) {
    const Member& member = mixed.members[i];
    names.push_back(fmt::format("{} (RHE {} %, SI {} %)", member.name, Text(member.rhe(), 1),
                                Text(member.si(), 1)));
  }
  return fmt::format(
      "The Pareto front of all rules in mean RHE and mean SI, from least engagement "
      "to most safety: {}.",
      ListText(names));
}

StudyFigure FrontFigure(const Mixed& mixed, std::string id, std::string title, std::string y_label,
                        std::vector<double> Member::*values) {
  StudyFigure figure{.id = std::move(id),
                     .title = std::move(title),
                     .caption =
                         "A point for each member of a family, with the 95 % confidence "
                         "band of its mean.",
                     .x_label = "Redundant human engagement (RHE, %)",
                     .y_label = std::move(y_label)};
  for (std::size_t f = 0; f < mixed.families.size(); ++f) {
    std::vector<std::pair<double, Estimate>> points;
    for (const Member& member : mixed.members) {
      if (member.family == f) points.emplace_back(member.rhe(), EstimateOf(member.*values));
    }
    std::stable_sort(points.begin(), points.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    StudySeries& series = figure.series.emplace_back();
    series.name = mixed.families[f].name;
    for (const auto& [rhe, mean] : points) {
      series.x.push_back(rhe);
      series.y.push_back(mean.mean);
      series.low.push_back(mean.low);
      series.high.push_back(mean.high);
    }
  }
  return figure;
}

std::string CsvNumber(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

std::string CsvOf(const Mixed& mixed) {
  std::string csv =
      "family,member,situations,rhe_n,rhe_pct,rhe_ci95_low,rhe_ci95_high,si_n,si_pct,si_ci95_low,"
      "si_ci95_high,compromised_n,compromised_safety_fog_m,compromised_ci95_low,"
      "compromised_ci95_high,collisions,best_fixed,si_minus_fixed,si_minus_fixed_ci95_low,"
      "si_minus_fixed_ci95_high,compromised_minus_fixed,compromised_minus_fixed_ci95_low,"
      "compromised_minus_fixed_ci95_high\n";
  for (std::size_t f = 0; f < mixed.families.size(); ++f) {
    for (const Beside& one : BesideFixed(mixed, f)) {
      csv += fmt::format("{},{},{}", mixed.families[f].name, one.member->name, mixed.situations);
      for (const auto values : {&Member::rhe_pct, &Member::si_pct, &Member::shortfall_m}) {
        const Estimate mean = EstimateOf(one.member->*values);
        csv += fmt::format(",{},{},{},{}", mean.n, CsvNumber(mean.mean), CsvNumber(mean.low),
                           CsvNumber(mean.high));
      }
      csv += fmt::format(",{},{}", one.member->collisions, one.fixed ? one.fixed->name : "");
      for (const Estimate& difference : {one.si, one.shortfall}) {
        const bool there = one.fixed != nullptr;
        csv += fmt::format(",{},{},{}", there ? CsvNumber(difference.mean) : "",
                           there ? CsvNumber(difference.low) : "",
                           there ? CsvNumber(difference.high) : "");
      }
      csv += "\n";
    }
  }
  return csv;
}

StudyTable TableOf(const Mixed& mixed) {
  StudyTable table{
      .caption = "Every rule: means over the situations [95 % confidence intervals]",
      .columns = {"rule", "RHE (%)", "SI (%)", "compromised safety in fog (m)", "collisions"}};
  for (const Member& member : mixed.members) {
    table.rows.push_back({member.name, Text(EstimateOf(member.rhe_pct), 1),
                          Text(EstimateOf(member.si_pct), 1),
                          Text(EstimateOf(member.shortfall_m), 3),
                          Text(ClopperPearson(member.collisions, mixed.situations))});
  }
  return table;
}

std::string MethodOf(const Mixed& mixed) {
  return fmt::format(
      "{} situations, one for each seed, drawn alike for every rule: paper.json with a leader "
      "whose "
      "speed swings by up to {:g} m/s, {:g} % in clear air, else fog of either model (visibility "
      "{:g} to {:g} m, bias {:g} to {:g} m), mounting offset {:g} to {:g} m, radar noise {:g} to "
      "{:g} m, LiDAR noise {:g} to {:g} m; a human who sees the fog and in {:g} % misjudges and "
      "loses "
      "awareness (down to {:g} to {:g}), and a follower of drawn kind and style. SI has a "
      "value "
      "in situations with fog and compromised safety only; RHE in all with clear air. The fixed "
      "threshold that a rule is compared with was chosen in the same situations, which favours it. "
      "SI is a mean of ratios of small numbers: compromised safety in metres is beside it.",
      mixed.situations, kLeadAmplitude_mps.most, 100 * kClearShare, kVisibility_m.least,
      kVisibility_m.most, kBias_m.least, kBias_m.most, kMounting_m.least, kMounting_m.most,
      kRadarStd_m.least, kRadarStd_m.most, kLidarStd_m.least, kLidarStd_m.most, 100 * kErringShare,
      kMonitoring.least, kMonitoring.most);
}

}  // namespace

StudyResult RunThresholdStudy(const StudyContext& context) {
  const Mixed mixed = RunMix(context);
  StudyResult result;
  result.runs = mixed.situations * static_cast<std::int64_t>(mixed.members.size() + 1);
  StudySection& section = result.section;
  for (std::size_t f = 1; f < mixed.families.size(); ++f) {
    section.findings.push_back(FindingOf(mixed, f));
  }
  section.findings.push_back(FrontText(mixed));
  section.figures = {
      FrontFigure(mixed, "threshold-front", "The price of safety in a mix of situations",
                  "Safety improvement (SI, %)", &Member::si_pct),
      FrontFigure(mixed, "threshold-cs", "The same in metres", "Mean compromised safety in fog (m)",
                  &Member::shortfall_m)};
  section.tables = {TableOf(mixed)};
  section.method = MethodOf(mixed);
  result.files = {{"threshold.csv", CsvOf(mixed)}};
  return result;
}

}  // namespace fogline
