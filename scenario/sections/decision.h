// The policies, the measures of conflict and the measures of blame that a scenario may choose.
// services/decision has a table for each of these three lists. The compiler checks that each list
// and its table have the same names in the same order.
#pragma once

#include <array>
#include <cstddef>

#include "scenario/sections/decision_types.h"
#include "scenario/sections/field.h"

namespace fogline {

constexpr auto ChoicesOf(Policy) {
  return std::to_array<Choice>({
      {"none", "lambda_A = 1 throughout: no traded control"},
      {"traded", "the human drives while DoC >= threshold"},
      {"isolate", "the automation drives, without the sensor that is to blame"},
      {"oracle", "the automation drives, on the sensor that is nearer to the truth"},
      {"blend", "both drive, the human in proportion to the conflict"},
      {"adaptive", "as traded, with a threshold that moves with the situation"},
      {"bayes", "as traded, with the threshold of least expected cost"},
      {"availability", "as isolate, and as traded if the driver can take over in time"},
      {"traded_isolating", "as traded; the automation drives without the sensor that is to blame"},
  });
}
static_assert(ChoiceNames<Policy>::kNames[static_cast<std::size_t>(Policy::kNone)] == "none");
static_assert(ChoiceNames<Policy>::kNames[static_cast<std::size_t>(Policy::kTraded)] == "traded");

constexpr auto ChoicesOf(MeasureChoice) {
  return std::to_array<Choice>({
      {"doc", "1/(1 + exp(-doc_slope_per_m (z - doc_centre_m))), z the windowed |radar - LiDAR|"},
      {"nis", "d^2/S of the step"},
      {"nis_window", "mean of d^2/S over the window"},
      {"nis_signed", "sum of d/sqrt(S) over the window, over sqrt(n): LiDAR short > 0"},
      {"bhattacharyya", "d^2/(4 S): the part of the means"},
      {"hellinger", "sqrt(1 - exp(-d^2/(4 S))): the part of the means"},
      {"dempster_bins", "k, mass on disjoint bins"},
      {"jousselme_bins", "d_J, distance under |A and B|/|A or B|, on bins"},
      {"pignistic_bins", "difBetP, largest difference of pignistic probability, on bins"},
      {"cosine_bins", "1 - cosine of the masses, on bins"},
      {"correlation_bins", "1 - r, cosine under |A and B|/|A or B|, on bins"},
      {"dempster_consonant", "k(d) = P(s1 Y1 + s2 Y2 < |d|), Maxwell Y"},
      {"jousselme_consonant", "d_J of nested intervals"},
      {"pignistic_consonant", "total variation of the two Gaussians"},
      {"cosine_consonant", "1 - cosine of the contours"},
      {"correlation_consonant", "1 - r of nested intervals"},
      {"cusum", "one-sided cumulative sum of d/sqrt(S) - kappa"},
      {"glr", "log likelihood ratio of the likeliest jump in the window"},
      {"sprt", "log likelihood ratio of a LiDAR short by delta"},
      {"lidar_modes", "P(the LiDAR measures the fog, or has no echo)"},
      {"witness_nis", "larger squared residual of a sensor against the prediction"},
      {"witness_deng", "larger loss of credibility among three bodies of evidence"},
      {"witness_murphy", "larger loss of support by the average of the others"},
      {"witness_mutual", "larger loss of mutual support, by the law of cosines"},
  });
}
static_assert(ChoiceNames<MeasureChoice>::kNames[static_cast<std::size_t>(MeasureChoice::kDoc)] ==
              "doc");

constexpr auto ChoicesOf(BlameChoice) {
  return std::to_array<Choice>({
      {"nis", "erf(|T|/sqrt(2)), T the residual against the prediction"},
      {"deng", "loss of credibility among three bodies of evidence"},
      {"murphy", "loss of support by the average of the others"},
      {"mutual", "loss of mutual support, by the law of cosines"},
      {"lidar_modes", "P(the LiDAR measures the fog, or has no echo); never the radar"},
  });
}
static_assert(ChoiceNames<BlameChoice>::kNames[static_cast<std::size_t>(BlameChoice::kNis)] ==
              "nis");

}  // namespace fogline
