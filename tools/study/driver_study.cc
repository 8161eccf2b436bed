// Study `driver`: humans with imperfect perception and judgement.
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/report/metric_text.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

constexpr std::array kDensities_m{200.0, 120.0, 80.0, 60.0, 45.0, 35.0, 25.0};

constexpr std::string_view kPaperName = "paper's driver";
constexpr std::string_view kWholeName = "all weaknesses";
constexpr std::string_view kBiasName = "bias fog: paper's driver";
constexpr std::string_view kBiasMisjudgesName = "bias fog: misjudges";

const std::vector<std::string> kSeesFog{"/human/sight=fog"};
const std::vector<std::string> kWholeHuman{"/human/sight=fog", "/human/misjudges=true",
                                           "/human/loses_awareness=true"};

/// Kinds of drivers in the fog of dense_fog.json.
std::vector<StudyCase> HumanKinds() {
  return {{std::string(kPaperName), "dense_fog.json", {}},
          {"IIDM", "dense_fog.json", {"/human/following=iidm"}},
          {"ACC-IDM", "dense_fog.json", {"/human/following=acc_idm"}},
          {"sees fog", "dense_fog.json", kSeesFog},
          {"misjudges", "dense_fog.json", {"/human/misjudges=true"}},
          {"loses awareness",
           "dense_fog.json",
           {"/human/misjudges=true", "/human/loses_awareness=true"}},
          {std::string(kWholeName), "dense_fog.json", kWholeHuman}};
}

/// Two cases for each density of the fog: one with the paper's driver, and one with a driver who
/// has all weaknesses. In the study these cases follow the cases of HumanKinds().
std::vector<StudyCase> Densities() {
  std::vector<StudyCase> cases;
  for (const double visibility_m : kDensities_m) {
    std::vector<std::string> overrides{fmt::format("/fog/visibility_m={}", visibility_m)};
    cases.push_back(
        {fmt::format("paper's driver at {:g} m", visibility_m), "dense_fog.json", overrides});
    overrides.insert(overrides.end(), kWholeHuman.begin(), kWholeHuman.end());
    cases.push_back({fmt::format("human at {:g} m", visibility_m), "dense_fog.json", overrides});
  }
  return cases;
}

/// Two drivers in dense fog and two drivers in bias fog, with realistic noise.
std::vector<StudyCase> NoisyDrivers() {
  const std::vector<std::string> misjudges{"/human/misjudges=true"};
  std::vector<StudyCase> cases{{std::string(kPaperName), "dense_fog.json", {}},
                               {std::string(kWholeName), "dense_fog.json", kWholeHuman},
                               {std::string(kBiasName), "paper.json", {}},
                               {std::string(kBiasMisjudgesName), "paper.json", misjudges}};
  for (StudyCase& one : cases) one = WithRealisticNoise(std::move(one));
  return cases;
}

constexpr std::array<std::string_view, 8> kDriverTable{"si_pct",
                                                       "mean_compromised_safety_fog_m",
                                                       "collided",
                                                       "min_host_gap_m",
                                                       "min_host_ttc_s",
                                                       "max_host_drac_mps2",
                                                       "max_abs_jerk_mps3",
                                                       "min_follower_ttc_s"};

/// A figure of a measure as a function of the visibility. It has a series without traded control,
/// and a series for each of the two drivers of Densities() with traded control.
report::StudyFigure OverDensity(const Comparison& comparison, std::string_view measure,
                                std::string id, std::string title) {
  report::StudyFigure figure{
      .id = std::move(id),
      .title = std::move(title),
      .caption = "Means over the seeds with their 95 % confidence intervals.",
      .x_label = "Visibility (m)",
      .y_label = NameForReaders(measure),
      .log_x = true,
      .log_y = report::IsTimeToCollision(measure)};
  const std::size_t first = HumanKinds().size();
  for (const auto& [name, driver, variant] :
       {std::tuple("without traded control", 0U, 0U), std::tuple("paper's driver", 0U, 1U),
        std::tuple("human", 1U, 1U)}) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = name;
    for (std::size_t i = kDensities_m.size(); i-- > 0;) {
      const Cell cell{first + 2 * i + driver, variant};
      AddPoint(series, kDensities_m[i], comparison.Point(cell, measure));
    }
  }
  return figure;
}

constexpr std::string_view kDriverAnswer =
    "In dense fog traded control helps with every driver of this study, but an imperfect human "
    "leaves more danger than the paper's driver. In thin fog traded control makes no "
    "difference. In the paper's fog, whose effect is small, a human who misjudges distances does "
    "harm.";
constexpr std::string_view kDriverWouldChange =
    "A driver who needs time to take over (study takeover), or larger errors of the human.";

