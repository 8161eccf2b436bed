// Study `followers`: drivers of the cars behind the host.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/followers/string_runs.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

struct Behind {
  std::string_view name;
  std::vector<std::string> overrides;
};

std::vector<Behind> FollowerKinds() {
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

std::vector<StudyCase> FollowerCases() {
  std::vector<StudyCase> cases;
  for (const auto& [fog, file] :
       {std::pair("bias fog", "paper.json"), std::pair("beam fog", "dense_fog.json")}) {
    for (const Behind& kind : FollowerKinds()) {
      cases.push_back({.name = fmt::format("{}: {}", fog, kind.name),
                       .file = file,
                       .overrides = kind.overrides,
                       .group = fog});
    }
  }
  return cases;
}

/// The followers that the answer of the study (kFollowersAnswer) mentions, behind a host whose
/// radar has realistic noise.
std::vector<StudyCase> NoisyFollowers() {
  constexpr std::array<std::string_view, 4> kNames{"bias fog: acc", "bias fog: normal human",
                                                   "beam fog: acc", "beam fog: aggressive human"};
  std::vector<StudyCase> cases;
  for (const StudyCase& one : FollowerCases()) {
    if (std::ranges::count(kNames, one.name) > 0) cases.push_back(WithRealisticNoise(one));
  }
  return cases;
}

constexpr std::array<std::string_view, 8> kFollowerTable{"si_pct",
                                                         "mean_compromised_safety_fog_m",
                                                         "collided",
                                                         "min_follower_gap_m",
                                                         "min_follower_ttc_s",
                                                         "min_follower_time_gap_s",
                                                         "max_follower_drac_mps2",
                                                         "min_follower_rss_margin_m"};

constexpr std::string_view kFollowersAnswer =
    "It helps an ACC that follows the host. In the paper's fog traded control does nothing for a "
    "human follower, whose own fluctuations are larger than the effect; with a false echo it "
    "slightly raises the mean compromised safety of an aggressive human follower (lowers it if the "
    "radar has realistic noise), although the smallest gap and the smallest time to collision of "
    "this follower become larger. The last car of a string of followers brakes less hard with "
    "traded control, whatever kind of driver the string has.";
constexpr std::string_view kFollowersWouldChange =
    "Followers with automatic emergency braking, or a host that brakes harder.";

std::vector<PlannedClaim> ClaimsOnFirst() {
  const auto claim = [](std::string says, std::string_view name, Sign sign, double margin = 0) {
    return PairClaim(std::move(says), {name, "traded"}, {name, "none"}, kShortfall, sign, margin);
  };
  return {claim("In bias fog traded control helps an ACC.", "bias fog: acc", Sign::kLess),
          claim("In beam fog traded control helps an ACC.", "beam fog: acc", Sign::kLess),
          claim("In bias fog traded control does nothing for a normal human.",
                "bias fog: normal human", Sign::kEqual, kNoShortfall_m),
          claim("In bias fog traded control does nothing for a cautious human.",
                "bias fog: cautious human", Sign::kEqual, kNoShortfall_m),
          claim("In beam fog traded control does harm with an aggressive human.",
                "beam fog: aggressive human", Sign::kMore),
          claim("With RSS nothing is left to improve.", "beam fog: normal human with RSS",
                Sign::kEqual, kNoShortfall_m)};
}

/// The claims on the first follower behind a host whose radar has realistic noise.
std::vector<PlannedClaim> NoisyClaimsOnFirst() {
  const auto claim = [](std::string_view says, std::string_view name, Sign sign,
                        double margin = 0) {
    const std::string noisy = fmt::format("{}{}", name, kWithRealisticNoise);
    return PairClaim(fmt::format("With realistic noise {}", says), {noisy, "traded"},
                     {noisy, "none"}, kShortfall, sign, margin);
  };
  return {claim("in bias fog traded control helps an ACC.", "bias fog: acc", Sign::kLess),
          claim("in beam fog traded control helps an ACC.", "beam fog: acc", Sign::kLess),
          claim("in bias fog traded control does nothing for a normal human.",
                "bias fog: normal human", Sign::kEqual, kNoShortfall_m),
          claim("in beam fog traded control helps an aggressive human.",
                "beam fog: aggressive human", Sign::kLess)};
}

/// A table of the kinds of followers that differ most, without and with traded control.
report::StudyTable FollowersMainTable(const Comparison& comparison) {
  std::vector<NamedCell> rows;
  for (const std::string_view name :
       {"beam fog: acc", "beam fog: aggressive human", "beam fog: normal human",
        "beam fog: cautious human", "beam fog: five cars drawn"}) {
    for (const std::string_view variant : {"none", "traded"}) {
      rows.push_back({fmt::format("{}, {}", name, variant),
                      {comparison.CaseNamed(name), comparison.VariantNamed(variant)}});
    }
  }
  return comparison.TableOf("First car behind the host in beam fog", "follower", rows,
                            kFollowerTable);
}

/// A figure that shows a quantity for each place in a string (a row of cars that follow the host).
/// It has a curve for each string behind one variant of the host.
report::StudyFigure ByPlace(std::span<const StringOutcome> strings, std::string_view variant,
                            std::string id, std::string title, std::string y_label,
                            std::vector<double> CarInString::*values) {
  report::StudyFigure figure{
      .id = std::move(id),
      .title = fmt::format("{}, host: {}", title, variant),
      .caption =
          "Means over the seeds with their 95 % confidence bands. Place 0 is "
          "the host.",
      .x_label = "Place in the string",
      .y_label = std::move(y_label),
      .log_y = values == &CarInString::min_ttc_s};
  for (const StringOutcome& string : strings) {
    if (string.variant != variant) continue;
    report::StudySeries& series = figure.series.emplace_back();
    series.name = string.kind;
    for (std::size_t place = 0; place <= kStringCars; ++place) {
      const Estimate mean = EstimateOf(string.cars[place].*values);
      if (mean.n == 0) continue;
      series.x.push_back(static_cast<double>(place));
      series.y.push_back(mean.mean);
      series.low.push_back(mean.low);
      series.high.push_back(mean.high);
    }
  }
  return figure;
}

/// A measure that the study reports for each place in a string.
struct StringMetric {
  std::string_view name;
  std::vector<double> CarInString::*values;
  int decimals;
};
constexpr std::array kStringMetrics{
    StringMetric{"max_deceleration_mps2", &CarInString::max_deceleration_mps2, 2},
    StringMetric{"amplification", &CarInString::amplification, 2},
    StringMetric{"min_ttc_s", &CarInString::min_ttc_s, 1},
    StringMetric{"min_gap_m", &CarInString::min_gap_m, 2}};

report::StudyTable TableOfString(const StringOutcome& string, std::int64_t seeds) {
  report::StudyTable table{
      .caption =
          fmt::format("String of {}, {}: by place; collisions in {}", string.kind, string.variant,
                      Text(metrics::ClopperPearson(string.collisions, seeds))),
      .columns = {"place"}};
  for (const StringMetric& measure : kStringMetrics) table.columns.emplace_back(measure.name);
  for (std::size_t place = 0; place <= kStringCars; ++place) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(place == 0 ? "host" : fmt::format("follower {}", place));
    for (const StringMetric& measure : kStringMetrics) {
      row.push_back(Text(EstimateOf(string.cars[place].*measure.values), measure.decimals));
    }
  }
  return table;
}

