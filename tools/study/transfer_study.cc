// Study `transfer`: ways to hand over the control of the car.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tools/study/comparison.h"
#include "tools/study/study.h"
#include "tools/study/study_findings.h"

namespace fogline::study {
namespace {

/// Limit of ISO 15622 above 20 m/s for the jerk averaged over 1 s, and the limit of comfort: m/s3.
constexpr double kComfortableJerk_mps3 = 2.5;
/// The measure to which the limit belongs. The jerk of single steps grows as the step shrinks.
constexpr std::string_view kJerk = "max_handover_jerk_1s_mps3";
/// Largest tolerable loss of safety by a smooth transfer, points of SI.
constexpr double kTolerableLoss = 3;

std::vector<StudyVariant> Variants() {
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

constexpr std::array<std::string_view, 10> kTableMeasures{kJerk,
                                                          "max_handover_jerk_mps3",
                                                          "max_handover_jump_mps2",
                                                          "si_pct",
                                                          "rhe_pct",
                                                          "max_abs_jerk_1s_mps3",
                                                          "max_abs_jerk_mps3",
                                                          "rms_jerk_mps3",
                                                          "transfers_pmin",
                                                          "collided"};

double Greatest(std::span<const double> values) {
  double greatest = -1;
  for (const double value : values) {
    if (!std::isnan(value)) greatest = std::max(greatest, value);
  }
  return greatest;
}

/// Compares jerk and safety of one variant with those of the step.
std::string FindingOfVariant(const Comparison& comparison, std::size_t c, std::size_t v) {
  const Estimate jerk = comparison.Mean({c, v}, kJerk);
  if (jerk.n == 0) {
    return fmt::format("{} has no hand-over", comparison.variants()[v].name);
  }
  const metrics::EventShare comfortable = comparison.AtMost({c, v}, kJerk, kComfortableJerk_mps3);
  const Estimate si = comparison.Difference({c, v}, {c, 0}, "si_pct");
  return fmt::format("{} has {} m/s3 (at most {:g} in {} of {} runs, worst {}), and its SI is {}",
                     comparison.variants()[v].name, Text(jerk, 2), kComfortableJerk_mps3,
                     comfortable.events, comfortable.runs,
                     Text(Greatest(comparison.Values({c, v}, kJerk)), 2),
                     DifferenceText(si, "points", 2));
}

bool IsComfortable(const Comparison& comparison, Cell cell) {
  const double worst = Greatest(comparison.Values(cell, kJerk));
  return worst >= 0 && worst <= kComfortableJerk_mps3;
}

/// "0.31 [0.31, 0.32] m/s3, worst 0.40".
std::string JerkText(const Comparison& comparison, Cell cell) {
  const Estimate jerk = comparison.Mean(cell, kJerk);
  if (jerk.n == 0) return "no hand-over";
  return fmt::format("{} m/s3, worst {}", Text(jerk, 2),
                     Text(Greatest(comparison.Values(cell, kJerk)), 2));
}

/// Lists the cases in which the step leaves room for an improvement.
std::string FindingOfStep(const Comparison& comparison) {
  std::vector<std::string> matters;
  std::vector<std::string> enough;
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    const bool is_comfortable = IsComfortable(comparison, {c, 0});
    (is_comfortable ? enough : matters)
        .push_back(
            fmt::format("{} ({})", comparison.cases()[c].name, JerkText(comparison, {c, 0})));
  }
  std::string text = "Where does a smooth transfer matter? The plain step";
  if (!enough.empty()) {
    text += fmt::format(" already stays within {:g} m/s3 over 1 s in every run of {}",
                        kComfortableJerk_mps3, ListText(enough));
  }
  if (!enough.empty() && !matters.empty()) text += "; it";
  if (!matters.empty()) {
    text += fmt::format(" does not in {}, so jerk can be reduced there", ListText(matters));
  }
  return text + ".";
}

/// Lists the variants, including the step, that are comfortable in every run and lose no more
/// safety than is tolerable.
std::string VerdictText(const Comparison& comparison, std::size_t c) {
  std::vector<std::string> meet;
  std::vector<std::string> fail;
  for (std::size_t v = 0; v < comparison.variants().size(); ++v) {
    const Estimate si = comparison.Difference({c, v}, {c, 0}, "si_pct");
    const bool met = IsComfortable(comparison, {c, v}) && si.mean >= -kTolerableLoss;
    (met ? meet : fail).push_back(comparison.variants()[v].name);
  }
  std::string text = fmt::format(
      "At most {:g} m/s3 over 1 s in every run, and a mean loss of SI of at most {:g} points: ",
      kComfortableJerk_mps3, kTolerableLoss);
  text += meet.empty() ? "none" : ListText(meet);
  return text + (fail.empty() ? "." : fmt::format("; not {}.", ListText(fail)));
}

std::string FindingOf(const Comparison& comparison, std::size_t c) {
  const Estimate step = comparison.Mean({c, 0}, kJerk);
  std::string text = fmt::format(
      "{}: the paper's step has a largest jerk at a hand-over, averaged over 1 s, of {} m/s3 and "
      "an "
      "SI of {} %. Compared with it, ",
      comparison.cases()[c].name, Text(step, 2), Text(comparison.Mean({c, 0}, "si_pct"), 2));
  std::vector<std::string> parts;
  for (std::size_t v = 1; v < comparison.variants().size(); ++v) {
    parts.push_back(FindingOfVariant(comparison, c, v));
  }
  return fmt::format("{}{}. {}", text, fmt::join(parts, "; "), VerdictText(comparison, c));
}

}  // namespace

StudyResult RunTransferStudy(const StudyContext& context) {
  const Comparison comparison(
      context, {{"paper.json", "paper.json", {}}, {"dense_fog.json", "dense_fog.json", {}}},
      Variants());
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  section.findings.push_back(FindingOfStep(comparison));
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    section.findings.push_back(FindingOf(comparison, c));
    section.tables.push_back(comparison.TableOfCase(c, kTableMeasures));
  }
  section.figures = {
      comparison.FigureOf(kJerk, "transfer-jerk", "Jerk at hand-overs, averaged over 1 s"),
      comparison.FigureOf("si_pct", "transfer-si", "Cost in safety"),
      comparison.FigureOf("max_handover_jump_mps2", "transfer-jump",
                          "Jump of the command at hand-overs"),
      comparison.FigureOf("rms_jerk_mps3", "transfer-rms", "Comfort of the whole run")};
  section.method = fmt::format(
      "{} seeds of each scenario at threshold 0.5, profiles and gate with their defaults. The jerk "
      "of a hand-over is the largest one of the host's applied acceleration while the authorities "
      "change and for measures.handover_s after that (3 s by default). It is averaged over 1 s, as "
      "in "
      "ISO 15622, whose limit is {:g} m/s3 above 20 m/s. The jerk of single steps is beside it "
      "(max_handover_jerk_mps3): for a jump it is the jump divided by the step, so it depends on "
      "the "
      "length of a step. Differences are paired by seed.",
      comparison.seeds(), kComfortableJerk_mps3);
  result.files = {{"transfer.csv", comparison.Csv(0)}};
  return result;
}

}  // namespace fogline::study
