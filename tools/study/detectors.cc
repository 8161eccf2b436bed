#include "tools/study/detectors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/math/distributions/chi_squared.hpp>

namespace fogline {
namespace {

constexpr double kTail = 0.025;  // on either side of an interval of 95 %

// Halvings of the range of scores: to the last bit of a double.
constexpr int kHalvings = 60;

}  // namespace

void DetectorBench::Prepare(const Scenario& scenario, std::int64_t seed) {
  scenario_ = scenario;
  scenario_.seed = seed;
  if (loop_) {
    loop_->Restart(scenario_);
  } else {
    loop_.emplace(scenario_);
  }
  witness_.emplace(scenario_.fusion);
  const ConflictParameters parameters = ConflictParametersOf(scenario_.arbitrator);
  measures_.clear();
  for (const ConflictMeasureRow& row : ConflictMeasures()) {
    measures_.push_back(row.make(parameters));
  }
  scores_.resize(measures_.size());
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

AlarmCount CountAlarms(std::span<const ClearRun> runs, double threshold) {
  AlarmCount count;
  for (const ClearRun& run : runs) {
    const auto first = std::ranges::find_if(
        run.records, [&](const ClearRun::Record& record) { return record.score >= threshold; });
    const bool alarm = first != run.records.end();
    count.alarms += alarm ? 1 : 0;
    count.time_s += alarm ? first->time_s : run.duration_s;
  }
  return count;
}

// Alarms come sooner the lower the threshold, so the mean time to one falls with it.
double CalibrateThreshold(std::span<const ClearRun> runs, double arl_zero_s) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const ClearRun& run : runs) {
    if (run.records.empty()) continue;
    low = std::min(low, run.records.front().score);
    high = std::max(high, run.records.back().score);
  }
  if (!(low <= high)) return low;
  high = std::nextafter(high, std::numeric_limits<double>::infinity());
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::midpoint(low, high);
    if (CountAlarms(runs, middle).ArlZero_s() >= arl_zero_s) {
      high = middle;
    } else {
      low = middle;
    }
  }
  return high;
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

}  // namespace fogline
