#include "tools/study/thresholds/threshold_mix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "common/random.h"
#include "tools/stats/in_order.h"
#include "tools/study/paired_worker.h"
#include "tools/study/sensor_noise.h"

namespace fogline::study {
namespace {

// Random stream of the mix. Streams below 1000 belong to roles.
constexpr Stream kMix{1000};

/// Range of a distribution that is uniform in the value, or uniform in its logarithm.
struct Range {
  double least;
  double most;

  double Even(double u) const { return std::lerp(least, most, u); }
  double Log(double u) const { return least * std::pow(most / least, u); }
};

// The mix is our choice. Each range contains the value of paper.json. For kLeadAmplitude_mps this
// value is 0, because the leader of paper.json keeps its speed.
constexpr double kClearShare = 0.25;
constexpr Range kVisibility_m{40, 300};
constexpr Range kBias_m{0.03, 0.5};  // of the fog model `bias`; paper.json has 0.216
constexpr Range kMounting_m{0.7, 1.0};
constexpr Range kRadarStd_m{0.01, 0.1};
constexpr Range kLidarStd_m{0.01, 0.03};
// Half of the humans judge correctly and stay aware. The readiness of the others falls to a value
// in the range kMonitoring while the automation drives.
constexpr double kErringShare = 0.5;
constexpr Range kMonitoring{0.1, 1.0};
constexpr Range kLeadAmplitude_mps{0, 1.5};

/// Sets the fields that vary between situations.
Scenario Draw(Scenario scenario, std::int64_t seed, MixedHuman human, MixedRadar radar) {
  const Random random(seed, kMix);
  const auto u = [&](std::uint32_t index) { return random.Uniform2(0, index)[0]; };
  scenario.fog.model = u(0) < 0.5 ? FogModel::kBias : FogModel::kBeam;
  if (u(1) < kClearShare) scenario.fog.duration_s = 0;
  scenario.fog.visibility_m = kVisibility_m.Log(u(2));
  scenario.fog.bias_m = kBias_m.Log(u(3));
  scenario.radar.bias_m = kMounting_m.Even(u(4));
  if (radar == MixedRadar::kDrawn) scenario.radar.range_std_m = kRadarStd_m.Log(u(5));
  scenario.lidar.range_std_m = kLidarStd_m.Log(u(6));
  scenario.human.awareness.monitoring = kMonitoring.Even(u(7));
  const bool errs =
      human == MixedHuman::kDrawn ? u(9) < kErringShare : human == MixedHuman::kFallible;
  scenario.human.misjudges = scenario.human.loses_awareness = errs;
  scenario.human.sight = human == MixedHuman::kPerfect ? Sight::kPerfect : Sight::kFog;
  scenario.lead.sinusoid.amplitude_mps = kLeadAmplitude_mps.Even(u(8));
  scenario.seed = seed;
  return scenario;
}

const std::vector<std::string> kMixed{
    "/lead/profile=sinusoid", "/followers/driver=drawn", "/followers/style=drawn",
    "/arbitrator/missing_lidar=conflict", "/arbitrator/adaptive/most=1"};

RuleFamily FamilyOf(std::string name, std::string_view policy, std::string_view pointer,
                    std::span<const double> values) {
  RuleFamily family{.name = std::move(name),
                    .values = std::vector<double>(values.begin(), values.end()),
                    .members = {}};
  for (const double value : values) {
    family.members.push_back(
        {fmt::format("{} {:g}", family.name, value),
         {fmt::format("/arbitrator/policy={}", policy), fmt::format("{}={:g}", pointer, value)}});
  }
  return family;
}

std::vector<Scenario> BasesOf(const StudyContext& context, const MixedRuns& mixed, MixedRadar radar,
                              std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), kMixed.begin(), kMixed.end());
  if (radar == MixedRadar::kRealistic) {
    overrides.insert(overrides.end(), RealisticNoise().begin(), RealisticNoise().end());
  }
  std::vector<Scenario> bases;
  bases.push_back(context.Load("paper.json", overrides, {std::string(kWithoutTradedControl)}));
  for (const RuleFamily& family : mixed.families) {
    for (const StudyVariant& member : family.members) {
      bases.push_back(context.Load("paper.json", overrides, member.overrides));
    }
  }
  return bases;
}

