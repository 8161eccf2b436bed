// The findings of docs/findings.md, with the claims that study `ensemble` examines.
#pragma once

#include <vector>

#include "tools/study/ensemble/robustness.h"

namespace fogline::study {

/// A claim on a large difference needs only one in kLarge of the seeds.
inline constexpr std::int64_t kLarge = 8;
/// A claim on a mix of situations needs this many times the usual number of seeds. The safety
/// improvement differs much between situations, so about a thousand situations are needed, as in
/// study `threshold`.
inline constexpr std::int64_t kManySituations = 8;

/// All findings, in the order of docs/findings.md. Some claims do not hold in some parameter sets.
/// After the runs, a person adds these exceptions to the finding (KnownException).
const std::vector<ExaminedFinding>& ExaminedFindings();

}  // namespace fogline::study
