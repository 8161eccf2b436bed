// Study `policy`: compares hand-over with other policies.
#include <array>
#include <utility>

#include <fmt/format.h>

#include "services/decision/policies/policies.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/engagement/calibrated_radar.h"
#include "tools/study/engagement/fog_modes.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

/// The rules that the study compares. A rule is a policy, or a policy with other parameters of the
/// arbitrator or of the fusion. The first rules are the policies of policies::Policies(). The
/// further rules are: fusion that handles wrong sensors without a human, hand-back by the fusion,
/// and a driver who must be asked to take over.
std::vector<StudyVariant> EveryRule() {
  std::vector<StudyVariant> variants;
  for (const policies::PolicyRow& row : policies::Policies()) {
    variants.push_back({std::string(row.name), {fmt::format("/arbitrator/policy={}", row.name)}});
  }
  const auto add = [&](std::string_view name, std::string_view policy,
                       std::vector<std::string> overrides) {
    overrides.push_back(fmt::format("/arbitrator/policy={}", policy));
    variants.push_back({std::string(name), std::move(overrides)});
  };
  add("none + gate", "none", {"/fusion/gating=true", "/fusion/gate_reopen_after=0"});
  add("none + reopening gate", "none", {"/fusion/gating=true"});
  add("none + adaptive noise", "none", {"/fusion/adaptive_noise=residual"});
  add("traded + hand-back by fusion", "traded", {"/arbitrator/transfer/hand_back=fusion"});
  add("request + isolate", "traded_isolating", {"/arbitrator/take_over/mode=requested"});
  return variants;
}

constexpr std::string_view kCalibratedRadar = "calibrated radar";

/// Each fog with each human, once with the scenario's noise and once with the noise of a real
/// radar. The last cases have the paper's fog and a calibrated radar: the mounting offset of the
/// radar is 0, and the centre of the DoC is smaller by the scenario's offset.
std::vector<StudyCase> PolicyFogs(const Scenario& paper) {
  std::vector<StudyCase> cases;
  for (const FogMode& fog : FogModes()) {
    for (const auto& [human, overrides] : BothHumans()) {
      cases.push_back(fog.Case(human, overrides));
      cases.push_back(WithRealisticNoise(cases.back()));
    }
  }
  for (const auto& [human, overrides] : BothHumans()) {
    std::vector<std::string> calibrated = overrides;
    for (std::string& one : CalibratedRadar(paper)) calibrated.push_back(std::move(one));
    cases.push_back(
        FogModes()[0].Case(fmt::format("{} with {}", human, kCalibratedRadar), calibrated));
  }
  return cases;
}

constexpr std::array<std::string_view, 14> kPolicyTable{"si_pct",
                                                        "si_until_recovery_pct",
                                                        "rhe_pct",
                                                        "collided",
                                                        "mean_compromised_safety_fog_m",
                                                        "mean_compromised_safety_until_recovery_m",
                                                        "min_host_gap_m",
                                                        "min_host_ttc_s",
                                                        "min_follower_ttc_s",
                                                        "max_follower_drac_mps2",
                                                        "max_abs_jerk_1s_mps3",
                                                        "transfers_pmin",
                                                        "wrong_human_s",
                                                        "wrong_automation_s"};

/// The rules (EveryRule()) in the first table (PolicyMainTable()).
constexpr std::array<std::string_view, 10> kMain{"none",
                                                 "none + gate",
                                                 "none + adaptive noise",
                                                 "isolate",
                                                 "traded",
                                                 "traded + hand-back by fusion",
                                                 "request + isolate",
                                                 "blend",
                                                 "adaptive",
                                                 "oracle"};

/// The cases of the first table: each fog with each human.
std::vector<std::string> MainCases() {
  std::vector<std::string> names;
  for (const FogMode& fog : FogModes()) {
    for (const std::string_view human : {kPerfectHuman, kFallibleHuman}) {
      names.push_back(fog.Case(human).name);
    }
  }
  return names;
}