std::string StringCsv(std::span<const StringOutcome> strings) {
  std::string csv =
      "string,variant,place,measure,n,infinite,mean,std,ci95_low,ci95_high,minus_first,"
      "minus_first_ci95_low,minus_first_ci95_high\n";
  for (const StringOutcome& string : strings) {
    for (std::size_t place = 0; place <= kStringCars; ++place) {
      for (const StringMetric& measure : kStringMetrics) {
        const std::vector<double>& values = string.cars[place].*measure.values;
        if (values.empty()) continue;
        const Estimate mean = EstimateOf(values);
        const Estimate difference = PairedDifference(values, string.cars[1].*measure.values);
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", string.kind, string.variant,
                           place, measure.name, mean.n, mean.infinite, CsvText(mean.mean),
                           CsvText(mean.deviation), CsvText(mean.low), CsvText(mean.high),
                           CsvText(difference.mean), CsvText(difference.low),
                           CsvText(difference.high));
      }
    }
  }
  return csv;
}

void AddStrings(const StudyContext& context, std::span<const StringOutcome> strings,
                StudyResult& result) {
  report::StudySection& section = result.section;
  result.runs += static_cast<std::int64_t>(strings.size()) * context.seeds.count();
  for (const StringOutcome& string : strings) {
    section.tables.push_back(TableOfString(string, context.seeds.count()));
  }
  for (const StudyVariant& variant : HostVariants()) {
    section.figures.push_back(
        ByPlace(strings, variant.name, fmt::format("followers-string-{}", variant.name),
                "Hardest braking along a string", "Largest deceleration (m/s2)",
                &CarInString::max_deceleration_mps2));
    section.figures.push_back(ByPlace(strings, variant.name,
                                      fmt::format("followers-string-ttc-{}", variant.name),
                                      "Smallest time to collision along a string",
                                      "Smallest time to collision (s)", &CarInString::min_ttc_s));
  }
  result.files.push_back({"followers-string.csv", StringCsv(strings)});
}

}  // namespace

