// The folder of an ensemble: one scenario file for each set, and a table of all sets.
#pragma once

#include <filesystem>
#include <string>

#include "common/atomic_file.h"
#include "tools/calibrate/ensemble/ensemble_report.h"

namespace fogline::calibrate {

/// The text of a scenario file in the folder `from`, changed for the folder `to`: a relative path
/// in $schema is changed, so that it leads to the same file from `to`.
std::string WithSchemaIn(const std::filesystem::path& to, const std::filesystem::path& from,
                         std::string text);

/// The folder of an ensemble. It is constructed before the search for the sets. The search takes
/// long, so a folder that cannot be written must be an error before it. The destructor removes a
/// new folder that is still empty.
class EnsembleFolder {
 public:
  /// @throws InputError if the folder cannot be written, or if it has sets and `force` is false
  EnsembleFolder(std::filesystem::path folder, bool force);

  /// Removes all sets of an earlier ensemble from the folder. Then writes set-1.json and so on, and
  /// sets.csv.
  /// @param text the text of the scenario's file, from which each set's file is made
  /// @throws std::runtime_error when the disk is full
  void Write(const EnsembleReport& report, const std::string& text) const;

 private:
  std::filesystem::path folder_;
  OutputFolder checked_;
};

}  // namespace fogline::calibrate
