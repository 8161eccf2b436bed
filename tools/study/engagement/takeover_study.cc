// Study `takeover`: a driver who needs time to take over, and the automation during this time.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/engagement/fog_modes.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

constexpr std::string_view kNoTradedControl = "none";

/// Mean times to take over, s. The value for the paper's driver is 0, because this driver drives
/// without a request. Zhang et al. 2019 found a mean of 2.7 s in 129 studies.
constexpr std::array kLatencies_s{0, 1, 2, 3, 4, 5};
/// Standard deviation of the time to take over, s. The value is our choice: it is smaller than the
/// difference between two neighbouring mean times.
constexpr double kDeviation_s = 0.5;
/// Probability that a driver never takes over. The value is our choice: one driver in ten is enough
/// to show the cost.
constexpr double kAbsent = 0.1;

/// The behaviour of the automation from the request until the driver takes over.
struct Meanwhile {
  std::string_view name;
  std::vector<std::string> overrides;
};

std::vector<Meanwhile> Meanwhiles() {
  return {
      {"stay", {"/arbitrator/policy=traded"}},
      {"isolate", {"/arbitrator/policy=traded_isolating"}},
      {"gate", {"/arbitrator/policy=traded", "/fusion/gating=true", "/fusion/gate_reopen_after=0"}},
      {"slow down", {"/arbitrator/policy=traded", "/arbitrator/take_over/slow_down_mps2=0.5"}}};
}

std::string LatencyName(std::string_view meanwhile, int latency_s, bool absent) {
  return fmt::format("{} {} s{}", meanwhile, latency_s, absent ? " with absent drivers" : "");
}

std::vector<StudyVariant> TakeOverVariants() {
  std::vector<StudyVariant> variants{{std::string(kNoTradedControl), {"/arbitrator/policy=none"}}};
  for (const Meanwhile& meanwhile : Meanwhiles()) {
    for (const int latency_s : kLatencies_s) {
      for (const bool absent : {false, true}) {
        if (latency_s == 0 && (absent || meanwhile.name == "slow down")) continue;
        StudyVariant& one = variants.emplace_back(LatencyName(meanwhile.name, latency_s, absent),
                                                  meanwhile.overrides);
        if (latency_s == 0) continue;
        one.overrides.insert(one.overrides.end(),
                             {"/arbitrator/take_over/mode=requested",
                              fmt::format("/arbitrator/take_over/time/mean_s={}", latency_s),
                              fmt::format("/arbitrator/take_over/time/std_s={}", kDeviation_s)});
        if (absent) {
          one.overrides.push_back(
              fmt::format("/arbitrator/take_over/absent_probability={}", kAbsent));
        }
      }
    }
  }
  return variants;
}

/// The variants of the main comparison. The study repeats these variants with realistic noise.
std::vector<StudyVariant> MainVariants() {
  std::vector<StudyVariant> variants = TakeOverVariants();
  std::erase_if(variants, [](const StudyVariant& one) {
    constexpr std::array kMainLatencies_s{0, 1, 3, 5};
    const bool is_main = std::ranges::any_of(kMainLatencies_s, [&](int latency_s) {
      return one.name == LatencyName("stay", latency_s, false) ||
             one.name == LatencyName("isolate", latency_s, false);
    });
    return !is_main && one.name != kNoTradedControl;
  });
  return variants;
}

/// Each fog with each human. The radar has realistic noise.
std::vector<StudyCase> NoisyCases() {
  std::vector<StudyCase> cases;
  for (const FogMode& fog : FogModes()) {
    for (const auto& [human, overrides] : BothHumans()) {
      cases.push_back(WithRealisticNoise(fog.Case(human, overrides)));
    }
  }
  return cases;
}

