#include "tools/study/detection/conflict_intervals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "services/metrics/event_share.h"
#include "tools/stats/in_order.h"
#include "tools/study/bootstrap.h"

namespace fogline::study {
namespace {

// Random streams of the resamples. Streams below 1000 belong to roles. Streams 1000 and 1001 belong
// to study `threshold`.
constexpr Stream kClearAir{1002};
constexpr Stream kFog{1003};

/// Results of one detector at one threshold. For each visibility: the mean delay, and the share of
/// the fogs that the detector finds. `mean_delay_s` is the mean of the delays over the visibilities
/// of DetectionRule::ranked.
struct Detection {
  std::vector<double> delay_s;
  std::vector<double> share;
  double mean_delay_s = 0;
};

Detection DetectionAt(const DetectorRuns& runs, double threshold, std::span<const double> weights,
                      const DetectionRule& rule) {
  Detection detection;
  for (const std::vector<ScoreRecords>& seeds : runs.fog) {
    double delay_s = 0;
    double detected = 0;
    double all = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (weights[i] == 0) continue;
      const std::optional<double> alarm = FirstAlarm(seeds[i], threshold);
      delay_s += weights[i] * alarm.value_or(rule.missed_s);
      detected += alarm ? weights[i] : 0;
      all += weights[i];
    }
    detection.delay_s.push_back(delay_s / all);
    detection.share.push_back(detected / all);
  }
  for (const std::size_t v : rule.ranked) detection.mean_delay_s += detection.delay_s[v];
  detection.mean_delay_s /= static_cast<double>(rule.ranked.size());
  return detection;
}

/// The detection by one detector in each replicate (resample of the runs).
struct Replicates {
  std::vector<Detection> of;

  /// A quantity of each replicate.
  template <class Value>
  std::vector<double> Of(const Value& value) const {
    std::vector<double> values;
    for (const Detection& one : of) values.push_back(value(one));
    return values;
  }
};

Estimate Share(std::int64_t seeds, double share, std::vector<double> replicates) {
  Estimate estimate = FromReplicates(seeds, share, std::move(replicates));
  const metrics::EventShare exact =
      metrics::ClopperPearson(std::llround(share * static_cast<double>(seeds)), seeds);
  estimate.low = estimate.has_interval() ? std::min(estimate.low, exact.lower) : exact.lower;
  estimate.high = estimate.high >= exact.upper ? estimate.high : exact.upper;
  return estimate;
}

DetectionMeans MeansOf(const Detection& all, const Replicates& replicates, std::int64_t seeds) {
  DetectionMeans means;
  for (std::size_t v = 0; v < all.delay_s.size(); ++v) {
    means.by_visibility.push_back(
        {.delay_s = FromReplicates(seeds, all.delay_s[v],
                                   replicates.Of([&](const Detection& d) { return d.delay_s[v]; })),
         .detection = Share(seeds, all.share[v],
                            replicates.Of([&](const Detection& d) { return d.share[v]; }))});
  }
  means.delay_s = FromReplicates(seeds, all.mean_delay_s,
                                 replicates.Of([](const Detection& d) { return d.mean_delay_s; }));
  return means;
}

/// a - b, replicate by replicate.
std::vector<double> Differences(std::vector<double> a, std::span<const double> b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

/// Computes the detection by every detector, in all runs or in a resample of the runs.
class Resampler {
 public:
  Resampler(std::span<const DetectorRuns> detectors, const DetectionRule& rule)
      : detectors_(detectors), rule_(rule), fog_(detectors.front().fog.front().size(), kFog) {
    for (const DetectorRuns& runs : detectors) {
      finders_.emplace_back(runs.clear);
      clear_air_.try_emplace(runs.clear.size(), runs.clear.size(), kClearAir);
    }
  }

  std::vector<Detection> All() const {
    std::vector<Detection> all;
    for (std::size_t d = 0; d < detectors_.size(); ++d) {
      const std::vector<double> once(detectors_[d].fog.front().size(), 1.0);
      all.push_back(
          DetectionAt(detectors_[d], finders_[d].Threshold(rule_.arl_zero_s), once, rule_));
    }
    return all;
  }

  std::vector<Detection> Replicate(std::int64_t replicate) const {
    std::map<std::size_t, std::vector<double>> clear_weights;
    for (const auto& [runs, resampling] : clear_air_) {
      resampling.Draw(replicate, clear_weights[runs]);
    }
    std::vector<double> fog_weights;
    fog_.Draw(replicate, fog_weights);
    std::vector<Detection> all;
    for (std::size_t d = 0; d < detectors_.size(); ++d) {
      const std::vector<double>& weights = clear_weights[detectors_[d].clear.size()];
      all.push_back(DetectionAt(detectors_[d], finders_[d].Threshold(weights, rule_.arl_zero_s),
                                fog_weights, rule_));
    }
    return all;
  }

 private:
  std::span<const DetectorRuns> detectors_;
  const DetectionRule& rule_;
  std::vector<ThresholdFinder> finders_;
  std::map<std::size_t, Resampling> clear_air_;  // by number of runs
  Resampling fog_;
};

}  // namespace

Estimate DelayDifference(const DetectionComparison& a, const DetectionComparison& b) {
  return FromReplicates(a.detector.delay_s.n, a.detector.delay_s.mean - b.detector.delay_s.mean,
                        Differences(a.mean_delays_s, b.mean_delays_s));
}

std::vector<DetectionComparison> CompareDetection(std::span<const DetectorRuns> detectors,
                                                  const DetectionRule& rule) {
  if (detectors.empty()) return {};
  const Resampler resampler(detectors, rule);
  const std::vector<Detection> all = resampler.All();
  std::vector<Replicates> replicates(detectors.size());
  struct NoState {};
  stats::ComputeInOrder(
      0, kReplicates, rule.jobs, [] { return NoState(); },
      [&](NoState&, std::int64_t k) { return resampler.Replicate(k); },
      [&](std::int64_t, std::vector<Detection> of) {
        for (std::size_t d = 0; d < of.size(); ++d) replicates[d].of.push_back(std::move(of[d]));
        return true;
      });
  const auto seeds = static_cast<std::int64_t>(detectors.front().fog.front().size());
  std::vector<DetectionComparison> result;
  for (std::size_t d = 0; d < detectors.size(); ++d) {
    DetectionComparison& one = result.emplace_back();
    one.detector = MeansOf(all[d], replicates[d], seeds);
    one.mean_delays_s = replicates[d].Of([](const Detection& e) { return e.mean_delay_s; });
    one.delay_minus_other_s.resize(all[d].delay_s.size());
    if (!rule.reference) continue;
    for (std::size_t v = 0; v < one.delay_minus_other_s.size(); ++v) {
      const auto delay = [v](const Detection& e) { return e.delay_s[v]; };
      const std::size_t other = *rule.reference;
      one.delay_minus_other_s[v] =
          FromReplicates(seeds, delay(all[d]) - delay(all[other]),
                         Differences(replicates[d].Of(delay), replicates[other].Of(delay)));
    }
  }
  return result;
}

}  // namespace fogline::study
