// Measures of conflict as detectors of fog: all of them on the evidence of one run, thresholds at
// an equal false-alarm rate, and what they then detect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/scenario.h"
#include "services/closed_loop/closed_loop.h"
#include "services/conflict/measures.h"
#include "services/conflict/parameters.h"
#include "services/policies/evidence.h"

namespace fogline {

/// Parameters of the measures in a scenario. What the scenario says nothing of follows the noise of
/// its sensors, as the defaults do that of theirs: bins are as wide as the larger standard
/// deviation of the two, and the SPRT looks for the shift that the CUSUM looks for, 2 kappa
/// standard deviations of the difference. With fixed ones a test would be tuned to one noise of
/// several.
ConflictParameters DetectorParameters(const Scenario& scenario);

/// The measure of which another is the same test under DetectorParameters(), for what is to be
/// counted once. The SPRT's ratio is held at its lower bound, and looks for the shift that the
/// CUSUM looks for: above that bound it is the sum of the CUSUM times 2 kappa (Page 1954), as long
/// as it is below its ceiling and once it has been at the bound. "" for all others.
std::string_view TwinOf(std::string_view measure);

/// Runs scenarios and gives every measure of conflict the evidence of each step. For one thread.
class DetectorBench {
 public:
  /// Calls `visit(truth, scores)` after each step, with the scores in the order of
  /// ConflictMeasures().
  template <class Visit>
  void Run(const Scenario& scenario, std::int64_t seed, Visit&& visit) {
    Prepare(scenario, seed);
    loop_->Run(0, [&](const StepView& step) {
      const Evidence evidence{
          .radar = StatedBy(step.radar),
          .lidar = StatedBy(step.lidar),
          .prediction = witness_->Prediction(step.track, step.radar, step.lidar)};
      for (std::size_t i = 0; i < measures_.size(); ++i) scores_[i] = measures_[i]->Step(evidence);
      visit(step.truth, std::span<const double>(scores_));
    });
  }

 private:
  void Prepare(const Scenario& scenario, std::int64_t seed);

  Scenario scenario_;
  std::optional<ClosedLoop> loop_;
  std::optional<Witness> witness_;
  std::vector<std::unique_ptr<ConflictMeasure>> measures_;
  std::vector<double> scores_;
};

/// A score above all before it, and when, s after the begin.
struct ScoreRecord {
  double score;
  double time_s;
};
/// The records of a run, ascending in both: enough to know when a measure would first have given an
/// alarm, whatever the threshold.
using ScoreRecords = std::vector<ScoreRecord>;
/// Adds a score if it is a record.
void AddScore(double score, double time_s, ScoreRecords& records);
/// When a threshold is first reached; nullopt if never.
std::optional<double> FirstAlarm(const ScoreRecords& records, double threshold);

/// What a measure does in a run in clear air after its warm-up.
struct ClearRun {
  ScoreRecords records;
  std::vector<double> scores;  // every so many steps
  double duration_s = 0;
};

/// Alarms of runs in clear air that each end at the first one.
struct AlarmCount {
  std::int64_t alarms = 0;
  double time_s = 0;  // at risk, of all runs

  /// Mean time to a false alarm (ARL0), s: that of an exponential distribution, of which runs that
  /// end without an alarm tell a part. Infinite without an alarm.
  double ArlZero_s() const;
  /// Exact 95 % bounds of it (chi-square; Garwood 1936).
  std::pair<double, double> ArlZeroBounds_s() const;
  /// Whether a mean time is within these bounds.
  bool MayHave(double arl_zero_s) const;
};
AlarmCount CountAlarms(std::span<const ClearRun> runs, double threshold);

/// Finds thresholds in runs in clear air, again and again with other weights.
class ThresholdFinder {
 public:
  explicit ThresholdFinder(std::span<const ClearRun> runs);

  /// The least threshold with at least this mean time to a false alarm where each run counts as
  /// often as its weight says. A score that is at its greatest value too often has a threshold
  /// above all its scores: it never gives an alarm in these runs.
  double Threshold(std::span<const double> weights, double arl_zero_s) const;
  /// Where each run counts once.
  double Threshold(double arl_zero_s) const;

 private:
  struct Record {
    double score;
    double time_s;
    std::size_t run;
  };
  std::vector<Record> records_;  // of all runs, the greatest score first
  std::vector<double> durations_s_;
};

/// Probability that a score in fog is above one in clear air, equal ones counted half: the area
/// under the ROC (Mann & Whitney 1947). @param clear sorted
double AreaUnderRoc(std::span<const double> fog, std::span<const double> clear);

/// Share of scores in fog above a threshold that at most a share `false_positives` of those in
/// clear air are above. @param clear sorted
double TruePositives(std::span<const double> fog, std::span<const double> clear,
                     double false_positives);

}  // namespace fogline
