// A session: makes the missing trials of one participant, asks the questions after each trial, and
// writes the answers into the trial's log. If a session was killed, the next session begins with
// the first trial that is not done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/drive/pedal_source.h"
#include "tools/runner/scenario_run.h"
#include "tools/trials/desk/desk.h"
#include "tools/trials/results.h"

namespace fogline::trials {

struct SessionOptions {
  std::int64_t participant = 1;
  double speed = 1;                    // simulated seconds per second
  std::vector<std::string> overrides;  // of every trial, such as /person/drives=true
  bool breaks = true;                  // false: breaks have no least duration
  /// Makes the pedals of the person who drives; called for each run. Empty if this program has no
  /// seat.
  std::function<std::unique_ptr<drive::PedalSource>(const PersonSection&)> pedals;
  runner::RunOptions run;  // transport and traffic of each run
};

/// The work that a session has done.
struct SessionOutcome {
  std::int64_t runs = 0;   // number of runs that this session has made
  std::int64_t asked = 0;  // number of trials of which only answers were missing
};

/// Makes the trials of a participant that are not done.
/// @pre the caller holds the lock of results.Begin() for this participant
/// @throws Interrupted; std::runtime_error if a run fails. The next session begins with the trial
///     that was interrupted or that failed
SessionOutcome RunSession(const PlanFile& plan, const Results& results, SessionOptions options,
                          Desk& desk);

}  // namespace fogline::trials
