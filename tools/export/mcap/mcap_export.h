// Writes a log as an MCAP file, which Foxglove, Lichtblick, PlotJuggler and rerun read.
#pragma once

#include <filesystem>

#include "services/log/run_log.h"

namespace fogline::mcap {

/// Whether WriteMcap() has written the file. Only the beginning of the file is checked.
bool IsMcapExport(const std::filesystem::path& file);

/// Writes the complete file or nothing. The memory that it needs hardly grows with the size of the
/// log (writer.h). Each channel of the log becomes a channel of the file, with the messages of the
/// run. RUN is left out, because the scenario is the attachment scenario.json. log_time and
/// publish_time of a message are its simulated time, and its sequence is its step. The metadata
/// record "fogline" says whether the log is complete. This record also has the id, the digest and
/// the number of steps of the run, and the title, the seed and the hash of the scenario. Equal logs
/// give equal files.
/// @throws InputError if `log` is not a log, or has messages that do not fit their channel, or if
///     `file` cannot be created; std::runtime_error when the disk is full; Interrupted after a
///     signal that asks the process to end
/// @return the facts about the run in the log
log::RunLog WriteMcap(const std::filesystem::path& log, const log::ReadOptions& options,
                      const std::filesystem::path& file);

}  // namespace fogline::mcap
