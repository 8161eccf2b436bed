// The findings of docs/findings.md, with the claims that study `ensemble` examines.
#pragma once

#include <vector>

#include "tools/study/ensemble/robustness.h"

namespace fogline::study {

/// A large difference needs only one seed of so many.
inline constexpr std::int64_t kLarge = 8;
/// The safety improvement varies so much between situations that a mix of them needs so many times
/// the seeds: about a thousand situations, as in study `threshold`.
inline constexpr std::int64_t kManySituations = 8;

/// All findings, in the order of the page. A person writes the exceptions, after the runs.
const std::vector<ExaminedFinding>& ExaminedFindings();

}  // namespace fogline::study