/// A figure of a measure. The rules (EveryRule()) are on the x axis, and each case is a series. At
/// first the page shows only the series of MainCases().
report::StudyFigure ByRule(const Comparison& comparison, std::string_view measure, std::string id,
                           std::string title) {
  report::StudyFigure figure = comparison.FigureOf(measure, std::move(id), std::move(title));
  const std::vector<std::string> main = MainCases();
  for (report::StudySeries& series : figure.series) {
    series.shown = std::ranges::find(main, series.name) != main.end();
  }
  return figure;
}

/// The first table: mean compromised safety, with a row for each rule of kMain and a column for
/// each of MainCases().
report::StudyTable PolicyMainTable(const Comparison& comparison) {
  report::StudyTable table{
      .caption = fmt::format("Mean compromised safety in fog (m), means over {} seeds [95 % "
                             "confidence intervals]",
                             comparison.seeds()),
      .columns = {"rule"}};
  std::vector<std::size_t> cases;
  for (const std::string& name : MainCases()) {
    table.columns.push_back(name);
    cases.push_back(comparison.CaseNamed(name));
  }
  for (const std::string_view rule : kMain) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.emplace_back(rule);
    for (const std::size_t c : cases) {
      row.push_back(Text(comparison.Mean({c, comparison.VariantNamed(rule)}, kShortfall)));
    }
  }
  return table;
}

constexpr std::string_view kPolicyAnswer =
    "It depends on how the LiDAR fails: with a small bias, handing over at once to a perfect human "
    "is safer than each automation of this study, except an automation that uses the right sensor "
    "and has a calibrated radar. With a false echo a filter whose gate stays shut is safer than "
    "each rule that hands over, and without any echo the automation alone is safer than these "
    "rules. With other parameters (study ensemble), traded control stays safer than the automation "
    "alone in bias fog, and less safe than the gate with a false echo; but with a false echo some "
    "other rules become safer than the gate, and without an echo handing over becomes safer than "
    "the automation alone.";
constexpr std::string_view kPolicyWouldChange =
    "A driver who needs time (study takeover), a calibrated radar, a filter that knows the fog, or "
    "a LiDAR that fails in another way.";

std::vector<PlannedClaim> PolicyClaims() {
  const std::string bias = FogModes()[0].Case(kPerfectHuman).name;
  const std::string bias_fallible = FogModes()[0].Case(kFallibleHuman).name;
  const std::string near = FogModes()[1].Case(kPerfectHuman).name;
  const std::string missing = FogModes()[2].Case(kPerfectHuman).name;
  const auto less = [](std::string says, std::string_view fog, std::string_view a,
                       std::string_view b, std::string_view measure = kShortfall) {
    return PairClaim(std::move(says), {fog, a}, {fog, b}, measure, Sign::kLess);
  };
  std::vector<PlannedClaim> claims;
  for (const std::string_view rule :
       {"none", "isolate", "none + gate", "none + reopening gate", "none + adaptive noise"}) {
    claims.push_back(less(fmt::format("In bias fog traded control is safer than: {}.", rule), bias,
                          "traded", rule));
  }
  claims.push_back(less("In bias fog shared control is safer still.", bias, "blend", "traded"));
  claims.push_back(
      less("In bias fog with a fallible human the automation alone is safer than traded control.",
           bias_fallible, "none", "traded"));
  const std::string calibrated =
      FogModes()[0].Case(fmt::format("{} with {}", kPerfectHuman, kCalibratedRadar)).name;
  claims.push_back(
      less("With a calibrated radar an automation on the right sensor (oracle) is safer than "
           "shared control.",
           calibrated, "oracle", "blend"));
  claims.push_back(
      less("With a calibrated radar an automation on the right sensor (oracle) is safer than "
           "traded control.",
           calibrated, "oracle", "traded"));
  claims.push_back(
      less("With a false echo traded control is safer than none.", near, "traded", "none"));
  for (const std::string_view rule :
       {"traded", "traded_isolating", "traded + hand-back by fusion", "request + isolate", "blend",
        "adaptive", "bayes", "availability"}) {
    claims.push_back(
        less(fmt::format("With a false echo a gate without a human is safer than: {}.", rule), near,
             "none + gate", rule));
  }
  claims.push_back(less("With a false echo a gate that reopens early is worse than traded control.",
                        near, "traded", "none + reopening gate"));
  claims.push_back(less("With a false echo isolation is smoother than traded control.", near,
                        "isolate", "traded", "max_abs_jerk_mps3"));
  claims.push_back(less("With a missing echo the automation alone is safer than traded control.",
                        missing, "none", "traded"));
  const auto noisy = [](const FogMode& fog) {
    return WithRealisticNoise(fog.Case(kPerfectHuman)).name;
  };
  claims.push_back(less("With realistic noise in bias fog traded control is safer than none.",
                        noisy(FogModes()[0]), "traded", "none"));
  claims.push_back(
      less("With realistic noise and a false echo a gate without a human is safer than traded "
           "control.",
           noisy(FogModes()[1]), "none + gate", "traded"));
  claims.push_back(less(
      "With realistic noise and a missing echo the automation alone is safer than traded control.",
      noisy(FogModes()[2]), "none", "traded"));
  return claims;
}

}  // namespace

