// The log that `fogline run --resume` continues.
#pragma once

#include <filesystem>
#include <string>

#include "common/file_lock.h"
#include "scenario/sections/scenario.h"
#include "tools/runner/experiment.h"

namespace fogline::runner {

/// A log of a run in lockstep that has ended early, or is complete. Its lock keeps other runs away
/// until the end of this object. The constructor does not change the file, also if it refuses the
/// log. Only if a killed run was to replace an older log, and has not begun, the older log comes
/// back, and the constructor says so on stderr.
class ResumedLog {
 public:
  /// @param key must have signed the seal, if there is a seal; nullptr: the seal has no signature
  /// @throws InputError with the reason why the log cannot be resumed
  ResumedLog(const std::filesystem::path& log, const runtime::SigningKey* key);

  const Scenario& scenario() const { return scenario_; }
  const Resumption& resumption() const { return resumption_; }
  /// Whether the log has the whole run.
  bool complete() const { return resumption_.remains.final; }

 private:
  FileLock lock_;
  Resumption resumption_;
  Scenario scenario_;
};

}  // namespace fogline::runner
