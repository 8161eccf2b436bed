// The runs of study `ensemble`. Other studies make claims, and comparisons of runs decide whether a
// claim holds. Study `ensemble` repeats these comparisons with each parameter set, in the scenarios
// of the other studies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/study/ensemble/parameter_sets.h"
#include "tools/study/ensemble/robustness.h"
#include "tools/study/study.h"

namespace fogline::study {

struct EnsembleRuns {
  std::vector<ClaimInSets> claims;  // in the order in which they are quoted
  std::int64_t runs = 0;
};

/// Runs, for each study, only the cases and variants that the quoted claims compare. Claims of one
/// study that need equally many seeds and have a case in common form a group. All cases of a group
/// are run with all variants of the group. All parameter sets have the same seeds.
/// @throws InputError, StudyStopped; std::out_of_range if a quoted claim does not exist in its
/// study
EnsembleRuns RunEnsemble(const StudyContext& context, std::span<const EnsembleSet> sets,
                         std::span<const QuotedClaim> quoted);

}  // namespace fogline::study
