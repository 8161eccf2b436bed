// Study `followers`: who drives behind the host.
#include <array>

#include <fmt/format.h>

#include "tools/study/comparison.h"
#include "tools/study/findings.h"
#include "tools/study/study.h"

namespace fogline {
namespace {

struct Behind {
  std::string_view name;
  std::vector<std::string> overrides;
};

std::vector<Behind> Kinds() {
  const auto human = [](std::string_view style) {
    return std::vector<std::string>{"/followers/driver=human",
                                    fmt::format("/followers/style={}", style)};
  };
  const auto careful = [&](std::string_view model) {
    std::vector<std::string> overrides = human("normal");
    overrides.push_back(fmt::format("/followers/safety_model={}", model));
    return overrides;
  };
  return {{"acc", {}},
          {"aggressive human", human("aggressive")},
          {"normal human", human("normal")},
          {"cautious human", human("cautious")},
          {"normal human with UN R157 reference", careful("reference_human")},
          {"normal human with RSS", careful("rss")},
          {"normal human with fuzzy model", careful("fuzzy")},
          {"five cars drawn",
           {"/followers/driver=drawn", "/followers/style=drawn", "/followers/count=5"}}};
}

std::vector<StudyCase> Cases() {
  std::vector<StudyCase> cases;
  for (const auto& [fog, file] :
       {std::pair("bias fog", "paper.json"), std::pair("beam fog", "dense_fog.json")}) {
    for (const Behind& kind : Kinds()) {
      cases.push_back({fmt::format("{}: {}", fog, kind.name), file, kind.overrides});
    }
  }
  return cases;
}

constexpr std::array<std::string_view, 8> kTableMeasures{"si_pct",
                                                         "mean_compromised_safety_fog_m",
                                                         "collided",
                                                         "min_follower_gap_m",
                                                         "min_follower_ttc_s",
                                                         "min_follower_headway_s",
                                                         "max_follower_drac_mps2",
                                                         "min_follower_rss_margin_m"};

}  // namespace

StudyResult RunFollowersStudy(const StudyContext& context) {
  const Comparison comparison(
      context, Cases(),
      {{"none", {"/arbitrator/policy=none"}}, {"traded", {"/arbitrator/policy=traded"}}});
  StudyResult result;
  result.runs = comparison.runs();
  StudySection& section = result.section;
  section.findings = CaseFindings(comparison, 1);
  section.figures = {comparison.FigureOf("mean_compromised_safety_fog_m", "followers-cs",
                                         "Compromised safety by follower", true),
                     comparison.FigureOf("max_follower_drac_mps2", "followers-drac",
                                         "How hard the follower has to brake", true),
                     comparison.FigureOf("min_follower_ttc_s", "followers-ttc",
                                         "Least time to collision of the follower", true),
                     comparison.FigureOf("collided", "followers-collisions", "Collisions", true)};
  section.tables = {comparison.TableOfVariant(0, kTableMeasures),
                    comparison.TableOfVariant(1, kTableMeasures)};
  section.method = fmt::format(
      "{} seeds of paper.json and dense_fog.json with other drivers behind the host, without and "
      "with traded control at the scenario's threshold. Gaps at step 0 are those of the ACC: "
      "another driver has until the fog begins to find his own. Measures are those of the first "
      "car behind the host; collisions are those of any car.",
      comparison.seeds());
  result.files = {{"followers.csv", comparison.Csv(0)}};
  return result;
}

}  // namespace fogline