StudyDesign FollowersDesign() {
  std::vector<StudyCase> cases = FollowerCases();
  for (StudyCase& one : NoisyFollowers()) cases.push_back(std::move(one));
  std::vector<PlannedClaim> claims = ClaimsOnFirst();
  for (PlannedClaim& claim : NoisyClaimsOnFirst()) claims.push_back(std::move(claim));
  return {.cases = std::move(cases), .variants = HostVariants(), .claims = std::move(claims)};
}

StudyResult RunFollowersStudy(const StudyContext& context) {
  const StudyDesign design = FollowersDesign();
  const std::vector<StudyCase>& cases = design.cases;
  const std::vector<StudyCase> kinds = StringKinds();
  const auto compared = static_cast<std::int64_t>(cases.size()) * context.seeds.count();
  const auto strung =
      static_cast<std::int64_t>(kinds.size() * HostVariants().size()) * context.seeds.count();
  const Comparison comparison(context.Part(0, compared + strung), cases, HostVariants());
  const std::vector<StringOutcome> strings =
      RunStrings(context.Part(compared, compared + strung), kinds, HostVariants());
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  section.answer = kFollowersAnswer;
  section.would_change = kFollowersWouldChange;
  result.claims = ClaimsOf(comparison, design.claims);
  for (Claim& claim : ClaimsOnStrings(strings)) result.claims.push_back(std::move(claim));
  section.figures = {comparison.FigureOf("mean_compromised_safety_fog_m", "followers-cs",
                                         "Compromised safety by follower", true),
                     comparison.FigureOf("max_follower_drac_mps2", "followers-drac",
                                         "How hard the follower has to brake", true),
                     comparison.FigureOf("min_follower_ttc_s", "followers-ttc",
                                         "Smallest time to collision of the follower", true),
                     comparison.FigureOf("collided", "followers-collisions", "Collisions", true)};
  section.tables = {FollowersMainTable(comparison), comparison.TableOfVariant(0, kFollowerTable),
                    comparison.TableOfVariant(1, kFollowerTable)};
  section.method = fmt::format(
      "{} seeds of paper.json and dense_fog.json with other drivers behind the host, without and "
      "with traded control at the scenario's threshold. Gaps at step 0 are those of the ACC. Other "
      "drivers reach their own gap before the fog begins. Measures are those of the first car "
      "behind the host; collisions are those of any car. A human driver is the IDM (Intelligent "
      "Driver Model) with the parameters of a style, and with the errors and the reaction time of "
      "the Human Driver Model. Strings: {} cars of a kind behind the host of dense_fog.json. Here "
      "the fog begins at 60 s, so that every gap has settled before it. Their measures begin a "
      "second before the fog. The column amplification is a car's largest deceleration divided by "
      "that of the car ahead; it is empty if the car ahead brakes with less than 0.01 m/s2. {}",
      comparison.seeds(), kStringCars, RealisticNoiseText());
  result.files = {{"followers.csv", comparison.Csv(0)}};
  AddStrings(context, strings, result);
  return result;
}

}  // namespace fogline::study