/// Each fog with a perfect human, with a fallible human, and with a fallible human who must be more
/// aware before the transfer.
std::vector<StudyCase> TakeOverCases() {
  // This value is our choice. A monitoring driver's readiness rises from 0.5 to this value in 3 s.
  constexpr double kReady = 0.8;
  std::vector<StudyCase> cases;
  for (const FogMode& fog : FogModes()) {
    const auto add = [&](std::string_view human, const std::vector<std::string>& overrides) {
      StudyCase& one = cases.emplace_back(fog.Case(human));
      one.overrides.insert(one.overrides.end(), overrides.begin(), overrides.end());
    };
    std::vector<std::string> slow = FallibleHuman();
    slow.push_back(fmt::format("/arbitrator/take_over/required_readiness={}", kReady));
    add(kPerfectHuman, {});
    add(kFallibleHuman, FallibleHuman());
    add("fallible human who must be aware", slow);
  }
  return cases;
}

constexpr std::array<std::string_view, 9> kTakeOverTable{"si_pct",
                                                         "mean_compromised_safety_fog_m",
                                                         "max_compromised_safety_m",
                                                         "min_host_ttc_s",
                                                         "collided",
                                                         "max_abs_jerk_mps3",
                                                         "minimal_risk_s",
                                                         "human_time_s",
                                                         "transfers_pmin"};

/// A figure of a measure over the mean time to take over, with a series for each behaviour of the
/// automation.
report::StudyFigure OverLatency(const Comparison& comparison, std::string_view test_case,
                                std::string_view measure, std::string id) {
  report::StudyFigure figure{
      .id = std::move(id),
      .title = fmt::format("{}, {}", NameForReaders(measure), test_case),
      .caption = "Means over the seeds with their 95 % confidence intervals.",
      .x_label = "Mean time to take over (s)",
      .y_label = NameForReaders(measure)};
  const std::size_t c = comparison.CaseNamed(test_case);
  const auto add_point = [&](report::StudySeries& series, int latency_s, std::string_view name) {
    AddPoint(series, latency_s, comparison.Point({c, comparison.VariantNamed(name)}, measure));
  };
  report::StudySeries& none = figure.series.emplace_back();
  none.name = "without traded control";
  for (const int latency_s : kLatencies_s) add_point(none, latency_s, kNoTradedControl);
  for (const Meanwhile& meanwhile : Meanwhiles()) {
    report::StudySeries& series = figure.series.emplace_back();
    series.name = meanwhile.name;
    for (const int latency_s : kLatencies_s) {
      if (latency_s == 0 && meanwhile.name == "slow down") continue;
      add_point(series, latency_s, LatencyName(meanwhile.name, latency_s, false));
    }
  }
  return figure;
}

/// A table of the mean compromised safety. It has a row for each mean time that a human needs to
/// take over, and for each model of the human. It has a column for each fog and each of two
/// behaviours of the automation.
/// @param noise the end of the names of the cases: "" or kWithRealisticNoise
report::StudyTable TakeOverMainTable(const Comparison& comparison, std::string_view noise) {
  report::StudyTable table{
      .caption = fmt::format("Mean compromised safety in fog{} (m), means over {} seeds [95 % "
                             "confidence intervals]",
                             noise, comparison.seeds()),
      .columns = {"mean time to take over"}};
  constexpr std::array<std::string_view, 2> kShown{"stay", "isolate"};
  for (const FogMode& fog : FogModes()) {
    for (const std::string_view meanwhile : kShown) {
      table.columns.push_back(fmt::format("{}: {}", fog.name, meanwhile));
    }
  }
  const auto has = [&](const std::string& variant) {
    return std::ranges::count(comparison.variants(), variant, &StudyVariant::name) > 0;
  };
  const auto add_row = [&](std::string name, std::string_view human, auto variant_of) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(std::move(name));
    for (const FogMode& fog : FogModes()) {
      const std::size_t c = comparison.CaseNamed(fog.Case(human).name + std::string(noise));
      for (const std::string_view meanwhile : kShown) {
        const std::size_t v = comparison.VariantNamed(variant_of(meanwhile));
        row.push_back(Text(comparison.Mean({c, v}, kShortfall)));
      }
    }
  };
  // Without traded control no human drives, so one row is enough for both humans.
  add_row("no traded control", kPerfectHuman, [](std::string_view) { return kNoTradedControl; });
  for (const int latency_s : kLatencies_s) {
    const auto variant_of = [&](std::string_view meanwhile) {
      return LatencyName(meanwhile, latency_s, false);
    };
    if (!has(variant_of("stay"))) continue;
    for (const std::string_view human : {kPerfectHuman, kFallibleHuman}) {
      add_row(fmt::format("{} s, {}", latency_s, human), human, variant_of);
    }
  }
  return table;
}

