// The wall clock of each step, in the log of a run (lcmtypes/wall_clock_t.lcm).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

#include "fogline/wall_clock_t.hpp"
#include "services/runtime/wire/wire.h"

namespace fogline::log {

/// The channel of wall_clock_t. The channel is not part of kGraph, because no process publishes it.
inline constexpr std::string_view kWallClockChannel = "WALL_CLOCK";

/// Calls `use` for the wall clock of each step of a run, in the order of the log. Events that do
/// not decode, or are of another run, are left out. @throws InputError if the log cannot be read
void ForEachWallClock(const std::filesystem::path& log, std::int64_t run_id,
                      const std::function<void(const wall_clock_t&, runtime::Bytes)>& use);

/// The wall clock at this moment. The caller sets header and late.
wall_clock_t ReadWallClock();

}  // namespace fogline::log
