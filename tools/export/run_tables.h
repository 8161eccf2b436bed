// A log as tables: one for each channel that carries a message in every step, with a row for each
// message and a column for each field. For files that other programs read; our own read the log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fogline {

/// One field of a channel's messages.
struct FieldTable {
  std::string name;  // as in lcmtypes; dotted where a message is within the message: "header.step"
  bool is_list = false;
  std::size_t width = 1;  // values in a message, the same in all; a matrix counts row by row
  /// Message by message, in the type that the field has.
  std::variant<std::vector<double>, std::vector<std::int8_t>, std::vector<std::int32_t>,
               std::vector<std::int64_t>>
      values;
};

struct ChannelTable {
  std::string_view name;
  std::vector<FieldTable> fields;
  std::size_t messages = 0;  // in order of steps; a run in real time may lack some
};

struct RunTables {
  std::vector<ChannelTable> channels;  // in the order of the graph table
  std::string scenario;                // JSON, ASCII alone
  std::int64_t steps = 0;
  bool complete = false;
  std::string note;  // why it is not complete, or what was ignored; "" if nothing
};

/// Reads a whole log into memory: 0.8 kB for each step with one following car.
/// @throws InputError if it is none, or has messages that do not fit their channel; Interrupted
RunTables ReadRunTables(const std::filesystem::path& log);

}  // namespace fogline
