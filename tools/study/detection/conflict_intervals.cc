#include "tools/study/detection/conflict_intervals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/metrics/event_share.h"
#include "tools/study/bootstrap.h"

namespace fogline::study {
namespace {

// Random streams of the resamples. Streams below 1000 belong to roles, 1000 and 1001 to study
// threshold.
constexpr Stream kClearAir{1002};
constexpr Stream kFog{1003};

/// Delay and detection of one measure at one threshold, by visibility, with weights of the seeds.
struct Detection {
  std::vector<double> delay_s;
  std::vector<double> share;
  double mean_delay_s = 0;
};

Detection DetectionAt(const DetectorRuns& runs, double threshold, std::span<const double> weights,
                      double missed_s) {
  Detection detection;
  for (const std::vector<ScoreRecords>& seeds : runs.fog) {
    double delay_s = 0;
    double detected = 0;
    double all = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (weights[i] == 0) continue;
      const std::optional<double> alarm = FirstAlarm(seeds[i], threshold);
      delay_s += weights[i] * alarm.value_or(missed_s);
      detected += alarm ? weights[i] : 0;
      all += weights[i];
    }
    detection.delay_s.push_back(delay_s / all);
    detection.share.push_back(detected / all);
    detection.mean_delay_s += delay_s / all / static_cast<double>(runs.fog.size());
  }
  return detection;
}

/// The replicates of one measure.
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

/// The interval of a - b, from the differences of the replicates.
template <class Value>
Estimate Difference(const Detection& all_a, const Replicates& a, const Detection& all_b,
                    const Replicates& b, std::int64_t seeds, const Value& value) {
  std::vector<double> differences = a.Of(value);
  const std::vector<double> others = b.Of(value);
  for (std::size_t i = 0; i < differences.size(); ++i) differences[i] -= others[i];
  return FromReplicates(seeds, value(all_a) - value(all_b), std::move(differences));
}

}  // namespace

std::vector<DetectionComparison> CompareDetection(std::span<const DetectorRuns> detectors,
                                                  std::optional<std::size_t> reference,
                                                  double arl_zero_s, double missed_s) {
  if (detectors.empty()) return {};
  const std::size_t clear_runs = detectors.front().clear.size();
  const std::size_t seeds = detectors.front().fog.front().size();
  std::vector<ThresholdFinder> finders;
  std::vector<Detection> all;
  const std::vector<double> once(seeds, 1.0);
  for (const DetectorRuns& runs : detectors) {
    const ThresholdFinder& finder = finders.emplace_back(runs.clear);
    all.push_back(DetectionAt(runs, finder.Threshold(arl_zero_s), once, missed_s));
  }
  const Resampling clear_air(clear_runs, kClearAir);
  const Resampling fog(seeds, kFog);
  std::vector<Replicates> replicates(detectors.size());
  std::vector<double> clear_weights;
  std::vector<double> fog_weights;
  for (std::int64_t k = 0; k < kReplicates; ++k) {
    clear_air.Draw(k, clear_weights);
    fog.Draw(k, fog_weights);
    for (std::size_t d = 0; d < detectors.size(); ++d) {
      const double threshold = finders[d].Threshold(clear_weights, arl_zero_s);
      replicates[d].of.push_back(DetectionAt(detectors[d], threshold, fog_weights, missed_s));
    }
  }
  const auto n = static_cast<std::int64_t>(seeds);
  std::vector<DetectionComparison> result;
  for (std::size_t d = 0; d < detectors.size(); ++d) {
    DetectionComparison& one = result.emplace_back();
    one.detector = MeansOf(all[d], replicates[d], n);
    one.delay_minus_other_s.resize(all[d].delay_s.size());
    if (!reference) continue;
    const auto difference = [&](const auto& value) {
      return Difference(all[d], replicates[d], all[*reference], replicates[*reference], n, value);
    };
    for (std::size_t v = 0; v < one.delay_minus_other_s.size(); ++v) {
      one.delay_minus_other_s[v] = difference([&](const Detection& e) { return e.delay_s[v]; });
    }
    one.mean_delay_minus_other_s = difference([](const Detection& e) { return e.mean_delay_s; });
  }
  return result;
}

}  // namespace fogline::study
