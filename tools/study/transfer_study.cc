// Study `transfer`: ways to hand over the control of the car.
#include <array>

#include <fmt/format.h>

#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

/// Limit of ISO 15622 for the jerk averaged over 1 s at speeds above 20 m/s. It also serves as the
/// limit of comfort. The unit is m/s3.
constexpr double kComfortableJerk_mps3 = 2.5;
/// The measure that kComfortableJerk_mps3 limits. It is not the jerk of single time steps, because
/// a shorter time step gives the same jump a larger jerk.
constexpr std::string_view kTransferJerk = "max_handover_jerk_1s_mps3";
/// A loss of safety that is too small to matter, in points of SI.
constexpr double kTolerableLoss = 3;

constexpr std::string_view kPaperFog = "bias fog";
constexpr std::string_view kDenseFog = "beam fog";
constexpr std::string_view kPaperFogNoisy = "bias fog with realistic noise";
constexpr std::string_view kDenseFogNoisy = "beam fog with realistic noise";

std::vector<StudyVariant> WaysToTransfer() {
  std::vector<StudyVariant> variants;
  for (const std::string_view profile : {"step", "linear", "sigmoid", "jerk_limited"}) {
    variants.push_back({std::string(profile),
                        {"/arbitrator/policy=traded", "/arbitrator/threshold=0.5",
                         fmt::format("/arbitrator/transfer/profile={}", profile)}});
  }
  variants.push_back({"gate",
                      {"/arbitrator/policy=traded", "/arbitrator/threshold=0.5",
                       "/arbitrator/transfer/gate=true"}});
  return variants;
}

constexpr std::array<std::string_view, 10> kTransferTable{kTransferJerk,
                                                          "max_handover_jerk_mps3",
                                                          "max_handover_jump_mps2",
                                                          "si_pct",
                                                          "rhe_pct",
                                                          "max_abs_jerk_1s_mps3",
                                                          "max_abs_jerk_mps3",
                                                          "rms_jerk_mps3",
                                                          "transfers_pmin",
                                                          "collided"};

constexpr std::string_view kTransferAnswer =
    "Hardly. Averaged over a second, as the standard for adaptive cruise control demands, the jerk "
    "of an immediate transfer (profile step) is comfortable in both scenarios. A ramp costs safety "
    "in the paper's scenario; in dense fog a gate, which limits acceleration and jerk of the "
    "command after a transfer, avoids jerk and costs no safety.";
constexpr std::string_view kTransferWouldChange =
    "A driver who needs time to take over (study takeover), a car whose engine smooths each "
    "command "
    "(study vehicle), or a limit for the jerk of a single step.";

std::vector<PlannedClaim> TransferClaims() {
  const CellName step{kPaperFog, "step"};
  const CellName step_in_dense_fog{kDenseFog, "step"};
  const CellName gate_in_dense_fog{kDenseFog, "gate"};
  return {
      LevelClaim("In the paper's scenario the step is comfortable.", step, kTransferJerk,
                 Sign::kLess, kComfortableJerk_mps3),
      LevelClaim("In dense fog the step is comfortable, too.", step_in_dense_fog, kTransferJerk,
                 Sign::kLess, kComfortableJerk_mps3),
      PairClaim("In the paper's scenario a linear ramp costs safety.", {kPaperFog, "linear"}, step,
                "si_pct", Sign::kLess),
      PairClaim("In the paper's scenario a sigmoid ramp costs safety.", {kPaperFog, "sigmoid"},
                step, "si_pct", Sign::kLess),
      PairClaim("In the paper's scenario a jerk limit costs no safety.",
                {kPaperFog, "jerk_limited"}, step, "si_pct", Sign::kEqual, kTolerableLoss),
      PairClaim("In dense fog the gate avoids jerk.", gate_in_dense_fog, step_in_dense_fog,
                kTransferJerk, Sign::kLess),
      PairClaim("In dense fog the gate costs no safety.", gate_in_dense_fog, step_in_dense_fog,
                "si_pct", Sign::kEqual, kTolerableLoss),
      LevelClaim("With realistic noise in the paper's scenario the step is comfortable.",
                 {kPaperFogNoisy, "step"}, kTransferJerk, Sign::kLess, kComfortableJerk_mps3),
      LevelClaim("With realistic noise in dense fog the step is comfortable.",
                 {kDenseFogNoisy, "step"}, kTransferJerk, Sign::kLess, kComfortableJerk_mps3),
      PairClaim("With realistic noise in the paper's scenario a linear ramp costs safety.",
                {kPaperFogNoisy, "linear"}, {kPaperFogNoisy, "step"}, "si_pct", Sign::kLess),
      PairClaim("With realistic noise in dense fog the gate avoids jerk.", {kDenseFogNoisy, "gate"},
                {kDenseFogNoisy, "step"}, kTransferJerk, Sign::kLess),
      PairClaim("With realistic noise in dense fog the gate costs no safety.",
                {kDenseFogNoisy, "gate"}, {kDenseFogNoisy, "step"}, "si_pct", Sign::kEqual,
                kTolerableLoss),
  };
}

}  // namespace

StudyDesign TransferDesign() {
  return {.cases = {{std::string(kPaperFog), "paper.json", {}},
                    {std::string(kDenseFog), "dense_fog.json", {}},
                    {std::string(kPaperFogNoisy), "paper.json", RealisticNoise()},
                    {std::string(kDenseFogNoisy), "dense_fog.json", RealisticNoise()}},
          .variants = WaysToTransfer(),
          .claims = TransferClaims()};
}

StudyResult RunTransferStudy(const StudyContext& context) {
  const StudyDesign design = TransferDesign();
  const Comparison comparison(context, design.cases, design.variants);
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  section.answer = kTransferAnswer;
  section.would_change = kTransferWouldChange;
  result.claims = ClaimsOf(comparison, design.claims);
  for (const std::string_view name : {kDenseFog, kPaperFog, kDenseFogNoisy, kPaperFogNoisy}) {
    section.tables.push_back(comparison.TableOfCase(comparison.CaseNamed(name), kTransferTable));
  }
  section.figures = {
      comparison.FigureOf(kTransferJerk, "transfer-jerk", "Jerk at hand-overs, averaged over 1 s"),
      comparison.FigureOf("si_pct", "transfer-si", "Cost in safety"),
      comparison.FigureOf("max_handover_jump_mps2", "transfer-jump",
                          "Jump of the command at hand-overs"),
      comparison.FigureOf("rms_jerk_mps3", "transfer-rms", "Comfort of the whole run")};
  section.method = fmt::format(
      "{} seeds of each scenario at threshold 0.5; profiles and gate have their default "
      "parameters. The jerk of a hand-over is the largest jerk of the host from the first step of "
      "a change of the authorities until measures.handover_s (3 s by default) after its last step. "
      "It is averaged over 1 s, as in ISO 15622, whose limit is {:g} m/s3 at speeds above 20 m/s. "
      "max_handover_jerk_mps3 is the jerk of single steps. For a jump of the acceleration, it is "
      "the jump divided by the length of the step, so it depends on this length. Differences are "
      "paired by seed. {}",
      comparison.seeds(), kComfortableJerk_mps3, RealisticNoiseText());
  result.files = {{"transfer.csv", comparison.Csv(0)}};
  return result;
}

}  // namespace fogline::study
