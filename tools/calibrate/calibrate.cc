#include "tools/calibrate/calibrate.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <string>
#include <utility>

#include <nlopt.hpp>

#include "common/errors.h"

namespace fogline::calibrate {
namespace {

// The search of the whole range gets this share of the evaluations.
constexpr double kGlobalPart = 0.6;
// The table counts as met when every number is within a thousandth of a point.
constexpr double kMet = 1e-6;
// The local search begins with steps of this share of each range. It ends when its steps are as
// small as the rounding of the values.
constexpr double kLocalStep = 0.05;
constexpr double kSmallestStep = 1e-6;
// A sensitivity varies a field by this share of its range to either side.
constexpr double kHalfStep = 0.005;

/// One search. It evaluates points and keeps the best one. A point gives each field as a share of
/// the field's range.
class Search {
 public:
  Search(const Objective& objective, const GoOn& go_on, const SearchProgress& progress)
      : objective_(objective), go_on_(go_on), progress_(progress) {}

  bool found() const { return !result_.values.empty(); }
  /// Reason of the first scenario that cannot run; "" if there is none.
  const std::string& refusal() const { return refusal_; }
  Calibration TakeResult() { return std::move(result_); }

  /// Evaluates the point at which Run() starts as long as no better point is known.
  void Begin(std::vector<double> shares) {
    best_shares_ = std::move(shares);
    try {
      Try(best_shares_);
    } catch (const nlopt::forced_stop&) {
      // The result already says that the search was interrupted.
    }
  }

  /// Lets an algorithm of NLopt continue from the best point until `until` evaluations have been
  /// made in total.
  void Run(nlopt::algorithm algorithm, int until) {
    const bool met = found() && result_.best.objective <= kMet;
    if (result_.interrupted || met || until <= result_.evaluations) return;
    nlopt::opt optimizer(algorithm, static_cast<unsigned>(best_shares_.size()));
    optimizer.set_lower_bounds(0);
    optimizer.set_upper_bounds(1);
    optimizer.set_min_objective(
        [](const std::vector<double>& shares, std::vector<double>&, void* search) {
          return static_cast<Search*>(search)->Guarded(shares);
        },
        this);
    optimizer.set_stopval(kMet);
    optimizer.set_maxeval(until - result_.evaluations);
    optimizer.set_xtol_abs(kSmallestStep);
    optimizer.set_initial_step(kLocalStep);
    std::vector<double> shares = best_shares_;
    double reached = 0;
    try {
      optimizer.optimize(shares, reached);
    } catch (const nlopt::forced_stop&) {
      if (failure_) std::rethrow_exception(failure_);
    } catch (const nlopt::roundoff_limited&) {
      // The precision of the numbers allows no further progress. The best point so far stays.
    }
  }

 private:
  /// The objective at a point. @throws nlopt::forced_stop when interrupted
  double Try(const std::vector<double>& shares) {
    std::vector<double> values;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      values.push_back(objective_.problem().fields[i].ValueAt(shares[i]));
    }
    std::optional<Evaluation> evaluation = objective_.Evaluate(values, go_on_);
    if (!evaluation) {
      result_.interrupted = true;
      throw nlopt::forced_stop();
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

  /// NLopt lets only its own exceptions pass. This function stores any other exception in failure_.
  double Guarded(const std::vector<double>& shares) {
    try {
      return Try(shares);
    } catch (const nlopt::forced_stop&) {
      throw;
    } catch (...) {
      failure_ = std::current_exception();
      throw nlopt::forced_stop();
    }
  }

  const Objective& objective_;
  const GoOn& go_on_;
  const SearchProgress& progress_;
  Calibration result_;
  std::vector<double> best_shares_;
  std::string refusal_;
  std::exception_ptr failure_;
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
  // DIRECT-L (Gablonsky & Kelley 2001) divides the range and uses no random numbers. Subplex (Rowan
  // 1990) copes with the jumps of J where the human drives one time step more or less.
  search.Run(nlopt::GN_DIRECT_L, static_cast<int>(kGlobalPart * max_evaluations));
  search.Run(nlopt::LN_SBPLX, max_evaluations);
  if (search.found()) return search.TakeResult();
  if (!search.refusal().empty()) throw InputError(search.refusal());
  return std::nullopt;
}

namespace {

/// The value below and the value above: half a percent of the range away, or one for an integer.
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
