// What a user asks of the traffic of a process: a key, faults. The same options for `fogline run`
// and for every service.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/runtime/bus.h"

namespace CLI {
class App;
}

namespace fogline {

struct TrafficOptions {
  std::string key_file;  // "": unsigned
  std::string faults;    // as ParseFaults() takes it; "": none
};

/// Adds --key and --faults to a command line.
void AddTrafficOptions(CLI::App& app, TrafficOptions& options);

/// The key, if one was asked for.
/// @throws InputError when its file is wrong, or FOGLINE_KEY is there and empty
std::optional<SealKey> KeyOf(const TrafficOptions& options);

/// Gives a bus what was asked for.
/// @param role of this process; nothing when it is every role
/// @throws InputError when the options, or the key's file, are wrong
void Apply(const TrafficOptions& options, std::optional<Role> role, Bus& bus);

/// The options as arguments for another process.
std::vector<std::string> ToArguments(const TrafficOptions& options);

}  // namespace fogline