StudyDesign PolicyDesign(const Scenario& paper) {
  return {.cases = PolicyFogs(paper), .variants = EveryRule(), .claims = PolicyClaims()};
}

StudyResult RunPolicyStudy(const StudyContext& context) {
  const StudyDesign design = PolicyDesign(context.Load("paper.json", {}));
  const Comparison comparison(context, design.cases, design.variants);
  StudyResult result;
  result.runs = comparison.runs();
  result.claims = ClaimsOf(comparison, design.claims);
  report::StudySection& section = result.section;
  section.answer = kPolicyAnswer;
  section.would_change = kPolicyWouldChange;
  section.tables = {PolicyMainTable(comparison)};
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    section.tables.push_back(comparison.TableOfCase(c, kPolicyTable));
  }
  section.figures = {
      ByRule(comparison, kShortfall, "policy-cs", "Compromised safety by policy"),
      ByRule(comparison, "si_pct", "policy-si", "Safety improvement by policy"),
      ByRule(comparison, "collided", "policy-collisions", "Collisions by policy"),
      ByRule(comparison, "rhe_pct", "policy-rhe", "Redundant human engagement by policy"),
      ByRule(comparison, "max_abs_jerk_mps3", "policy-jerk", "Comfort by policy: largest jerk"),
      ByRule(comparison, "wrong_automation_s", "policy-wrong",
             "Driving time of the automation on a wrong track, by policy")};
  section.method = fmt::format(
      "{} seeds of {}, each with every policy at its default parameters. Five other rules are "
      "compared, too: a filter that refuses outliers and whose gate stays shut; such a filter "
      "whose gate reopens after five refusals; a filter that adapts its noise; traded control in "
      "which the automation drives again only when its track agrees with both sensors (hand-back "
      "by fusion); and a driver who must be asked, while the automation leaves out the sensor that "
      "is to blame. With realistic noise the hand-back by fusion hardly ever happens in bias fog, "
      "because the radar's offset of 0.946 m is nearly as large as the tolerance of this rule, 1 "
      "m. {} {} A calibrated radar has no mounting offset; the centre of the Degree of Conflict "
      "(DoC) is then smaller by this offset. SI (safety improvement) is the paper's measure; it "
      "compares a run with the run of the same seed without traded control. It is a mean of ratios "
      "of small numbers, so the first table has the compromised safety in metres. A policy that "
      "uses only the paper's radar drives with the error of its offset. The CSV file has all "
      "differences from traded control; {} of them have p-values, which are adjusted by Holm.",
      comparison.seeds(), FogModesText(), HumansText(), RealisticNoiseText(),
      comparison.Comparisons(comparison.VariantNamed("traded")));
  result.files = {{"policy.csv", comparison.Csv(comparison.VariantNamed("traded"))}};
  return result;
}

}  // namespace fogline::study
