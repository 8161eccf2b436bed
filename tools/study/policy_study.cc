// Study `policy`: compares hand-over with other policies.
#include <array>

#include <fmt/format.h>

#include "services/decision/policies/policies.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

constexpr std::string_view kBias = "bias fog";
constexpr std::string_view kCalibrated = "bias fog with calibrated radar";
constexpr std::string_view kBeam = "beam fog";

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
  return {{std::string(kBias), "paper.json", {}},
          {std::string(kCalibrated),
           "paper.json",
           {"/radar/bias_m=0", "/arbitrator/doc_centre_m=0.054", "/acc/standstill_m=4.4445"}},
          {std::string(kBeam), "dense_fog.json", {}}};
}

constexpr std::array<std::string_view, 10> kTableMeasures{"si_pct",
                                                          "rhe_pct",
                                                          "collided",
                                                          "mean_compromised_safety_fog_m",
                                                          "min_follower_ttc_s",
                                                          "max_follower_drac_mps2",
                                                          "max_abs_jerk_mps3",
                                                          "transfers_pmin",
                                                          "wrong_human_s",
                                                          "wrong_automation_s"};

constexpr std::string_view kAnswer =
    "It depends on how the LiDAR fails. If fog biases its range a little, handing over to a "
    "perfect "
    "human is safer than any automation that does not know the bias. If fog makes a false echo, an "
    "automation that ignores the deceived sensor is safer and smoother than handing over.";
constexpr std::string_view kWouldChange =
    "A driver who errs or needs time (studies driver and takeover), a filter that refuses "
    "outliers, "
    "or a LiDAR that fails in another way.";

std::vector<Claim> Claims(const Comparison& comparison) {
  constexpr std::string_view kShortfall = "mean_compromised_safety_fog_m";
  const auto less = [&](std::string says, std::string_view fog, std::string_view a,
                        std::string_view b, std::string_view measure) {
    return ClaimOf(comparison, std::move(says), {fog, a}, {fog, b}, measure, Sign::kLess);
  };
  return {
      less("In bias fog traded control is safer than none.", kBias, "traded", "none", kShortfall),
      less("There it is safer than isolation.", kBias, "traded", "isolate", kShortfall),
      less("There shared control is safer still.", kBias, "blend", "traded", kShortfall),
      ClaimOf(comparison, "There isolation is worse than none.", {kBias, "isolate"},
              {kBias, "none"}, kShortfall, Sign::kMore),
      less("With a calibrated radar, ignoring the deceived LiDAR at the right time is the safest.",
           kCalibrated, "oracle", "blend", kShortfall),
      less("In beam fog traded control is safer than none.", kBeam, "traded", "none", kShortfall),
      less("There isolation is safer than traded control.", kBeam, "isolate", "traded", kShortfall),
      less("There it is smoother, too.", kBeam, "isolate", "traded", "max_abs_jerk_mps3"),
  };
}

}  // namespace

StudyResult RunPolicyStudy(const StudyContext& context) {
  const Comparison comparison(context, Cases(), Variants());
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  section.answer = kAnswer;
  section.would_change = kWouldChange;
  result.claims = Claims(comparison);
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
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
                          "Driving time of a deceived automation, by policy")};
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
