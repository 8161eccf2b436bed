#include "tools/study/comparison.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "services/closed_loop/closed_loop.h"
#include "services/metrics/run_metrics.h"
#include "services/metrics/safety_improvement.h"
#include "tools/report/metric_text.h"
#include "tools/stats/holm.h"
#include "tools/stats/in_order.h"
#include "tools/stats/mcnemar.h"
#include "tools/stats/statistics.h"
#include "tools/study/paired_worker.h"

namespace fogline::study {
namespace {

std::vector<ComparedMetric> AllMetrics() {
  std::vector<ComparedMetric> all;
  const auto put = [&](std::string_view name, const auto&, std::string_view unit,
                       std::string_view description) {
    all.push_back({std::string(name), std::string(unit), std::string(description)});
  };
  metrics::VisitPairedMetrics({}, put);
  put(kCollided, 0, "", "probability of a collision");
  metrics::VisitMetrics(metrics::RunMetrics{}, put);
  std::erase_if(all, [](const ComparedMetric& one) { return one.name == kCollisionCode; });
  return all;
}

/// Index of the element with this name.
template <class Named>
std::size_t PlaceOf(const std::vector<Named>& all, std::string_view name, std::string_view kind) {
  const auto found = std::ranges::find(all, name, &Named::name);
  if (found == all.end()) throw std::out_of_range(fmt::format("no {} {}", kind, name));
  return static_cast<std::size_t>(found - all.begin());
}

/// @throws std::invalid_argument
template <class Named>
void RequireNamesWithoutCommas(const std::vector<Named>& all) {
  for (const Named& one : all) {
    if (one.name.find(',') != one.name.npos) {
      throw std::invalid_argument("a comma in the name " + one.name);
    }
  }
}

/// Whether kWithoutTradedControl is the only override of the variant. Such a variant needs no runs
/// of its own, because each case already has the run without traded control.
bool IsWithoutTradedControl(const StudyVariant& variant) {
  return variant.overrides.size() == 1 && variant.overrides.front() == kWithoutTradedControl;
}

/// The scenarios of the cells, case by case. The first scenario of a case belongs to its run
/// without traded control. A variant for which IsWithoutTradedControl() is true has no scenario of
/// its own.
std::vector<Scenario> ScenariosOf(const StudyContext& context, const std::vector<StudyCase>& cases,
                                  const std::vector<StudyVariant>& variants) {
  std::vector<Scenario> scenarios;
  for (const StudyCase& one : cases) {
    scenarios.push_back(
        context.Load(one.file, one.overrides, {std::string(kWithoutTradedControl)}));
    for (const StudyVariant& variant : variants) {
      if (IsWithoutTradedControl(variant)) continue;
      scenarios.push_back(context.Load(one.file, one.overrides, variant.overrides));
    }
  }
  return scenarios;
}

}  // namespace

std::span<const ComparedMetric> ComparedMetrics() {
  static const std::vector<ComparedMetric> kAll = AllMetrics();
  return kAll;
}

std::size_t PlaceOfMetric(std::string_view name) {
  const std::span<const ComparedMetric> all = ComparedMetrics();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
  }
  throw std::out_of_range("no measure " + std::string(name));
}

Comparison::Comparison(const StudyContext& context, std::vector<StudyCase> cases,
                       std::vector<StudyVariant> variants)
    : cases_(std::move(cases)), variants_(std::move(variants)), seeds_(context.seeds.count()) {
  RequireNamesWithoutCommas(cases_);
  RequireNamesWithoutCommas(variants_);
  const std::vector<Scenario> scenarios = ScenariosOf(context, cases_, variants_);
  const std::size_t measures = ComparedMetrics().size();
  const auto seeds = static_cast<std::size_t>(seeds_);
  values_.assign(cases_.size() * variants_.size() * measures * seeds, stats::kMissing);
  const std::int64_t units = static_cast<std::int64_t>(cases_.size()) * seeds_;
  const std::size_t block = scenarios.size() / std::max<std::size_t>(1, cases_.size());
  stats::ComputeInOrder(
      0, units, context.jobs, [] { return PairedWorker(); },
      [&](PairedWorker& worker, std::int64_t unit) {
        const auto of_case =
            std::span(scenarios).subspan(static_cast<std::size_t>(unit / seeds_) * block, block);
        auto runs = worker.Compute(of_case, context.seeds.first + unit % seeds_);
        for (std::size_t v = 0; v < variants_.size(); ++v) {
          if (!IsWithoutTradedControl(variants_[v])) continue;
          runs.insert(runs.begin() + static_cast<std::ptrdiff_t>(v),
                      worker.OfBaseline(of_case.front()));
        }
        return runs;
      },
      [&](std::int64_t unit, const std::vector<RunValues>& runs) {
        const auto seed = static_cast<std::size_t>(unit % seeds_);
        const auto first = static_cast<std::size_t>(unit / seeds_) * variants_.size();
        for (std::size_t v = 0; v < runs.size(); ++v) {
          for (std::size_t m = 0; m < measures; ++m) {
            values_[((first + v) * measures + m) * seeds + seed] = runs[v][m];
          }
        }
        context.Show(unit + 1, units);
        return true;
      });
}

