// Describes the runs with one sentence for each situation: how the fog deceived the LiDAR, the
// outcome without traded control, and the outcome with traded control.
#pragma once

#include <span>
#include <string>

#include "tools/report/report.h"

namespace fogline::report {

/// The description as plain text; "" without runs. Runs that differ only in their arbitrator belong
/// to one situation and share a sentence. More than three situations are summarised in one
/// sentence. All numbers are computed from the samples, except for the safety improvement: it is
/// the run's `si_pct`.
std::string StoryOf(std::span<const ReportRun> runs);

}  // namespace fogline::report
