// The options for the messages of a process: a key and faults. These options are the same for
// `fogline run` and for every service (process/program_options.h reads them).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"

namespace fogline::runtime {

struct TrafficOptions {
  std::string key_file;  // "": messages are not signed
  std::string faults;    // text for ParseFaults(); "": no faults
};

/// The environment variable that names the key's file if --key does not.
inline constexpr const char* kKeyVariable = "FOGLINE_KEY";

/// The options, with the key's file of FOGLINE_KEY if they name none. For a program that does not
/// read the variable with its options.
TrafficOptions WithKeyOfEnvironment(TrafficOptions options);

/// The key; nullopt if the options name no key.
/// @throws InputError when the key's file is wrong, or FOGLINE_KEY is set but empty
std::optional<SigningKey> KeyOf(const TrafficOptions& options);

/// @throws InputError when the options, or the key's file, are wrong
void Check(const TrafficOptions& options);

/// Opens a network with the options.
/// @param role as in Apply()
/// @throws as Bus(), and InputError when the options, or the key's file, are wrong, or if the
///     network cannot be used with a key
std::unique_ptr<Bus> OpenBus(const std::string& url, const TrafficOptions& options,
                             std::optional<Role> role);

/// Applies the options to a bus.
/// @param role the role of this process; nullopt when the process has every role
/// @throws InputError when the options, or the key's file, are wrong
void Apply(const TrafficOptions& options, std::optional<Role> role, Bus& bus);

/// The options as arguments for another process.
std::vector<std::string> ToArguments(const TrafficOptions& options);

}  // namespace fogline::runtime
