// The inputs of a person in a run: the DRIVER_INPUT messages in its log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "services/runtime/wire/wire.h"

namespace fogline::log {

/// Calls `use` for each DRIVER_INPUT of a run in the order of the log. Invalid messages, and
/// messages of another run, are left out. @throws InputError if the log cannot be read
void ForEachDriverInput(const std::filesystem::path& log, std::int64_t run_id,
                        const std::function<void(const driver_input_t&)>& use);

/// All DRIVER_INPUT messages that ForEachDriverInput() finds. @throws the same exceptions
std::vector<driver_input_t> ReadDriverInputs(const std::filesystem::path& log, std::int64_t run_id);

/// The inputs of a run, by the instance and sequence number that a DRIVER_COMMAND contains.
class DriverInputs {
 public:
  DriverInputs() = default;
  explicit DriverInputs(const std::vector<driver_input_t>& inputs);

  /// The input with this instance and sequence; nullptr if the log has no such input.
  const driver_input_t* Find(std::int64_t instance, std::int64_t sequence) const;

 private:
  std::map<std::pair<std::int64_t, std::int64_t>, driver_input_t> inputs_;
};

}  // namespace fogline::log