constexpr std::string_view kTakeOverAnswer =
    "In the paper's fog the gain is smaller if a perfect driver needs longer to take over: after "
    "some seconds nothing is left, and a long wait does harm; with realistic radar noise a part of "
    "the gain is left. With a false echo a long wait does harm if the automation goes on as it is, "
    "and costs nothing if the automation leaves out the deceived sensor meanwhile. Without any "
    "echo the automation alone is safer than traded control if the parameters are those of this "
    "study, but with every parameter set of study ensemble it is less safe than traded control.";
constexpr std::string_view kTakeOverWouldChange =
    "A warning before the fog begins, fog that lasts much longer than a request, a noisier radar, "
    "or a driver who errs.";

std::string StayFor(int latency_s) { return LatencyName("stay", latency_s, false); }
std::string IsolateFor(int latency_s) { return LatencyName("isolate", latency_s, false); }

/// The claim on the difference in mean compromised safety of two variants in a case.
PlannedClaim ShortfallClaim(std::string says, std::string_view test_case, std::string_view a,
                            std::string_view b, Sign sign, double margin = 0) {
  return PairClaim(std::move(says), {test_case, a}, {test_case, b}, kShortfall, sign, margin);
}

std::vector<PlannedClaim> TakeOverClaims() {
  const std::string_view none = kNoTradedControl;
  const std::string bias = FogModes()[0].Case(kPerfectHuman).name;
  const std::string fallible = FogModes()[0].Case(kFallibleHuman).name;
  const std::string near = FogModes()[1].Case(kPerfectHuman).name;
  const std::string missing = FogModes()[2].Case(kPerfectHuman).name;
  return {
      ShortfallClaim("In bias fog a wait of one second costs safety.", bias, StayFor(1), StayFor(0),
                     Sign::kMore),
      ShortfallClaim("A wait of three seconds leaves nothing of the gain.", bias, StayFor(3), none,
                     Sign::kEqual, kNoShortfall_m),
      ShortfallClaim("A wait of five seconds does harm.", bias, StayFor(5), none, Sign::kMore),
      ShortfallClaim("In bias fog a fallible human does harm without any wait.", fallible,
                     StayFor(0), none, Sign::kMore),
      ShortfallClaim("With a false echo a wait of five seconds does harm.", near, StayFor(5), none,
                     Sign::kMore),
      ShortfallClaim("The wait costs nothing if the deceived sensor is left out meanwhile.", near,
                     IsolateFor(5), IsolateFor(0), Sign::kEqual, kNoShortfall_m),
      ShortfallClaim("With a false echo, leaving out the deceived sensor during a wait is safer "
                     "than a driver without a wait.",
                     near, IsolateFor(5), StayFor(0), Sign::kLess),
      ShortfallClaim("Without an echo the automation alone is safer than traded control.", missing,
                     none, StayFor(0), Sign::kLess),
  };
}

