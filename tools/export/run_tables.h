// A log as tables. There is one table for each channel with a message in every step, and one for
// the wall clock of the steps, if the log has it. A table has one row for each message and one
// column for each field. The tables are for files that other programs read. Fogline's own programs
// read the log.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "services/log/run_log.h"

namespace fogline::exports {

/// One field of a channel's messages.
struct FieldTable {
  std::string name;  // as in lcmtypes, with a dot before a field of a nested message: "header.step"
  bool is_list = false;
  std::size_t width = 1;  // values in each message; a matrix is stored row by row
  /// The values of all messages one after another, in the type of the field.
  std::variant<std::vector<double>, std::vector<std::int8_t>, std::vector<std::int32_t>,
               std::vector<std::int64_t>>
      values;
};

struct ChannelTable {
  std::string_view name;
  std::vector<FieldTable> fields;
  std::size_t messages = 0;  // number of rows; the log of a run in real time may lack messages
  /// The rows of messages that the log of a run in lockstep lacks. Such a row has the values of the
  /// header. Its other values are NaN or 0, and must not be shown.
  std::vector<std::size_t> gaps;

  bool IsGap(std::size_t row) const { return std::ranges::binary_search(gaps, row); }
};

/// Whether a field belongs to the header of a message.
inline bool IsOfHeader(const FieldTable& field) { return field.name.starts_with("header."); }

struct RunTables {
  std::vector<ChannelTable> channels;  // in the order of the graph table, then the wall clock
  std::string scenario;                // JSON, ASCII only; "" if the log has none
  log::RunLog run;
};

/// Reads a whole log into memory: 0.8 kB for each step with one following car. If the options
/// permit gaps and the run is in lockstep, every channel has a row for each step from the first to
/// the last step that has a message in the log. A message that is missing in one of these steps has
/// a row, too.
/// @throws InputError if the file is not a log, or has messages that do not fit their channel;
/// Interrupted
RunTables ReadRunTables(const std::filesystem::path& log, const log::ReadOptions& options = {});

}  // namespace fogline::exports
