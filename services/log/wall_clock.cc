#include "services/log/wall_clock.h"

#include <ctime>

#include "services/log/event_log.h"

namespace fogline::log {
namespace {

std::int64_t MicrosOf(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

}  // namespace

void ForEachWallClock(const std::filesystem::path& log, std::int64_t run_id,
                      const std::function<void(const wall_clock_t&, runtime::Bytes)>& use) {
  EventLogReader reader(log);
  wall_clock_t clock{};
  while (const auto event = reader.Next()) {
    if (event->channel != kWallClockChannel || !runtime::Decode(event->data, clock)) continue;
    if (clock.header.run_id == run_id) use(clock, event->data);
  }
}

wall_clock_t ReadWallClock() {
  wall_clock_t clock{};
  clock.unix_us = MicrosOf(CLOCK_REALTIME);
  clock.monotonic_us = MicrosOf(CLOCK_MONOTONIC);
  return clock;
}

}  // namespace fogline::log
