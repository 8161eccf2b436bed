// Detectors in the fog of one visibility: the records of their scores, AUC and ROC.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/study/detection/runs/clear_air.h"

namespace fogline::study {

/// Number of batches of the runs in clear air and in fog. AUC and ROC compare each run in fog with
/// the runs in clear air of the same batch.
inline constexpr std::int64_t kBatches = 10;
/// False positive rates for the ROC: shares of the steps in clear air.
inline constexpr std::array kFalsePositives{0.001, 0.002, 0.005, 0.01, 0.02,
                                            0.05,  0.1,   0.2,   0.5,  1.0};

/// Scores of one detector in clear air, by batch, sorted.
using SortedBatches = std::vector<std::vector<double>>;

/// The sorted scores of every detector.
/// @param by_detector runs whose scores were kept (ClearAirPlan::keeps_scores)
std::vector<SortedBatches> SortScores(std::span<const std::vector<ClearRun>> by_detector);

/// Means of a value over the runs of each batch. Batches are independent of each other, because
/// each has its own runs in fog and in clear air.
class BatchMeans {
 public:
  explicit BatchMeans(std::size_t batches) : sums_(batches, 0.0), counts_(batches, 0.0) {}
  void Add(std::size_t batch, double value) {
    sums_[batch] += value;
    counts_[batch] += 1;
  }
  std::vector<double> Result() const {
    std::vector<double> means = sums_;
    for (std::size_t i = 0; i < means.size(); ++i) means[i] /= counts_[i];
    return means;
  }

 private:
  std::vector<double> sums_;
  std::vector<double> counts_;
};

/// Results of one detector over the seeds of one condition.
struct Gathered {
  explicit Gathered(std::size_t batches)
      : auc(batches), true_positives(kFalsePositives.size(), BatchMeans(batches)) {}
  std::vector<ScoreRecords> records;
  BatchMeans auc;
  std::vector<BatchMeans> true_positives;
};

/// Runs every detector in this traffic with the study's seeds. Calls `show` after each run.
/// @param clear_scores by detector
/// @throws what `show` throws
std::vector<Gathered> RunInFog(const StudyContext& context, const Traffic& traffic,
                               std::span<const SortedBatches> clear_scores, const ShowUnit& show);

/// The records of some detectors in this traffic, by detector and seed. Calls `show` after each
/// run. @param detectors indices in Detectors() @throws what `show` throws
std::vector<std::vector<ScoreRecords>> RecordsInFog(const StudyContext& context,
                                                    const Traffic& traffic,
                                                    std::span<const std::size_t> detectors,
                                                    const ShowUnit& show);

}  // namespace fogline::study
