#include "tools/study/detection/alarms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <boost/math/distributions/chi_squared.hpp>

#include "tools/study/estimate.h"

namespace fogline::study {

void AddScore(double score, double time_s, ScoreRecords& records) {
  if (records.empty() || score > records.back().score) records.push_back({score, time_s});
}

std::optional<double> FirstAlarm(const ScoreRecords& records, double threshold) {
  const auto first = std::ranges::lower_bound(records, threshold, {}, &ScoreRecord::score);
  if (first == records.end()) return std::nullopt;
  return first->time_s;
}

double AlarmCount::ArlZero_s() const {
  if (alarms == 0) return std::numeric_limits<double>::infinity();
  return time_s / static_cast<double>(alarms);
}

std::pair<double, double> AlarmCount::ArlZeroBounds_s() const {
  using Chi2 = boost::math::chi_squared;
  const auto count = static_cast<double>(alarms);
  const double most = quantile(complement(Chi2(2 * count + 2), kTail)) / 2;
  const double upper = alarms == 0 ? std::numeric_limits<double>::infinity()
                                   : time_s / (quantile(Chi2(2 * count), kTail) / 2);
  return {time_s / most, upper};
}

bool AlarmCount::MayHave(double arl_zero_s) const {
  const auto [low, high] = ArlZeroBounds_s();
  return low <= arl_zero_s && arl_zero_s <= high;
}

AlarmCount CountAlarms(std::span<const ClearRun> runs, double threshold) {
  AlarmCount count;
  for (const ClearRun& run : runs) {
    const std::optional<double> alarm = FirstAlarm(run.records, threshold);
    count.alarms += alarm ? 1 : 0;
    count.time_s += alarm.value_or(run.duration_s);
  }
  return count;
}

ThresholdFinder::ThresholdFinder(std::span<const ClearRun> runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    durations_s_.push_back(runs[i].duration_s);
    for (const ScoreRecord& record : runs[i].records) {
      records_.push_back({.score = record.score, .time_s = record.time_s, .run = i});
    }
  }
  std::ranges::stable_sort(records_, std::ranges::greater(), &Record::score);
}

double ThresholdFinder::Threshold(double arl_zero_s) const {
  return Threshold(std::vector<double>(durations_s_.size(), 1.0), arl_zero_s);
}

// The search starts with a threshold above all scores, and lowers it score by score. At each lower
// threshold some runs end sooner, so the mean time to an alarm falls. The result is just above the
// first score at which this mean time is too short.
double ThresholdFinder::Threshold(std::span<const double> weights, double arl_zero_s) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double alarms = 0;
  double time_s = 0;
  for (std::size_t i = 0; i < durations_s_.size(); ++i) time_s += weights[i] * durations_s_[i];
  std::vector<double> ends_s = durations_s_;
  std::vector<bool> alarmed(durations_s_.size(), false);
  for (auto record = records_.begin(); record != records_.end();) {
    const double score = record->score;
    for (; record != records_.end() && record->score == score; ++record) {
      if (!alarmed[record->run]) alarms += weights[record->run];
      alarmed[record->run] = true;
      time_s += weights[record->run] * (record->time_s - ends_s[record->run]);
      ends_s[record->run] = record->time_s;
    }
    if (time_s < arl_zero_s * alarms) return std::nextafter(score, kInfinite);
  }
  return records_.empty() ? kInfinite : records_.back().score;
}

double AreaUnderRoc(std::span<const double> fog, std::span<const double> clear) {
  double sum = 0;
  for (const double score : fog) {
    const auto [first, last] = std::equal_range(clear.begin(), clear.end(), score);
    sum += static_cast<double>((first - clear.begin()) + (last - clear.begin())) / 2;
  }
  return sum / static_cast<double>(fog.size()) / static_cast<double>(clear.size());
}

double TruePositives(std::span<const double> fog, std::span<const double> clear,
                     double false_positives) {
  const auto above = static_cast<std::size_t>(false_positives * static_cast<double>(clear.size()));
  const double threshold = above >= clear.size() ? -std::numeric_limits<double>::infinity()
                                                 : clear[clear.size() - 1 - above];
  const auto positives = std::ranges::count_if(fog, [&](double s) { return s > threshold; });
  return static_cast<double>(positives) / static_cast<double>(fog.size());
}

}  // namespace fogline::study