Comparison::Comparison(std::vector<StudyCase> cases, std::vector<StudyVariant> variants,
                       std::int64_t seeds, std::vector<double> values)
    : cases_(std::move(cases)),
      variants_(std::move(variants)),
      seeds_(seeds),
      values_(std::move(values)) {
  const std::size_t cells = cases_.size() * variants_.size();
  if (values_.size() != cells * ComparedMetrics().size() * static_cast<std::size_t>(seeds)) {
    throw std::invalid_argument("a comparison needs a value of every measure of every run");
  }
}

std::int64_t Comparison::runs() const {
  const auto others = variants_.size() - static_cast<std::size_t>(std::ranges::count_if(
                                             variants_, IsWithoutTradedControl));
  return static_cast<std::int64_t>(cases_.size() * (1 + others)) * seeds_;
}

std::span<const double> Comparison::Values(Cell cell, std::string_view measure) const {
  const auto seeds = static_cast<std::size_t>(seeds_);
  const std::size_t place = cell.test_case * variants_.size() + cell.variant;
  const std::size_t row = place * ComparedMetrics().size() + PlaceOfMetric(measure);
  return std::span(values_).subspan(row * seeds, seeds);
}

Estimate Comparison::Mean(Cell cell, std::string_view measure) const {
  return EstimateOf(Values(cell, measure));
}

Estimate Comparison::Difference(Cell a, Cell b, std::string_view measure) const {
  if (measure == kCollided) return PairedShareDifference(Values(a, measure), Values(b, measure));
  return PairedDifference(Values(a, measure), Values(b, measure));
}

metrics::EventShare Comparison::Collisions(Cell cell) const {
  std::int64_t events = 0;
  for (const double collided : Values(cell, kCollided)) events += collided > 0 ? 1 : 0;
  return metrics::ClopperPearson(events, seeds_);
}

Estimate Comparison::Point(Cell cell, std::string_view measure) const {
  Estimate mean = Mean(cell, measure);
  if (measure == kCollided) {
    const metrics::EventShare share = Collisions(cell);
    mean.low = share.lower;
    mean.high = share.upper;
  }
  return mean;
}

std::int64_t Comparison::PairsCutShort(Cell a, Cell b) const {
  const std::span<const double> crash_a = Values(a, kCollided);
  const std::span<const double> crash_b = Values(b, kCollided);
  const std::span<const double> steps_a = Values(a, "steps");
  const std::span<const double> steps_b = Values(b, "steps");
  std::int64_t pairs = 0;
  for (std::size_t i = 0; i < steps_a.size(); ++i) {
    if (crash_a[i] > 0 || crash_b[i] > 0 || steps_a[i] != steps_b[i]) ++pairs;
  }
  return pairs;
}

std::size_t Comparison::CaseNamed(std::string_view name) const {
  return PlaceOf(cases_, name, "case");
}

std::size_t Comparison::VariantNamed(std::string_view name) const {
  return PlaceOf(variants_, name, "variant");
}

double Comparison::PValueOfCollisions(Cell a, Cell b) const {
  return stats::McNemar(Values(a, kCollided), Values(b, kCollided));
}

