// What happened in the runs, in one sentence for each situation: what the fog did to the LiDAR,
// what came of it without traded control, and what traded control made of it.
#pragma once

#include <span>
#include <string>

#include "tools/report/report.h"

namespace fogline {

/// Plain text, "" of no run. Runs that differ in their arbitrator alone are of one situation and
/// share a sentence; more than three situations are summed up in one. Every number is of the
/// samples; the safety improvement is the run's `si_pct`.
std::string StoryOf(std::span<const ReportRun> runs);

}  // namespace fogline
