// The runs of study `ensemble`. They repeat the comparisons that decide claims of other studies, in
// the scenarios of these studies, with each parameter set.
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

/// Runs, for each study, only the cases and variants that the quoted claims compare. Quoted claims
/// of one study that have a case in common share runs: all their cases are run with all their
/// variants. All sets have the same seeds.
/// @throws InputError, StudyStopped; std::out_of_range if a quoted claim does not exist in its
/// study
EnsembleRuns RunEnsemble(const StudyContext& context, std::span<const EnsembleSet> sets,
                         std::span<const QuotedClaim> quoted);

}  // namespace fogline::study
