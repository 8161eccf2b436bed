// The log that `fogline run --resume` continues.
#pragma once

#include <filesystem>
#include <string>

#include "common/file_lock.h"
#include "scenario/sections/scenario.h"
#include "tools/runner/scenario_run.h"

namespace fogline::runner {

/// A log of a run in lockstep that has ended early, or is complete. A lock keeps other runs from
/// using the log while this object exists. The constructor does not change the file, even if it
/// refuses the log. There is one exception: if a killed run had not begun, and its log was to
/// replace an older log, the constructor restores the older log, and says so on stderr.
class ResumedLog {
 public:
  /// @param key the key that must have signed the seal, if there is a seal; nullptr: a seal must
  ///     have no signature
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
