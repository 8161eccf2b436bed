// How far a scenario's table is from a target's: what a calibration makes small.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "tools/calibrate/free_field.h"
#include "tools/calibrate/target.h"
#include "tools/sweep/plan.h"
#include "tools/sweep/statistics.h"

namespace fogline {

/// What a calibration starts from.
struct CalibrationProblem {
  std::string file = "scenario";  // where it comes from, for messages
  Scenario scenario;
  std::vector<FreeField> fields;
  std::vector<TargetRow> target;
  SeedRange seeds;
  /// Weight of a squared residual of RHE, and of the variance of SI over the seeds, where that of a
  /// squared residual of SI is 1.
  double rhe_weight = 1;
  double spread_weight = 0.01;
  /// Threads. They change no result.
  int jobs = 1;
};

/// A row of the table over all seeds.
struct TableRow {
  Statistics si_pct;  // of the seeds that have one: SI needs compromised safety in the paired run
  Statistics rhe_pct;
};

struct Evaluation {
  std::vector<TableRow> rows;  // as many as the target has
  double objective = 0;        // square points
  std::string refusal;         // why the scenario cannot run; then there are no rows
};

/// Asked now and then while there is work: false stops it.
using GoOn = std::function<bool()>;

/// The objective
///
///   J = sum over rows of (mean SI - SI*)^2 + w_s var SI + w_r (mean RHE - RHE*)^2
///
/// in square points, with the target's values starred. Every evaluation uses the same seeds (common
/// random numbers), so that J differs only by what the fields do. A seed without SI stands for a
/// residual of 1000 points, SI's whole range: fields that let no compromised safety arise are no
/// way out.
class Objective {
 public:
  /// @throws InputError if no threshold matters to the scenario's policy
  explicit Objective(CalibrationProblem problem);

  /// The table with these values of the free fields, each within its bounds; none if `go_on` said
  /// no.
  std::optional<Evaluation> Evaluate(std::span<const double> values, const GoOn& go_on) const;

  /// The scenario with these values.
  Scenario With(std::span<const double> values) const;

  const CalibrationProblem& problem() const { return problem_; }

 private:
  /// "/fog/bias_m=0.3": the values of the free fields, for messages.
  std::string NameOf(std::span<const double> values) const;
  double Sum(const std::vector<TableRow>& rows) const;

  CalibrationProblem problem_;
  Axis thresholds_;
};

}  // namespace fogline