std::vector<double> Comparison::LessSafe(Cell a, Cell b) const {
  const std::span<const double> crash_a = Values(a, kCollided);
  const std::span<const double> crash_b = Values(b, kCollided);
  const std::span<const double> shortfall_a = Values(a, kShortfall);
  const std::span<const double> shortfall_b = Values(b, kShortfall);
  std::vector<double> less_safe;
  for (std::size_t i = 0; i < crash_a.size(); ++i) {
    const bool is_decided = crash_a[i] > 0 || crash_b[i] > 0;
    const bool is_less = is_decided ? crash_a[i] > crash_b[i] : shortfall_a[i] > shortfall_b[i];
    less_safe.push_back(is_less ? 1 : 0);
  }
  return less_safe;
}

std::vector<Comparison::PairedTest> Comparison::TestsAgainst(std::size_t reference) const {
  std::vector<PairedTest> tests;
  for (std::size_t c = 0; c < cases_.size(); ++c) {
    for (std::size_t v = 0; v < variants_.size(); ++v) {
      const Cell cell{c, v};
      const Cell other{c, reference};
      const std::int64_t cut_short = v == reference ? 0 : PairsCutShort(cell, other);
      for (const ComparedMetric& measure : ComparedMetrics()) {
        PairedTest& test = tests.emplace_back();
        if (v == reference) continue;
        test = {.difference = Difference(cell, other, measure.name), .cut_short = cut_short};
        if (!test.difference.has_interval()) continue;
        if (measure.name == kCollided) {
          test.p = PValueOfCollisions(cell, other);
        } else if (cut_short == 0) {
          test.p = PValueOfSign(test.difference);
        }
      }
    }
  }
  return tests;
}

std::int64_t Comparison::Comparisons(std::size_t reference) const {
  return std::ranges::count_if(TestsAgainst(reference),
                               [](const PairedTest& test) { return test.p.has_value(); });
}

std::string Comparison::Csv(std::size_t reference) const {
  std::string csv =
      "case,variant,measure,unit,n,infinite,mean,std,ci95_low,ci95_high,reference,difference_n,"
      "difference_infinite,difference_cut_short,difference,difference_ci95_low,"
      "difference_ci95_high,effect_size,p,p_holm\n";
  const std::vector<PairedTest> tests = TestsAgainst(reference);
  std::vector<double> p;
  for (const PairedTest& test : tests) {
    if (test.p) p.push_back(*test.p);
  }
  const std::vector<double> holm = stats::Holm(p);
  auto adjusted = holm.begin();
  auto test = tests.begin();
  for (std::size_t c = 0; c < cases_.size(); ++c) {
    for (std::size_t v = 0; v < variants_.size(); ++v) {
      for (const ComparedMetric& measure : ComparedMetrics()) {
        const Estimate mean = Point({c, v}, measure.name);
        const Estimate& difference = test->difference;
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", cases_[c].name,
                           variants_[v].name, measure.name, measure.unit, mean.n, mean.infinite,
                           CsvText(mean.mean), CsvText(mean.deviation), CsvText(mean.low),
                           CsvText(mean.high), variants_[reference].name, difference.n,
                           difference.infinite, test->cut_short, CsvText(difference),
                           CsvText(difference.mean / difference.deviation));
        csv += test->p ? fmt::format(",{},{}\n", CsvText(*test->p), CsvText(*adjusted++)) : ",,\n";
        ++test;
      }
    }
  }
  return csv;
}

report::StudyFigure Comparison::FigureOf(std::string_view measure, std::string id,
                                         std::string title, bool cases_on_axis) const {
  const ComparedMetric& info = ComparedMetrics()[PlaceOfMetric(measure)];
  report::StudyFigure figure{
      .id = std::move(id),
      .title = std::move(title),
      .caption = fmt::format("Mean over {} seeds with its 95 % confidence interval. {}.", seeds_,
                             info.description),
      .x_label = "",
      .y_label = info.unit.empty() ? NameForReaders(measure)
                                   : fmt::format("{} ({})", NameForReaders(measure), info.unit),
      .log_y = report::IsTimeToCollision(measure)};
  // The maximum available deceleration (MADR, Cunto & Saccomanno 2008): no car brakes harder. If a
  // car needs more than this to avoid a collision, it collides. So the figure ends at this value.
  if (measure.ends_with("drac_mps2")) figure.most = MeasuresSection{}.madr_most_mps2;
  const std::size_t series = cases_on_axis ? variants_.size() : cases_.size();
  const std::size_t places = cases_on_axis ? cases_.size() : variants_.size();
  for (std::size_t p = 0; p < places; ++p) {
    figure.categories.push_back(cases_on_axis ? cases_[p].name : variants_[p].name);
  }
  for (std::size_t s = 0; s < series; ++s) {
    report::StudySeries& one = figure.series.emplace_back();
    one.name = cases_on_axis ? variants_[s].name : cases_[s].name;
    for (std::size_t p = 0; p < places; ++p) {
      const Cell cell = cases_on_axis ? Cell{p, s} : Cell{s, p};
      AddPoint(one, static_cast<double>(p), Point(cell, measure));
    }
  }
  return figure;
}

