// Describes the runs with one sentence for each situation: how the fog deceived the LiDAR, the
// outcome without traded control, and the outcome with traded control.
#pragma once

#include <span>
#include <string>

#include "tools/report/report.h"

namespace fogline::report {

/// Plain text, "" without runs. Runs that differ only in their arbitrator belong to one situation
/// and share a sentence. More than three situations are summarised in one sentence. Every number
/// comes from the samples. Only the safety improvement is the run's `si_pct`.
std::string StoryOf(std::span<const ReportRun> runs);

}  // namespace fogline::report
