// A log as tables. There is one table for each channel with a message in every step. A table has
// one row for each message and one column for each field. The tables are for files that other
// programs read. Fogline's own programs read the log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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
  std::size_t messages = 0;  // number of messages; a run in real time may lack some messages
};

struct RunTables {
  std::vector<ChannelTable> channels;  // in the order of the graph table
  std::string scenario;                // JSON, ASCII only
  std::int64_t steps = 0;
  bool complete = false;
  std::string note;  // why the log is not complete, or which bytes the reader ignored; otherwise ""
};

/// Reads a whole log into memory: 0.8 kB for each step with one following car.
/// @throws InputError if the file is no log, or has messages that do not fit their channel;
/// Interrupted
RunTables ReadRunTables(const std::filesystem::path& log);

}  // namespace fogline::exports
