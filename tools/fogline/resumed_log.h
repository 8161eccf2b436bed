// The log that `fogline run --resume` goes on with.
#pragma once

#include <filesystem>
#include <string>

#include "scenario/scenario.h"
#include "services/runtime/file_lock.h"
#include "tools/fogline/experiment.h"

namespace fogline {

/// A log of a run in lockstep that has ended early, or come to its end. No other run can have it
/// until the end of this object. It is left as it is, whatever is wrong with it.
class ResumedLog {
 public:
  /// @param key that its seal is signed with, if it has one; nullptr: any or none
  /// @throws InputError with what is wrong with it
  ResumedLog(const std::filesystem::path& log, const SealKey* key);

  const Scenario& scenario() const { return scenario_; }
  const Resumption& resumption() const { return resumption_; }
  /// The run has come to its end.
  bool complete() const { return resumption_.remains.final; }

 private:
  FileLock lock_;
  Resumption resumption_;
  Scenario scenario_;
};

}  // namespace fogline
