// The version of Fogline that wrote a log, for the error message of a reader that cannot read this
// log.
#pragma once

#include <filesystem>
#include <string>

#include "scenario/sections/scenario.h"

namespace fogline::log {

/// The writer of a log.
struct LogVersion {
  /// Name and version of the writer, such as "Fogline 0.1.0"; "" if the version is not known. The
  /// seal contains the version. For a log without a seal, the version is known if the table of
  /// released versions (log_version.cc) has the log's message types.
  std::string writer;
  /// Whether the message types of the writer differ from those of this build.
  bool other_types = false;

  /// A remark for an error message, such as "written by Fogline 0.1.0 with other message types;
  /// this is Fogline 0.2.0". "" if the log has the message types of this build, and its version is
  /// the version of this build or not known.
  std::string Text() const;
};

/// Reads the whole log to find its writer. @throws InputError if the file cannot be read or is not
/// an event log
LogVersion VersionOf(const std::filesystem::path& log);

/// Refuses a log that another version of Fogline wrote. @throws InputError that names this version,
/// if it is known
[[noreturn]] void RefuseVersion(const std::filesystem::path& log);

/// Reads the scenario of a log.
/// @throws InputError if the scenario is invalid. If another version of Fogline wrote the log, the
///     last line of the error says so.
Scenario ParseLoggedScenario(const std::string& text, const std::filesystem::path& log);

}  // namespace fogline::log
