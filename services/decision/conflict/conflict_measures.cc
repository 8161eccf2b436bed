#include "services/decision/conflict/conflict_measures.h"

#include <algorithm>
#include <utility>

#include "scenario/sections/decision.h"
#include "services/decision/conflict/one_step/binned_belief.h"
#include "services/decision/conflict/one_step/consonant_belief.h"
#include "services/decision/conflict/one_step/divergence.h"
#include "services/decision/conflict/one_step/momentary.h"
#include "services/decision/conflict/over_time/doc.h"
#include "services/decision/conflict/over_time/lidar_modes.h"
#include "services/decision/conflict/over_time/nis.h"
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

// Makes a measure whose score is a function of the step's disagreement.
template <auto kScore>
ConflictPtr OfDisagreement(const Parameters& parameters) {
  return MakeMomentary(parameters, [](const Disagreement& d) { return kScore(d); });
}

// Makes a measure whose score is a function of both readings. The readings are represented as
// masses on bins (binned_belief.h).
template <auto kScore>
ConflictPtr OnBins(const Parameters& parameters) {
  return MakeMomentary(parameters, [parameters](const Disagreement& d) {
    return kScore(PairOnBins(d, parameters));
  });
}

// Makes a measure whose score is the result of a method of ConsonantBeliefs.
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

// One row for each measure, in the order of scenario/sections/decision.h.
constexpr ConflictMeasureRow kConflictMeasures[] = {
    {"doc", "Sourav & Cheng 2024", kUnit, kWindowed, Make<Doc>},
    {"nis", "Bar-Shalom, Li & Kirubarajan 2001", kPositive, kMomentary,
     OfDisagreement<NormalisedSquare>},
    {"nis_window", "Bar-Shalom, Li & Kirubarajan 2001", kPositive, kWindowed, Make<WindowedNis>},
    {"nis_signed", "Bar-Shalom, Li & Kirubarajan 2001", "(-inf, inf)", kWindowed, Make<SignedNis>},
    {"bhattacharyya", "Bhattacharyya 1943", kPositive, kMomentary,
     OfDisagreement<BhattacharyyaOfMeans>},
    {"hellinger", "Hellinger 1909", kUnit, kMomentary, OfDisagreement<HellingerOfMeans>},
    {"dempster_bins", "Dempster 1967", kUnit, kMomentary, OnBins<DempsterConflict>},
    {"jousselme_bins", "Jousselme et al. 2001", kUnit, kMomentary, OnBins<JousselmeDistance>},
    {"pignistic_bins", "Liu 2006", kUnit, kMomentary, OnBins<PignisticDistance>},
    {"cosine_bins", "Wen et al. 2008", kUnit, kMomentary, OnBins<CosineConflict>},
    {"correlation_bins", "Jiang 2016", kUnit, kMomentary, OnBins<CorrelationConflict>},
    {"dempster_consonant", "Smets 2005; Dempster 1967", kUnit, kMomentary,
     OfDisagreement<ConsonantConflict>},
    {"jousselme_consonant", "Smets 2005; Jousselme et al. 2001", kUnit, kMomentary,
     OnConsonant<&Beliefs::JousselmeDistance>},
    {"pignistic_consonant", "Smets 2005; Liu 2006", kUnit, kMomentary,
     OfDisagreement<ConsonantPignisticDistance>},
    {"cosine_consonant", "Smets 2005; Wen et al. 2008", kUnit, kMomentary,
     OnConsonant<&Beliefs::CosineConflict>},
    {"correlation_consonant", "Smets 2005; Jiang 2016", kUnit, kMomentary,
     OnConsonant<&Beliefs::CorrelationConflict>},
    {"cusum", "Page 1954", "[0, ceiling]", kUnchanged, Make<Cusum>},
    {"glr", "Willsky & Jones 1976", kPositive, kWindowed, Make<Glr>},
    {"sprt", "Wald 1947", "[ln(beta/(1 - alpha)), ceiling]", kUnchanged, Make<Sprt>},
    {"lidar_modes", "Blom & Bar-Shalom 1988", kUnit, "evidence of a mode", Make<LidarModeConflict>,
     true},
    {"witness_nis", "Bar-Shalom, Li & Kirubarajan 2001", kPositive, kWindowed, Make<NisWitness>},
    {"witness_deng", "Deng et al. 2004", kUnit, kMomentary, OfLargestBlame<DengSupport>},
    {"witness_murphy", "Murphy 2000", kUnit, kMomentary, OfLargestBlame<MurphySupport>},
    {"witness_mutual", "after Zhang et al. 2014", kUnit, kMomentary, OfLargestBlame<MutualSupport>},
};

constexpr BlameMeasureRow kBlameMeasures[] = {
    {"nis", "Bar-Shalom, Li & Kirubarajan 2001", kUnit, kWindowed, MakeBlame<NisBlame>},
    {"deng", "Deng et al. 2004", kUnit, "by rule; conflict: all the blame", OfSupport<DengSupport>},
    {"murphy", "Murphy 2000", kUnit, "by rule; conflict: all the blame", OfSupport<MurphySupport>},
    {"mutual", "after Zhang et al. 2014", kUnit, "by rule; conflict: all the blame",
     OfSupport<MutualSupport>},
    {"lidar_modes", "Blom & Bar-Shalom 1988", kUnit, "evidence of a mode",
     MakeBlame<LidarModeBlame>},
};

static_assert(std::ranges::equal(kConflictMeasures, ChoiceNames<MeasureChoice>::kNames, {},
                                 &ConflictMeasureRow::name),
              "each measure of conflict has a line in scenario/sections/decision.h and a row here, "
              "in the same order");
static_assert(std::ranges::equal(kBlameMeasures, ChoiceNames<BlameChoice>::kNames, {},
                                 &BlameMeasureRow::name),
              "each measure of blame has a line in scenario/sections/decision.h and a row here, in "
              "the same order");

}  // namespace

std::span<const ConflictMeasureRow> ConflictMeasures() { return kConflictMeasures; }
std::span<const BlameMeasureRow> BlameMeasures() { return kBlameMeasures; }

}  // namespace fogline::conflict
