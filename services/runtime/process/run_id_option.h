// The option for the id of a run. It is the same for `fogline run`, for the verbs that read a run,
// and for every service.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace fogline::runtime {

/// Adds an option that takes a whole number from 1 to the largest 64-bit one, and refuses all else.
/// @param name such as "--run-id"
void AddRunIdOption(CLI::App& app, const std::string& name, std::optional<std::int64_t>& run_id,
                    const std::string& help);

}  // namespace fogline::runtime
