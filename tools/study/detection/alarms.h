// Computes results of detectors from their scores: alarms, thresholds that give all detectors the
// same rate of false alarms, the area under the ROC curve, and the share of steps in fog that a
// threshold detects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace fogline::study {

/// A score of a run that is above all earlier scores of this run, and its time in s since the end
/// of the warm-up.
struct ScoreRecord {
  double score;
  double time_s;
};
/// The records of a run, ascending in score and time. The records suffice to find the first alarm
/// for any threshold.
using ScoreRecords = std::vector<ScoreRecord>;
/// Adds a score if it is a record.
void AddScore(double score, double time_s, ScoreRecords& records);
/// Time in s at which a score first reaches the threshold; nullopt if no score reaches it.
std::optional<double> FirstAlarm(const ScoreRecords& records, double threshold);

/// Scores of a detector in a run in clear air, after the warm-up.
struct ClearRun {
  ScoreRecords records;
  std::vector<double> scores;  // of every kClearStride-th step; empty if they are not needed
  double duration_s = 0;
};

/// Count of alarms in runs in clear air; each run ends at its first alarm.
struct AlarmCount {
  std::int64_t alarms = 0;
  double time_s = 0;  // total time of all runs until their alarm or end

  /// Mean time to a false alarm (ARL0), s: the total time divided by the number of alarms. This
  /// estimate assumes that the times have an exponential distribution. The time of a run without an
  /// alarm is its whole length (a censored time). The mean time is infinite if no run has an alarm.
  double ArlZero_s() const;
  /// Exact 95 % bounds of the mean time to a false alarm (chi-square; Garwood 1936).
  std::pair<double, double> ArlZeroBounds_s() const;
  /// Whether a mean time is within ArlZeroBounds_s().
  bool MayHave(double arl_zero_s) const;
};
AlarmCount CountAlarms(std::span<const ClearRun> runs, double threshold);

/// Finds thresholds from runs in clear air. The weights of the runs may differ from call to call.
class ThresholdFinder {
 public:
  explicit ThresholdFinder(std::span<const ClearRun> runs);

  /// The smallest threshold with at least this mean time to a false alarm. The weight of a run is
  /// the number of times that the run counts. If a measure has its greatest score too often, the
  /// threshold is above all scores of the measure. Then the measure gives no alarm in these runs.
  double Threshold(std::span<const double> weights, double arl_zero_s) const;
  /// The threshold with weight 1 for each run.
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

/// Probability that a random score in fog is above a random score in clear air. Equal scores count
/// half. This is the area under the ROC curve (Mann & Whitney 1947). @param clear sorted
double AreaUnderRoc(std::span<const double> fog, std::span<const double> clear);

/// Share of the scores in fog that are above a threshold. The threshold is as low as possible, but
/// at most the share `false_positives` of the scores in clear air may be above it. @param clear
/// sorted
double TruePositives(std::span<const double> fog, std::span<const double> clear,
                     double false_positives);

}  // namespace fogline::study
