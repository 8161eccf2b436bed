// Study `policy`: compares hand-over with other policies.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "services/decision/policies/policies.h"
#include "tools/study/comparison.h"
#include "tools/study/study.h"
#include "tools/study/study_findings.h"

namespace fogline::study {
namespace {

/// Every policy of the table.
std::vector<StudyVariant> Variants() {
  std::vector<StudyVariant> variants;
  for (const policies::PolicyRow& row : policies::Policies()) {
    variants.push_back({std::string(row.name), {fmt::format("/arbitrator/policy={}", row.name)}});
  }
  return variants;
}

/// Three fogs: the paper's; the paper's with a radar whose mounting offset is calibrated out and a
/// DoC that knows the offset; and fog as a physical model.
std::vector<StudyCase> Cases() {
  return {{"bias fog", "paper.json", {}},
          {"bias fog with calibrated radar",
           "paper.json",
           {"/radar/bias_m=0", "/arbitrator/doc_centre_m=0.054", "/acc/standstill_m=4.4445"}},
          {"beam fog", "dense_fog.json", {}}};
}

constexpr std::array<std::string_view, 12> kTableMeasures{
    "si_pct",
    "si_until_recovery_pct",
    "rhe_pct",
    "collided",
    "mean_compromised_safety_fog_m",
    "mean_compromised_safety_until_recovery_m",
    "min_follower_ttc_s",
    "max_follower_drac_mps2",
    "max_abs_jerk_mps3",
    "transfers_pmin",
    "wrong_human_s",
    "wrong_automation_s"};

/// The policies that can change the driver, by variant: all except those whose rule is
/// Rule::kNever.
std::vector<std::size_t> HandOvers() {
  std::vector<std::size_t> handovers;
  for (std::size_t v = 0; v < policies::Policies().size(); ++v) {
    if (policies::Policies()[v].rule != policies::Rule::kNever) handovers.push_back(v);
  }
  return handovers;
}

/// Compares every policy that hands over with `isolate`, which never does.
std::string AgainstIsolation(const Comparison& comparison, std::size_t test_case) {
  const std::vector<std::size_t> handovers = Distinct(comparison, test_case, HandOvers());
  const std::size_t isolate = comparison.VariantNamed("isolate");
  std::vector<std::string> lose;
  std::vector<std::string> win;
  for (const std::size_t v : handovers) {
    const Verdict verdict = VerdictOf(comparison.Difference({test_case, v}, {test_case, isolate},
                                                            "mean_compromised_safety_fog_m"));
    const std::string& name = comparison.variants()[v].name;
    if (verdict == Verdict::kMore) lose.push_back(name);
    if (verdict == Verdict::kLess) win.push_back(name);
  }
  std::string text;
  const auto verb = [](const std::vector<std::string>& names, std::string_view one,
                       std::string_view many) { return names.size() == 1 ? one : many; };
  if (!lose.empty()) {
    text += fmt::format("{} {} to isolate. ", Capital(ListText(lose)), verb(lose, "loses", "lose"));
  }
  if (!win.empty()) {
    text += fmt::format("{} {} isolate. ", Capital(ListText(win)), verb(win, "beats", "beat"));
  }
  if (lose.empty() && win.empty()) text += "No hand-over differs significantly from isolate. ";
  return text + fmt::format("Mean compromised safety in fog against isolate: {}.",
                            AgainstText(comparison, test_case, handovers, isolate,
                                        "mean_compromised_safety_fog_m", "m", 4));
}

std::string FindingOf(const Comparison& comparison, std::size_t c) {
  const std::vector<std::size_t> all = AllVariants(comparison);
  const std::string same = SameRunsText(comparison, c);
  const std::size_t none = comparison.VariantNamed("none");
  return fmt::format("{}: {}{}{} {} {} Largest jerk against none: {}. {}",
                     comparison.cases()[c].name, same, same.empty() ? "" : " ",
                     RankingText(comparison, c, "si_pct", 1, Better::kMore),
                     CollisionText(comparison, c), AgainstIsolation(comparison, c),
                     AgainstText(comparison, c, all, none, "max_abs_jerk_mps3", "m/s3", 2),
                     RankingText(comparison, c, "rhe_pct", 1, Better::kLess));
}

}  // namespace

StudyResult RunPolicyStudy(const StudyContext& context) {
  const Comparison comparison(context, Cases(), Variants());
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    section.findings.push_back(FindingOf(comparison, c));
    section.tables.push_back(comparison.TableOfCase(c, kTableMeasures));
  }
  section.figures = {
      comparison.FigureOf("si_pct", "policy-si", "Safety improvement by policy"),
      comparison.FigureOf("mean_compromised_safety_fog_m", "policy-cs",
                          "Compromised safety by policy"),
      comparison.FigureOf("collided", "policy-collisions", "Collisions by policy"),
      comparison.FigureOf("rhe_pct", "policy-rhe", "Redundant human engagement by policy"),
      comparison.FigureOf("max_abs_jerk_mps3", "policy-jerk", "Comfort by policy: largest jerk"),
      comparison.FigureOf("wrong_automation_s", "policy-wrong",
                          "Driving time of the automation on a wrong track, by policy")};
  section.method = fmt::format(
      "{} seeds of paper.json, of paper.json with a calibrated radar (without its mounting offset, "
      "which is subtracted from the centre of the DoC), and of dense_fog.json, each with every "
      "policy at its defaults. SI is the paper's, against the run without traded control of the "
      "same seed. It is computed until one of the two runs ends (a collision). SI is a mean of "
      "ratios of small numbers, so mean compromised safety is beside it. The paper's radar has an "
      "offset of 0.946 m, so a policy that uses only the radar drives with this error.",
      comparison.seeds());
  result.files = {{"policy.csv", comparison.Csv(comparison.VariantNamed("traded"))}};
  return result;
}

}  // namespace fogline::study
