// Distance of a scenario's table from a target table. A calibration minimises this distance.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenario/sections/scenario.h"
#include "tools/calibrate/free_field.h"
#include "tools/calibrate/target.h"
#include "tools/stats/statistics.h"
#include "tools/sweep/plan.h"

namespace fogline::calibrate {

/// Input of a calibration.
struct CalibrationProblem {
  std::string file = "scenario";  // source of the scenario, for messages
  Scenario scenario;
  std::vector<FreeField> fields;
  std::vector<TargetRow> target;
  sweep::SeedRange seeds;
  /// `rhe_weight` is the weight of a squared residual of RHE, w_r. `spread_weight` is the weight of
  /// the variance of SI over the seeds, w_s. The weight of a squared residual of SI is 1.
  double rhe_weight = 1;
  double spread_weight = 0.01;
  /// Whether the gaps are computed from the other fields (steady_start.h).
  bool steady = false;
  /// Number of threads. It does not change the result.
  int jobs = 1;
};

/// A field and its value.
struct FieldValue {
  std::string pointer;
  double value = 0;
};

/// A row of the table over all seeds.
struct TableRow {
  stats::Statistics
      si_pct;  // only of seeds that have SI; SI needs compromised safety in the paired run
  stats::Statistics rhe_pct;
};

struct Evaluation {
  std::vector<TableRow> rows;  // one for each row of the target
  double objective = 0;        // square points
  std::string refusal;         // why the scenario cannot run; then `rows` is empty
};

/// Called from time to time during the work; it returns false to stop the work.
using GoOn = std::function<bool()>;

/// The objective of the search
///
///   J = sum over rows of [(mean SI - SI*)^2 + w_s var SI + w_r (mean RHE - RHE*)^2]
///
/// in square points. SI* and RHE* are the target's values; w_s and w_r are spread_weight and
/// rhe_weight of the problem. Every evaluation uses the same seeds (common random numbers), so J
/// changes only with the fields. A seed may have no SI, for example because its run without traded
/// control has no compromised safety in fog. The residual of such a seed is 1000 points, the
/// largest magnitude that a published SI may have. So J is large if the values of the fields
/// prevent all compromised safety.
class Objective {
 public:
  /// @throws InputError if the scenario's policy does not use the threshold, or if a free field is
  /// also a derived field
  explicit Objective(CalibrationProblem problem);

  /// The table with these values of the free fields, and its objective. Each value must be within
  /// its bounds. The result is empty if `go_on` returned false.
  std::optional<Evaluation> Evaluate(std::span<const double> values, const GoOn& go_on) const;

  /// The values of the free fields at a point. The point gives each field as a share of its range.
  std::vector<double> ValuesAt(std::span<const double> shares) const;
  /// The problem's scenario with these values. @throws InputError as StartSteadily()
  Scenario With(std::span<const double> values) const;
  /// All fields that With() sets: the free fields, then the derived fields. @throws InputError as
  /// With()
  std::vector<FieldValue> Changes(std::span<const double> values) const;

  const CalibrationProblem& problem() const { return problem_; }

 private:
  /// The values of the free fields for messages, such as "/fog/bias_m=0.3".
  std::string NameOf(std::span<const double> values) const;
  double Sum(const std::vector<TableRow>& rows) const;

  CalibrationProblem problem_;
  sweep::Axis thresholds_;
};

}  // namespace fogline::calibrate
