#include "services/decision/conflict/conflict_measures.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "services/decision/conflict/one_step/binned_belief.h"
#include "services/decision/conflict/one_step/consonant_belief.h"
#include "services/decision/conflict/one_step/divergence.h"
#include "services/decision/conflict/one_step/doc.h"
#include "services/decision/conflict/one_step/momentary.h"
#include "services/decision/conflict/one_step/nis.h"
#include "services/decision/conflict/over_time/lidar_modes.h"
#include "services/decision/conflict/over_time/sequential.h"
#include "services/decision/conflict/over_time/third_witness.h"

namespace fogline::conflict {
namespace {

using Parameters = ConflictParameters;
using ConflictPtr = std::unique_ptr<ConflictMeasure>;
using BlamePtr = std::unique_ptr<BlameMeasure>;

template <class Measure>
ConflictPtr Make(const Parameters& parameters) {
  return std::make_unique<Measure>(parameters);
}

template <class Measure>
BlamePtr MakeBlame(const Parameters& parameters) {
  return std::make_unique<Measure>(parameters);
}

template <class Score>
ConflictPtr MakeMomentary(const Parameters& parameters, Score score) {
  return std::make_unique<Momentary<Score>>(parameters, std::move(score));
}

// A function of the step's disagreement.
template <auto kScore>
ConflictPtr OfDisagreement(const Parameters& parameters) {
  return MakeMomentary(parameters, [](const Disagreement& d) { return kScore(d); });
}

// A function of the two readings on bins.
template <auto kScore>
ConflictPtr OnBins(const Parameters& parameters) {
  return MakeMomentary(parameters, [parameters](const Disagreement& d) {
    return kScore(PairOnBins(d, parameters));
  });
}

// A method of ConsonantBeliefs.
template <auto kScore>
ConflictPtr OnConsonant(const Parameters& parameters) {
  return MakeMomentary(parameters, [beliefs = ConsonantBeliefs(parameters.levels)](
                                       const Disagreement& d) { return (beliefs.*kScore)(d); });
}

template <auto kSupport>
BlamePtr OfSupport(const Parameters& parameters) {
  return std::make_unique<BeliefBlame>(parameters, kSupport);
}

template <auto kSupport>
ConflictPtr OfLargestBlame(const Parameters& parameters) {
  return std::make_unique<LargestBlame>(OfSupport<kSupport>(parameters));
}

constexpr std::string_view kUnit = "[0, 1]";
constexpr std::string_view kPositive = "[0, inf)";
constexpr std::string_view kMomentary = "by rule; skipped: 0";
constexpr std::string_view kWindowed = "by rule; skipped: an empty place";
constexpr std::string_view kUnchanged = "by rule; skipped: no change";

using Beliefs = ConsonantBeliefs;

// One row for each measure.
constexpr ConflictMeasureRow kConflictMeasures[] = {
    {"doc", "1/(1 + exp(-10 (z - 1 m))), z the windowed |radar - LiDAR|", "Sourav & Cheng 2024",
     kUnit, kWindowed, Make<Doc>},
    {"nis", "d^2/S of the step", "Bar-Shalom, Li & Kirubarajan 2001", kPositive, kMomentary,
     OfDisagreement<NormalisedSquare>},
    {"nis_window", "mean of d^2/S over the window", "Bar-Shalom, Li & Kirubarajan 2001", kPositive,
     kWindowed, Make<WindowedNis>},
    {"nis_signed", "sum of d/sqrt(S) over the window, over sqrt(n): LiDAR short > 0",
     "Bar-Shalom, Li & Kirubarajan 2001", "(-inf, inf)", kWindowed, Make<SignedNis>},
    {"bhattacharyya", "d^2/(4 S): the part of the means", "Bhattacharyya 1943", kPositive,
     kMomentary, OfDisagreement<BhattacharyyaOfMeans>},
    {"hellinger", "sqrt(1 - exp(-d^2/(4 S))): the part of the means", "Hellinger 1909", kUnit,
     kMomentary, OfDisagreement<HellingerOfMeans>},
    {"dempster_bins", "k, mass on disjoint bins", "Dempster 1967", kUnit, kMomentary,
     OnBins<DempsterConflict>},
    {"jousselme_bins", "d_J, distance under |A and B|/|A or B|, on bins", "Jousselme et al. 2001",
     kUnit, kMomentary, OnBins<JousselmeDistance>},
    {"pignistic_bins", "difBetP, largest difference of pignistic probability, on bins", "Liu 2006",
     kUnit, kMomentary, OnBins<PignisticDistance>},
    {"cosine_bins", "1 - cosine of the masses, on bins", "Wen et al. 2008", kUnit, kMomentary,
     OnBins<CosineConflict>},
    {"correlation_bins", "1 - r, cosine under |A and B|/|A or B|, on bins", "Jiang 2016", kUnit,
     kMomentary, OnBins<CorrelationConflict>},
    {"dempster_consonant", "k(d) = P(s1 Y1 + s2 Y2 < |d|), Maxwell Y", "Smets 2005; Dempster 1967",
     kUnit, kMomentary, OfDisagreement<ConsonantConflict>},
    {"jousselme_consonant", "d_J of nested intervals", "Smets 2005; Jousselme et al. 2001", kUnit,
     kMomentary, OnConsonant<&Beliefs::JousselmeDistance>},
    {"pignistic_consonant", "total variation of the two Gaussians", "Smets 2005; Liu 2006", kUnit,
     kMomentary, OfDisagreement<ConsonantPignisticDistance>},
    {"cosine_consonant", "1 - cosine of the contours", "Smets 2005; Wen et al. 2008", kUnit,
     kMomentary, OnConsonant<&Beliefs::CosineConflict>},
    {"correlation_consonant", "1 - r of nested intervals", "Smets 2005; Jiang 2016", kUnit,
     kMomentary, OnConsonant<&Beliefs::CorrelationConflict>},
    {"cusum", "one-sided cumulative sum of d/sqrt(S) - kappa", "Page 1954", "[0, ceiling]",
     kUnchanged, Make<Cusum>},
    {"glr", "log likelihood ratio of the likeliest jump in the window", "Willsky & Jones 1976",
     kPositive, kWindowed, Make<Glr>},
    {"sprt", "log likelihood ratio of a LiDAR short by delta", "Wald 1947",
     "[ln(beta/(1 - alpha)), ceiling]", kUnchanged, Make<Sprt>},
    {"lidar_modes", "P(LiDAR ranges fog or nothing)", "Blom & Bar-Shalom 1988", kUnit,
     "evidence of a mode", Make<LidarModeConflict>, true},
    {"witness_nis", "larger squared residual of a sensor against the prediction",
     "Bar-Shalom, Li & Kirubarajan 2001", kPositive, kWindowed, Make<NisWitness>},
    {"witness_deng", "larger loss of credibility among three bodies of evidence",
     "Deng et al. 2004", kUnit, kMomentary, OfLargestBlame<DengSupport>},
    {"witness_murphy", "larger loss of support by the average of the others", "Murphy 2000", kUnit,
     kMomentary, OfLargestBlame<MurphySupport>},
    {"witness_mutual", "larger loss of mutual support, by the law of cosines",
     "after Zhang et al. 2014", kUnit, kMomentary, OfLargestBlame<MutualSupport>},
};

constexpr BlameMeasureRow kBlameMeasures[] = {
    {"nis", "erf(|T|/sqrt(2)), T the residual against the prediction",
     "Bar-Shalom, Li & Kirubarajan 2001", kUnit, kWindowed, MakeBlame<NisBlame>},
    {"deng", "loss of credibility among three bodies of evidence", "Deng et al. 2004", kUnit,
     "by rule; conflict: all the blame", OfSupport<DengSupport>},
    {"murphy", "loss of support by the average of the others", "Murphy 2000", kUnit,
     "by rule; conflict: all the blame", OfSupport<MurphySupport>},
    {"mutual", "loss of mutual support, by the law of cosines", "after Zhang et al. 2014", kUnit,
     "by rule; conflict: all the blame", OfSupport<MutualSupport>},
    {"lidar_modes", "P(LiDAR ranges fog or nothing); never the radar", "Blom & Bar-Shalom 1988",
     kUnit, "evidence of a mode", MakeBlame<LidarModeBlame>},
};

// A column of either table, for the scenario.
template <auto kMember, class Row, std::size_t kRows>
consteval auto Column(const Row (&rows)[kRows]) {
  std::array<std::string_view, kRows> column;
  std::ranges::transform(rows, column.begin(), kMember);
  return column;
}

constexpr auto kConflictNames = Column<&ConflictMeasureRow::name>(kConflictMeasures);
constexpr auto kConflictDocs = Column<&ConflictMeasureRow::definition>(kConflictMeasures);
constexpr auto kBlameNames = Column<&BlameMeasureRow::name>(kBlameMeasures);
constexpr auto kBlameDocs = Column<&BlameMeasureRow::definition>(kBlameMeasures);
// The defaults of the scenario.
static_assert(kConflictNames[static_cast<std::size_t>(MeasureChoice::kDoc)] == "doc");
static_assert(kBlameNames[static_cast<std::size_t>(BlameChoice::kNis)] == "nis");

template <class Row>
const Row* Find(std::span<const Row> rows, std::string_view name) {
  const auto found = std::ranges::find(rows, name, &Row::name);
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

std::span<const ConflictMeasureRow> ConflictMeasures() { return kConflictMeasures; }
std::span<const BlameMeasureRow> BlameMeasures() { return kBlameMeasures; }

const ConflictMeasureRow* FindConflictMeasure(std::string_view name) {
  return Find(ConflictMeasures(), name);
}

const BlameMeasureRow* FindBlameMeasure(std::string_view name) {
  return Find(BlameMeasures(), name);
}

}  // namespace fogline::conflict

namespace fogline {

using Names = std::span<const std::string_view>;
constinit const Names ChoiceNames<MeasureChoice>::kNames = conflict::kConflictNames;
constinit const Names ChoiceNames<MeasureChoice>::kDocs = conflict::kConflictDocs;
constinit const Names ChoiceNames<BlameChoice>::kNames = conflict::kBlameNames;
constinit const Names ChoiceNames<BlameChoice>::kDocs = conflict::kBlameDocs;

}  // namespace fogline