report::StudyTable Comparison::TableOf(std::string caption, std::string kind,
                                       std::span<const NamedCell> rows,
                                       std::span<const std::string_view> measures) const {
  report::StudyTable table{
      .caption = fmt::format("{}: means over {} seeds [95 % confidence intervals]",
                             std::move(caption), seeds_),
      .columns = {std::move(kind)}};
  for (const std::string_view measure : measures) {
    const ComparedMetric& info = ComparedMetrics()[PlaceOfMetric(measure)];
    table.columns.push_back(info.unit.empty() ? info.name
                                              : fmt::format("{} ({})", info.name, info.unit));
  }
  for (const auto& [name, cell] : rows) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(name);
    for (const std::string_view measure : measures) {
      row.push_back(measure == "collided" ? Text(Collisions(cell)) : Text(Mean(cell, measure)));
    }
  }
  return table;
}

report::StudyTable Comparison::TableOfCase(std::size_t test_case,
                                           std::span<const std::string_view> measures) const {
  std::vector<NamedCell> rows;
  for (std::size_t v = 0; v < variants_.size(); ++v) {
    rows.push_back({variants_[v].name, {test_case, v}});
  }
  return TableOf(cases_[test_case].name, "variant", rows, measures);
}

report::StudyTable Comparison::TableOfVariant(std::size_t variant,
                                              std::span<const std::string_view> measures) const {
  std::vector<NamedCell> rows;
  for (std::size_t c = 0; c < cases_.size(); ++c) rows.push_back({cases_[c].name, {c, variant}});
  return TableOf(variants_[variant].name, "case", rows, measures);
}

void AddPoint(report::StudySeries& series, double x, const Estimate& estimate) {
  series.x.push_back(x);
  series.y.push_back(estimate.mean);
  series.low.push_back(estimate.low);
  series.high.push_back(estimate.high);
}

std::string NameForReaders(std::string_view measure) {
  constexpr std::pair<std::string_view, std::string_view> kNames[] = {
      {"si_pct", "safety improvement (SI)"},
      {"si_until_recovery_pct", "safety improvement until the tracks have recovered"},
      {"rhe_pct", "redundant human engagement (RHE)"},
      {"collided", "collision probability"},
      {"mean_compromised_safety_fog_m", "mean compromised safety in fog"},
      {"mean_compromised_safety_until_recovery_m",
       "mean compromised safety until the track has recovered"},
      {"max_compromised_safety_m", "worst compromised safety"},
      {"max_compromised_safety_until_recovery_m",
       "worst compromised safety until the track has recovered"},
      {"max_handover_jerk_mps3", "largest jerk at a hand-over"},
      {"max_handover_jerk_1s_mps3", "largest jerk at a hand-over, averaged over 1 s"},
      {"max_handover_jump_mps2", "largest jump of the command at a hand-over"},
      {"max_abs_jerk_mps3", "largest jerk"},
      {"max_abs_jerk_1s_mps3", "largest jerk, averaged over 1 s"},
      {"rms_jerk_mps3", "RMS jerk"},
      {"min_follower_ttc_s", "follower's smallest time to collision"},
      {"max_follower_drac_mps2", "follower's largest DRAC"},
      {"min_host_ttc_s", "host's smallest time to collision"},
      {"max_host_drac_mps2", "host's largest DRAC"},
      {"min_host_gap_m", "host's smallest gap"},
      {"min_follower_gap_m", "follower's smallest gap"},
      {"human_time_s", "driving time of the human"},
      {"wrong_human_s", "driving time of the human while the LiDAR is right"},
      {"wrong_automation_s", "driving time of the automation on a wrong track"},
      {"rms_fusion_error_m", "RMS error of the fused distance"},
  };
  for (const auto& [name, text] : kNames) {
    if (name == measure) return std::string(text);
  }
  return std::string(measure);
}

}  // namespace fogline::study