/// The claims on runs with realistic noise. They support the study's answer.
std::vector<PlannedClaim> NoisyClaims() {
  const std::string_view none = kNoTradedControl;
  const auto name = [](std::size_t fog) {
    return WithRealisticNoise(FogModes()[fog].Case(kPerfectHuman)).name;
  };
  return {
      ShortfallClaim("With realistic noise in bias fog a wait of one second costs safety.", name(0),
                     StayFor(1), StayFor(0), Sign::kMore),
      ShortfallClaim("With realistic noise in bias fog a wait of five seconds still helps.",
                     name(0), StayFor(5), none, Sign::kLess),
      ShortfallClaim("With realistic noise and a false echo a wait of five seconds does harm.",
                     name(1), StayFor(5), none, Sign::kMore),
      ShortfallClaim(
          "With realistic noise the wait costs nothing if the deceived sensor is left out "
          "meanwhile.",
          name(1), IsolateFor(5), IsolateFor(0), Sign::kEqual, kNoShortfall_m),
      ShortfallClaim("With realistic noise and without an echo the automation alone is safer than "
                     "traded control.",
                     name(2), none, StayFor(0), Sign::kLess),
  };
}

}  // namespace

StudyDesign TakeOverDesign() {
  std::vector<StudyCase> cases = TakeOverCases();
  for (StudyCase& one : NoisyCases()) cases.push_back(std::move(one));
  std::vector<PlannedClaim> claims = TakeOverClaims();
  for (PlannedClaim& claim : NoisyClaims()) claims.push_back(std::move(claim));
  return {.cases = std::move(cases), .variants = TakeOverVariants(), .claims = std::move(claims)};
}

StudyResult RunTakeOverStudy(const StudyContext& context) {
  const auto units = [&](const std::vector<StudyCase>& cases) {
    return static_cast<std::int64_t>(cases.size()) * context.seeds.count();
  };
  const std::int64_t first = units(TakeOverCases());
  const std::int64_t all = first + units(NoisyCases());
  const Comparison comparison(context.Part(0, all), TakeOverCases(), TakeOverVariants());
  const Comparison noisy(context.Part(first, all), NoisyCases(), MainVariants());
  StudyResult result;
  result.runs = comparison.runs() + noisy.runs();
  result.claims = ClaimsOf(comparison, TakeOverClaims());
  for (Claim& claim : ClaimsOf(noisy, NoisyClaims())) result.claims.push_back(std::move(claim));
  report::StudySection& section = result.section;
  section.answer = kTakeOverAnswer;
  section.would_change = kTakeOverWouldChange;
  section.tables = {TakeOverMainTable(comparison, ""),
                    TakeOverMainTable(noisy, kWithRealisticNoise)};
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    section.tables.push_back(comparison.TableOfCase(c, kTakeOverTable));
  }
  int number = 0;
  for (const std::string_view human : {kPerfectHuman, kFallibleHuman}) {
    for (const FogMode& fog : FogModes()) {
      section.figures.push_back(OverLatency(comparison, fog.Case(human).name, kShortfall,
                                            fmt::format("takeover-cs-{}", ++number)));
    }
  }
  section.figures.push_back(OverLatency(comparison, FogModes()[1].Case(kPerfectHuman).name,
                                        "max_abs_jerk_mps3", "takeover-jerk"));
  section.method = fmt::format(
      "{} seeds of {}. The time to take over is log-normal with the mean that is shown and a "
      "standard deviation of {:g} s; at 0 s the driver need not be asked, as in the paper. Until "
      "the driver is there, the automation does not accelerate. Four variants differ in what else "
      "it does: nothing (stay); it leaves out the sensor that is to blame (isolate); it refuses "
      "values outside the gate of its filter (gate); or it slows down with 0.5 m/s2 (slow down). "
      "If the driver does not take over within 10 s, a minimal risk manoeuvre begins. {} In the "
      "cases with a human who must be aware, the driver gets authority only if the awareness is at "
      "least 0.8. {} The main comparison is repeated with this noise (takeover-noise.csv). The "
      "file takeover.csv has all differences from no traded control; {} of them have p-values, "
      "which are adjusted by Holm.",
      comparison.seeds(), FogModesText(), kDeviation_s, HumansText(), RealisticNoiseText(),
      comparison.Comparisons(0));
  result.files = {{"takeover.csv", comparison.Csv(comparison.VariantNamed(kNoTradedControl))},
                  {"takeover-noise.csv", noisy.Csv(noisy.VariantNamed(kNoTradedControl))}};
  return result;
}

}  // namespace fogline::study