void AddToMember(const RunValues& run, RuleMember& member) {
  member.si_pct.push_back(run[PlaceOfMetric("si_pct")]);
  member.rhe_pct.push_back(run[PlaceOfMetric("rhe_pct")]);
  member.shortfall_m.push_back(run[PlaceOfMetric(kShortfall)]);
  member.collisions += run[PlaceOfMetric("collided")] > 0 ? 1 : 0;
}

}  // namespace

std::vector<RuleFamily> RuleFamilies() {
  // The grid of fixed thresholds is dense, because the other families are compared with values that
  // are interpolated between two points of this grid. The grid is densest where the RHE falls
  // fastest.
  std::vector<double> fixed;
  for (int permille = 10; permille < 1000; permille += permille < 200 ? 5 : 10) {
    fixed.push_back(permille / 1000.0);
  }
  constexpr std::array kBases{0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.7, 0.8, 0.9, 0.98};
  constexpr std::array kCosts{0.125, 0.25, 0.5, 0.7, 1.0, 1.4, 2.0, 4.0};
  return {FamilyOf("fixed", "traded", "/arbitrator/threshold", fixed),
          FamilyOf("adaptive", "adaptive", "/arbitrator/threshold", kBases),
          FamilyOf("bayes", "bayes", "/arbitrator/bayes/human_cost", kCosts),
          FamilyOf("availability", "availability", "/arbitrator/threshold", kBases)};
}

std::vector<RuleFamily> RulesNamed(std::span<const std::string_view> names) {
  std::vector<RuleFamily> some;
  for (const RuleFamily& family : RuleFamilies()) {
    RuleFamily of_family{.name = family.name, .values = {}, .members = {}};
    for (std::size_t i = 0; i < family.members.size(); ++i) {
      if (std::ranges::count(names, family.members[i].name) == 0) continue;
      of_family.values.push_back(family.values[i]);
      of_family.members.push_back(family.members[i]);
    }
    if (!of_family.members.empty()) some.push_back(std::move(of_family));
  }
  return some;
}

MixedRuns RunMix(const StudyContext& context, std::vector<RuleFamily> families, MixedHuman human,
                 MixedRadar radar, std::vector<std::string> overrides) {
  MixedRuns mixed{
      .families = std::move(families), .members = {}, .situations = context.seeds.count()};
  for (std::size_t f = 0; f < mixed.families.size(); ++f) {
    for (const StudyVariant& member : mixed.families[f].members) {
      mixed.members.push_back({.family = f, .name = member.name});
    }
  }
  const std::vector<Scenario> bases = BasesOf(context, mixed, radar, std::move(overrides));
  stats::ComputeInOrder(
      0, mixed.situations, context.jobs, [] { return PairedWorker(); },
      [&](PairedWorker& worker, std::int64_t unit) {
        const std::int64_t seed = context.seeds.first + unit;
        std::vector<Scenario> scenarios;
        for (const Scenario& base : bases) scenarios.push_back(Draw(base, seed, human, radar));
        return worker.Compute(scenarios, seed);
      },
      [&](std::int64_t unit, const std::vector<RunValues>& runs) {
        for (std::size_t m = 0; m < runs.size(); ++m) AddToMember(runs[m], mixed.members[m]);
        context.Show(unit + 1, mixed.situations);
        return true;
      });
  return mixed;
}

std::string MixText() {
  return fmt::format(
      "They are drawn at random, and are the same for every rule. Each is paper.json with a leader "
      "whose speed varies by up to {:g} m/s. About {:g} % are in clear air; the others have fog of "
      "one of the two models, bias or beam (visibility {:g} to {:g} m, bias {:g} to {:g} m). The "
      "radar's mounting offset is {:g} to {:g} m, its noise {:g} to {:g} m, and the LiDAR's noise "
      "{:g} to {:g} m. The human sees only as far as the fog allows. In about {:g} % of the "
      "situations the human also misjudges distances and loses awareness; while the automation "
      "drives, the awareness falls towards a drawn value between {:g} and {:g}. Kind and style of "
      "the follower are drawn, too.",
      kLeadAmplitude_mps.most, 100 * kClearShare, kVisibility_m.least, kVisibility_m.most,
      kBias_m.least, kBias_m.most, kMounting_m.least, kMounting_m.most, kRadarStd_m.least,
      kRadarStd_m.most, kLidarStd_m.least, kLidarStd_m.most, 100 * kErringShare, kMonitoring.least,
      kMonitoring.most);
}

}  // namespace fogline::study
