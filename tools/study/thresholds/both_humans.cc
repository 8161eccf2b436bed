#include "tools/study/thresholds/both_humans.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "tools/study/engagement/fog_modes.h"
#include "tools/study/sensor_noise.h"

namespace fogline::study {
namespace {

/// The rules that are repeated with each human and radar.
constexpr std::array<std::string_view, 7> kRepeated{"fixed 0.3",        "fixed 0.5",    "fixed 0.8",
                                                    "fixed 0.99",       "adaptive 0.5", "bayes 1",
                                                    "availability 0.98"};

constexpr std::array<std::pair<MixedHuman, MixedRadar>, kHumanMixes> kMixes{
    {{MixedHuman::kPerfect, MixedRadar::kDrawn},
     {MixedHuman::kFallible, MixedRadar::kDrawn},
     {MixedHuman::kPerfect, MixedRadar::kRealistic},
     {MixedHuman::kFallible, MixedRadar::kRealistic}}};

std::string_view HumanText(MixedHuman human) {
  return human == MixedHuman::kPerfect ? kPerfectHuman : kFallibleHuman;
}

}  // namespace

std::string HumanMix::Name() const {
  const std::string_view name = HumanText(human);
  return fmt::format("{}{}", name, radar == MixedRadar::kDrawn ? "" : kWithRealisticNoise);
}

std::vector<HumanMix> RunBothHumans(const StudyContext& context) {
  std::vector<HumanMix> mixes;
  const std::int64_t situations = context.seeds.count();
  for (const auto& [human, radar] : kMixes) {
    const auto before = static_cast<std::int64_t>(mixes.size()) * situations;
    const StudyContext part = context.Part(before, kHumanMixes * situations);
    mixes.push_back({human, radar, RunMix(part, RulesNamed(kRepeated), human, radar)});
  }
  return mixes;
}

report::StudyTable TableOfHumans(std::span<const HumanMix> mixes, MixedRadar radar) {
  report::StudyTable table{
      .caption = fmt::format("Both humans{}: means over the situations [95 % confidence intervals]",
                             radar == MixedRadar::kDrawn ? "" : kWithRealisticNoise),
      .columns = {"rule"}};
  for (const std::string_view rule : kRepeated) table.rows.push_back({std::string(rule)});
  for (const HumanMix& mix : mixes) {
    if (mix.radar != radar) continue;
    const std::string_view human = HumanText(mix.human);
    for (const std::string_view column :
         {"RHE (%)", "SI (%)", "compromised safety in fog (m)", "collisions"}) {
      table.columns.push_back(fmt::format("{}: {}", human, column));
    }
    for (std::vector<std::string>& row : table.rows) {
      const RuleMember& rule = mix.runs.members[RuleNamed(mix.runs, row[0])];
      row.push_back(Text(EstimateOf(rule.rhe_pct), 2));
      row.push_back(Text(EstimateOf(rule.si_pct), 1));
      row.push_back(Text(EstimateOf(rule.shortfall_m), 3));
      row.push_back(fmt::format("{} of {} runs", rule.collisions, mix.runs.situations));
    }
  }
  return table;
}

std::string HumansCsv(std::span<const HumanMix> mixes) {
  std::string csv =
      "mix,member,situations,rhe_n,rhe_pct,rhe_ci95_low,rhe_ci95_high,si_n,si_pct,si_ci95_low,"
      "si_ci95_high,compromised_n,compromised_safety_fog_m,compromised_ci95_low,"
      "compromised_ci95_high,collisions\n";
  for (const HumanMix& mix : mixes) {
    for (const RuleMember& member : mix.runs.members) {
      csv += fmt::format("{},{},{}", mix.Name(), member.name, mix.runs.situations);
      for (const auto values :
           {&RuleMember::rhe_pct, &RuleMember::si_pct, &RuleMember::shortfall_m}) {
        const Estimate mean = EstimateOf(member.*values);
        csv += fmt::format(",{},{}", mean.n, CsvText(mean));
      }
      csv += fmt::format(",{}\n", member.collisions);
    }
  }
  return csv;
}

Claim RuleClaim(const MixedRuns& runs, std::string_view of, std::string says, std::string_view a,
                std::string_view b, Sign sign, double margin) {
  return {.says = std::move(says),
          .compared = fmt::format("{}{}{} against {}, safety improvement (SI) (%)", of,
                                  of.empty() ? "" : ": ", a, b),
          .sign = sign,
          .difference = PairedDifference(runs.members[RuleNamed(runs, a)].si_pct,
                                         runs.members[RuleNamed(runs, b)].si_pct),
          .margin = margin,
          .p = {},
          .hindrance = {}};
}

std::vector<Claim> ClaimsOnFixed(const MixedRuns& runs, std::string_view of) {
  const auto& [low, papers, high] = kFixedRules;
  const auto claim = [&](std::string_view says, std::string_view a, std::string_view b) {
    std::string sentence = of.empty() ? std::string(says) : fmt::format("With a {}, {}", of, says);
    sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
    return RuleClaim(runs, of, std::move(sentence), a, b, Sign::kMore);
  };
  return {claim("hardly ever handing over is safer than the paper's threshold.", high, papers),
          claim("the paper's threshold is safer than a low one.", papers, low)};
}

std::size_t RuleNamed(const MixedRuns& runs, std::string_view name) {
  const auto found = std::ranges::find(runs.members, name, &RuleMember::name);
  if (found == runs.members.end()) throw std::out_of_range(fmt::format("no rule {}", name));
  return static_cast<std::size_t>(found - runs.members.begin());
}

}  // namespace fogline::study
