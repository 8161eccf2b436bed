#include "tools/calibrate/calibrate.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "common/errors.h"
#include "tools/calibrate/minimise.h"

namespace fogline::calibrate {
namespace {

// Share of the evaluations that the search in the whole range gets. The search around the best
// point gets the rest.
constexpr double kGlobalPart = 0.6;
// A table with at most this objective meets the target: with weights of 1, each number differs by
// at most 0.001 points from the target.
constexpr double kMet = 1e-6;
// To find the sensitivity of the table to a field, the field is changed by this share of its range
// in both directions.
constexpr double kHalfStep = 0.005;

/// One search. It evaluates points and keeps the best one. A point gives each field as a share of
/// the field's range.
class Search {
 public:
  Search(const Objective& objective, const GoOn& go_on, const SearchProgress& progress)
      : objective_(objective), go_on_(go_on), progress_(progress) {}

  bool found() const { return !result_.values.empty(); }
  /// The reason why the first refused scenario cannot run; "" if no scenario was refused.
  const std::string& refusal() const { return refusal_; }
  Calibration TakeResult() { return std::move(result_); }

  /// Evaluates the first point. The first Run() starts at this point.
  void Begin(std::vector<double> shares) {
    best_shares_ = std::move(shares);
    Try(best_shares_);
  }

  /// Continues from the best point until `until` evaluations have been made in total.
  void Run(Reach reach, int until) {
    const bool met = found() && result_.best.objective <= kMet;
    if (result_.interrupted || met || until <= result_.evaluations) return;
    Minimise(
        reach, [this](const std::vector<double>& shares) { return Try(shares); }, best_shares_,
        kMet, until - result_.evaluations);
  }

 private:
  /// The objective at a point; nullopt when interrupted.
  std::optional<double> Try(const std::vector<double>& shares) {
    std::vector<double> values = objective_.ValuesAt(shares);
    std::optional<Evaluation> evaluation = objective_.Evaluate(values, go_on_);
    if (!evaluation) {
      result_.interrupted = true;
      return std::nullopt;
    }
    const double reached = evaluation->objective;
    const bool at_start = ++result_.evaluations == 1;
    if (!evaluation->refusal.empty()) {
      if (refusal_.empty()) refusal_ = evaluation->refusal;
      return reached;
    }
    if (at_start) result_.objective_at_start = reached;
    if (!found() || reached < result_.best.objective) {
      result_.values = std::move(values);
      result_.best = *std::move(evaluation);
      best_shares_ = shares;
    }
    progress_(result_.evaluations, result_.best.objective);
    return reached;
  }

  const Objective& objective_;
  const GoOn& go_on_;
  const SearchProgress& progress_;
  Calibration result_;
  std::vector<double> best_shares_;
  std::string refusal_;
};

}  // namespace

std::optional<Calibration> Calibrate(const Objective& objective, int max_evaluations,
                                     const GoOn& go_on, const SearchProgress& progress) {
  const CalibrationProblem& problem = objective.problem();
  std::vector<double> start;
  for (const FreeField& field : problem.fields) {
    start.push_back(field.ShareOf(field.Get(problem.scenario)));
  }
  Search search(objective, go_on, progress);
  search.Begin(std::move(start));
  search.Run(Reach::kWholeRange, static_cast<int>(kGlobalPart * max_evaluations));
  search.Run(Reach::kAroundStart, max_evaluations);
  if (search.found()) return search.TakeResult();
  if (!search.refusal().empty()) throw InputError(search.refusal());
  return std::nullopt;
}

namespace {

/// A value below and a value above `value`. They differ from `value` by half a percent of the
/// range, or by one for an integer. Both values are within the limits of the field. So at a limit
/// one of these values equals `value`.
std::pair<double, double> Around(const FreeField& field, double value) {
  if (field.is_integer()) {
    return {std::max(field.lowest(), value - 1), std::min(field.highest(), value + 1)};
  }
  const double share = field.ShareOf(value);
  return {field.ValueAt(share - kHalfStep), field.ValueAt(share + kHalfStep)};
}

std::optional<double> Slope(const stats::Statistics& below, const stats::Statistics& above,
                            double percent) {
  if (!below.mean() || !above.mean()) return std::nullopt;
  return (*above.mean() - *below.mean()) / percent;
}

}  // namespace

std::optional<SensitivityTable> Sensitivities(const Objective& objective,
                                              const std::vector<double>& values,
                                              const GoOn& go_on) {
  SensitivityTable all;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const FreeField& field = objective.problem().fields[i];
    const auto [low, high] = Around(field, values[i]);
    std::vector<double> moved = values;
    moved[i] = low;
    const auto below = objective.Evaluate(moved, go_on);
    moved[i] = high;
    const auto above = objective.Evaluate(moved, go_on);
    if (!below || !above) return std::nullopt;
    const double percent = 100 * (field.ShareOf(high) - field.ShareOf(low));
    std::vector<Change>& changes = all.emplace_back(objective.problem().target.size());
    for (std::size_t row = 0; row < std::min(below->rows.size(), above->rows.size()); ++row) {
      changes[row] = {
          .si_pct = Slope(below->rows[row].si_pct, above->rows[row].si_pct, percent),
          .rhe_pct = Slope(below->rows[row].rhe_pct, above->rows[row].rhe_pct, percent)};
    }
  }
  return all;
}

}  // namespace fogline::calibrate
