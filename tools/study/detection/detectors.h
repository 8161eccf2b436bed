// Measures of conflict as detectors of fog: all measures get the evidence of the same run,
// thresholds have an equal false-alarm rate, and the detection is compared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/closed_loop/closed_loop.h"
#include "services/decision/conflict/conflict_measures.h"
#include "services/decision/conflict/conflict_parameters.h"
#include "services/decision/policies/conflict_inputs.h"

namespace fogline::study {

/// Parameters of the measures in a scenario. Those that the scenario does not set follow the noise
/// of its sensors, as the defaults follow the default noise. The width of bins is the larger
/// standard deviation of the two sensors. The SPRT tests for the same shift as the CUSUM: 2 kappa
/// standard deviations of the difference. With fixed parameters a test would be tuned to one noise
/// of several.
conflict::ConflictParameters DetectorParameters(const Scenario& scenario);

/// The measure that is the same test as this one under DetectorParameters(), so that both count
/// once; "" if there is none. The SPRT's ratio is held at its lower bound, and the SPRT tests for
/// the shift of the CUSUM. So above that bound the ratio is the sum of the CUSUM times 2 kappa
/// (Page 1954), as long as it is below its ceiling and once it has been at the bound.
std::string_view TwinOf(std::string_view measure);

/// Runs scenarios and gives every measure of conflict the evidence of each step. For use by one
/// thread.
class DetectorBench {
 public:
  /// Calls `visit(truth, scores)` after each step, with the scores in the order of
  /// ConflictMeasures().
  template <class Visit>
  void Run(const Scenario& scenario, std::int64_t seed, Visit&& visit) {
    Prepare(scenario);
    loop_.Run(scenario, seed, [&](const closed_loop::StepView& step) {
      const conflict::Evidence evidence{
          .radar = policies::StatedBy(step.radar),
          .lidar = policies::StatedBy(step.lidar),
          .prediction = witness_->Prediction(step.track, step.radar, step.lidar)};
      for (std::size_t i = 0; i < measures_.size(); ++i) scores_[i] = measures_[i]->Step(evidence);
      visit(step.truth, std::span<const double>(scores_));
    });
  }

 private:
  void Prepare(const Scenario& scenario);

  closed_loop::ReusedLoop loop_;
  std::optional<policies::Witness> witness_;
  std::vector<std::unique_ptr<conflict::ConflictMeasure>> measures_;
  std::vector<double> scores_;
};

/// A score above all earlier ones, and its time in s after the beginning.
struct ScoreRecord {
  double score;
  double time_s;
};
/// The records of a run, ascending in score and time. They suffice to find the first alarm for any
/// threshold.
using ScoreRecords = std::vector<ScoreRecord>;
/// Adds a score if it is a record.
void AddScore(double score, double time_s, ScoreRecords& records);
/// Time at which a threshold is first reached; nullopt if it never is.
std::optional<double> FirstAlarm(const ScoreRecords& records, double threshold);

/// Scores of a measure in a run in clear air after its warm-up.
struct ClearRun {
  ScoreRecords records;
  std::vector<double> scores;  // at regular intervals of steps
  double duration_s = 0;
};

/// Count of alarms in runs in clear air; each run ends at its first alarm.
struct AlarmCount {
  std::int64_t alarms = 0;
  double time_s = 0;  // total time at risk of all runs

  /// Mean time to a false alarm (ARL0), s, for an exponential distribution; runs without an alarm
  /// are censored at their end. Infinite without an alarm.
  double ArlZero_s() const;
  /// Exact 95 % bounds of this mean time (chi-square; Garwood 1936).
  std::pair<double, double> ArlZeroBounds_s() const;
  /// Whether a mean time is within these bounds.
  bool MayHave(double arl_zero_s) const;
};
AlarmCount CountAlarms(std::span<const ClearRun> runs, double threshold);

/// Finds thresholds from runs in clear air, repeatedly with different weights.
class ThresholdFinder {
 public:
  explicit ThresholdFinder(std::span<const ClearRun> runs);

  /// The smallest threshold with at least this mean time to a false alarm, when each run counts as
  /// often as its weight says. If a measure has its greatest score too often, its threshold is
  /// above all its scores: it gives no alarm in these runs.
  double Threshold(std::span<const double> weights, double arl_zero_s) const;
  /// The same with weight 1 for each run.
  double Threshold(double arl_zero_s) const;

 private:
  struct Record {
    double score;
    double time_s;
    std::size_t run;
  };
  std::vector<Record> records_;  // of all runs, in descending order of score
  std::vector<double> durations_s_;
};

/// Probability that a score in fog is above a score in clear air, where equal scores count half:
/// the area under the ROC (Mann & Whitney 1947). @param clear sorted
double AreaUnderRoc(std::span<const double> fog, std::span<const double> clear);

/// Share of scores in fog above a threshold. At most a share `false_positives` of the scores in
/// clear air are above that threshold. @param clear sorted
double TruePositives(std::span<const double> fog, std::span<const double> clear,
                     double false_positives);

}  // namespace fogline::study