std::vector<PlannedClaim> DriverClaims() {
  // A tenth of a millimetre: far less than any difference that a driver could cause.
  constexpr double kNothing_m = 1e-4;
  std::vector<PlannedClaim> claims;
  for (const StudyCase& kind : HumanKinds()) {
    claims.push_back(PairClaim(fmt::format("In dense fog traded control helps: {}.", kind.name),
                               {kind.name, "traded"}, {kind.name, "none"}, kShortfall,
                               Sign::kLess));
  }
  claims.push_back(PairClaim("An imperfect human leaves more danger.", {kWholeName, "traded"},
                             {kPaperName, "traded"}, kShortfall, Sign::kMore));
  claims.push_back(PairClaim("In thin fog traded control makes no difference.",
                             {"human at 200 m", "traded"}, {"human at 200 m", "none"}, kShortfall,
                             Sign::kEqual, kNothing_m));
  claims.push_back(PairClaim("In the paper's fog the paper's driver helps.", {kBiasName, "traded"},
                             {kBiasName, "none"}, kShortfall, Sign::kLess));
  claims.push_back(PairClaim("In the paper's fog a human who misjudges does harm.",
                             {kBiasMisjudgesName, "traded"}, {kBiasMisjudgesName, "none"},
                             kShortfall, Sign::kMore));
  return claims;
}

/// The claims on runs with realistic noise. They support the study's answer.
std::vector<PlannedClaim> NoisyDriverClaims() {
  const auto noisy = [](std::string_view name) {
    return fmt::format("{}{}", name, kWithRealisticNoise);
  };
  const auto claim = [&](std::string_view says, std::string_view name, Sign sign) {
    const std::string test_case = noisy(name);
    return PairClaim(fmt::format("With realistic noise {}", says), {test_case, "traded"},
                     {test_case, "none"}, kShortfall, sign);
  };
  return {claim("in dense fog traded control helps: paper's driver.", kPaperName, Sign::kLess),
          claim("in dense fog traded control helps: all weaknesses.", kWholeName, Sign::kLess),
          PairClaim("With realistic noise an imperfect human leaves more danger.",
                    {noisy(kWholeName), "traded"}, {noisy(kPaperName), "traded"}, kShortfall,
                    Sign::kMore),
          claim("in the paper's fog the paper's driver helps.", kBiasName, Sign::kLess),
          claim("in the paper's fog a human who misjudges does harm.", kBiasMisjudgesName,
                Sign::kMore)};
}

}  // namespace

StudyDesign DriverDesign() {
  std::vector<StudyCase> cases = HumanKinds();
  for (StudyCase& one : Densities()) cases.push_back(std::move(one));
  cases.push_back({std::string(kBiasName), "paper.json", {}});
  cases.push_back({std::string(kBiasMisjudgesName), "paper.json", {"/human/misjudges=true"}});
  for (StudyCase& one : NoisyDrivers()) cases.push_back(std::move(one));
  std::vector<PlannedClaim> claims = DriverClaims();
  for (PlannedClaim& claim : NoisyDriverClaims()) claims.push_back(std::move(claim));
  return {.cases = std::move(cases),
          .variants = {{"none", {"/arbitrator/policy=none"}},
                       {"traded", {"/arbitrator/policy=traded"}}},
          .claims = std::move(claims)};
}

StudyResult RunDriverStudy(const StudyContext& context) {
  const StudyDesign design = DriverDesign();
  const std::vector<StudyCase>& cases = design.cases;
  const Comparison comparison(context, cases, design.variants);
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  section.answer = kDriverAnswer;
  section.would_change = kDriverWouldChange;
  result.claims = ClaimsOf(comparison, design.claims);
  section.figures = {
      OverDensity(comparison, "mean_compromised_safety_fog_m", "driver-cs-visibility",
                  "Compromised safety over the density of the fog (m)"),
      OverDensity(comparison, "collided", "driver-collisions-visibility",
                  "Collisions over the density of the fog"),
      OverDensity(comparison, "min_host_ttc_s", "driver-ttc-visibility",
                  "The host's smallest time to collision over the density of the fog (s)"),
      OverDensity(comparison, "max_abs_jerk_mps3", "driver-jerk-visibility",
                  "Largest jerk over the density of the fog (m/s3)")};
  std::vector<NamedCell> rows{{"without traded control", {0, 0}}};
  for (std::size_t c = 0; c < HumanKinds().size(); ++c) rows.push_back({cases[c].name, {c, 1}});
  section.tables = {
      comparison.TableOf("Drivers in dense fog with traded control", "driver", rows, kDriverTable),
      comparison.TableOfVariant(0, kDriverTable), comparison.TableOfVariant(1, kDriverTable)};
  section.method = fmt::format(
      "{} seeds of dense_fog.json, and of paper.json, with several human drivers of the host, "
      "without and with traded control; sight, errors and awareness have their default parameters. "
      "Without traded control the driver has no effect, so at equal visibility the run without "
      "traded control is the same for all drivers. {}",
      comparison.seeds(), RealisticNoiseText());
  result.files = {{"driver.csv", comparison.Csv(0)}};
  return result;
}

}  // namespace fogline::study
