// Study `driver`: humans with imperfect perception and judgement.
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/report/metric_text.h"
#include "tools/study/case_findings.h"
#include "tools/study/comparison.h"
#include "tools/study/study.h"
#include "tools/study/study_findings.h"

namespace fogline::study {
namespace {

constexpr std::array kVisibilities_m{200.0, 120.0, 80.0, 60.0, 45.0, 35.0, 25.0};

const std::vector<std::string> kSeesFog{"/human/sight=fog"};
const std::vector<std::string> kWholeHuman{"/human/sight=fog", "/human/misjudges=true",
                                           "/human/loses_awareness=true"};

/// Kinds of drivers in the fog of dense_fog.json.
std::vector<StudyCase> Kinds() {
  return {{"paper's driver", "dense_fog.json", {}},
          {"IIDM", "dense_fog.json", {"/human/following=iidm"}},
          {"ACC-IDM", "dense_fog.json", {"/human/following=acc_idm"}},
          {"sees fog", "dense_fog.json", kSeesFog},
          {"misjudges", "dense_fog.json", {"/human/misjudges=true"}},
          {"loses awareness",
           "dense_fog.json",
           {"/human/misjudges=true", "/human/loses_awareness=true"}},
          {"all of it", "dense_fog.json", kWholeHuman}};
}

/// The paper's driver and a complete human model in fog of every density: pairs of cases that
/// follow Kinds().
std::vector<StudyCase> Densities() {
  std::vector<StudyCase> cases;
  for (const double visibility_m : kVisibilities_m) {
    std::vector<std::string> overrides{fmt::format("/fog/visibility_m={}", visibility_m)};
    cases.push_back(
        {fmt::format("paper's driver at {:g} m", visibility_m), "dense_fog.json", overrides});
    overrides.insert(overrides.end(), kWholeHuman.begin(), kWholeHuman.end());
    cases.push_back({fmt::format("human at {:g} m", visibility_m), "dense_fog.json", overrides});
  }
  return cases;
}

constexpr std::array<std::string_view, 8> kTableMeasures{"si_pct",
                                                         "mean_compromised_safety_fog_m",
                                                         "collided",
                                                         "min_host_gap_m",
                                                         "min_host_ttc_s",
                                                         "max_host_drac_mps2",
                                                         "max_abs_jerk_mps3",
                                                         "min_follower_ttc_s"};

/// A measure as a function of the visibility: without traded control, and with each of the two
/// drivers.
report::StudyFigure OverVisibility(const Comparison& comparison, std::string_view measure,
                                   std::string id, std::string title) {
  report::StudyFigure figure{
      .id = std::move(id),
      .title = std::move(title),
      .caption = "Means over the seeds with their 95 % confidence intervals.",
      .x_label = "Visibility (m)",
      .y_label = NameForReaders(measure),
      .log_x = true,
      .log_y = report::IsTimeToCollision(measure)};
  const std::size_t first = Kinds().size();
  for (const auto& [name, driver, variant] :
       {std::tuple("without traded control", 0U, 0U), std::tuple("paper's driver", 0U, 1U),
        std::tuple("human", 1U, 1U)}) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = name;
    for (std::size_t i = kVisibilities_m.size(); i-- > 0;) {
      const Cell cell{first + 2 * i + driver, variant};
      Estimate mean = comparison.Mean(cell, measure);
      if (measure == "collided") {
        const metrics::EventShare share = comparison.Collisions(cell);
        mean.low = share.lower;
        mean.high = share.upper;
      }
      series.x.push_back(kVisibilities_m[i]);
      series.y.push_back(mean.mean);
      series.low.push_back(mean.low);
      series.high.push_back(mean.high);
    }
  }
  return figure;
}

/// Lists the visibilities at which the complete human model is worse than the paper's driver, and
/// worse than no traded control.
std::string FindingOfDensity(const Comparison& comparison) {
  std::vector<std::string> worse_than_paper;
  std::vector<std::string> worse_than_none;
  std::vector<std::string> cut_short;
  const std::size_t first = Kinds().size();
  constexpr std::string_view kShortfall = "mean_compromised_safety_fog_m";
  for (std::size_t i = 0; i < kVisibilities_m.size(); ++i) {
    const Cell paper{first + 2 * i, 1};
    const Cell human{first + 2 * i + 1, 1};
    const Cell none{first + 2 * i + 1, 0};
    const std::string name = fmt::format("{:g} m", kVisibilities_m[i]);
    if (comparison.PairsCutShort(human, paper) + comparison.PairsCutShort(human, none) > 0) {
      cut_short.push_back(name);
      continue;
    }
    if (VerdictOf(comparison.Difference(human, paper, kShortfall)) == Verdict::kMore) {
      worse_than_paper.push_back(name);
    }
    if (VerdictOf(comparison.Difference(human, none, kShortfall)) == Verdict::kMore) {
      worse_than_none.push_back(name);
    }
  }
  const auto list = [](const std::vector<std::string>& names) {
    return names.empty() ? std::string("at no visibility") : fmt::format("at {}", ListText(names));
  };
  return fmt::format(
      "Over the density of the fog, a human with imperfect sight and judgement leaves more "
      "compromised safety than the paper's driver {}. It leaves more than runs without traded "
      "control {}.{}",
      list(worse_than_paper), list(worse_than_none),
      cut_short.empty()
          ? ""
          : fmt::format(" Runs end early, so they are not compared, {}.", list(cut_short)));
}

}  // namespace

StudyResult RunDriverStudy(const StudyContext& context) {
  std::vector<StudyCase> cases = Kinds();
  const std::size_t kinds = cases.size();
  for (StudyCase& one : Densities()) cases.push_back(std::move(one));
  const Comparison comparison(
      context, cases,
      {{"none", {"/arbitrator/policy=none"}}, {"traded", {"/arbitrator/policy=traded"}}});
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  section.findings = CaseFindings(comparison, 1);
  section.findings.resize(1 + kinds);  // one finding is for the densities
  section.findings.push_back(FindingOfDensity(comparison));
  section.figures = {
      OverVisibility(comparison, "mean_compromised_safety_fog_m", "driver-cs-visibility",
                     "Compromised safety over the density of the fog (m)"),
      OverVisibility(comparison, "collided", "driver-collisions-visibility",
                     "Collisions over the density of the fog"),
      OverVisibility(comparison, "min_host_ttc_s", "driver-ttc-visibility",
                     "The host's smallest time to collision over the density of the fog (s)"),
      OverVisibility(comparison, "max_abs_jerk_mps3", "driver-jerk-visibility",
                     "Largest jerk over the density of the fog (m/s3)")};
  section.tables = {comparison.TableOfVariant(0, kTableMeasures),
                    comparison.TableOfVariant(1, kTableMeasures)};
  section.method = fmt::format(
      "{} seeds of dense_fog.json with other human drivers of the host, without and with traded "
      "control; sight, errors and awareness with their defaults. Without traded control the driver "
      "has no effect, so at equal visibility this run is the same for all drivers.",
      comparison.seeds());
  result.files = {{"driver.csv", comparison.Csv(0)}};
  return result;
}

}  // namespace fogline::study
