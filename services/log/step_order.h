// The order of the steps in a log of the recorder. In lockstep, all messages of a step are next to
// each other, in the order of the graph table (services/graph.h). In a log with the wall clock, the
// wall clock of a step follows its messages. So the number of an event determines its step and
// channel. In real time, messages may be missing, and STATUS messages come between the steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "services/log/event_log.h"
#include "services/log/wall_clock.h"

namespace fogline::log {

inline constexpr std::size_t kStepChannels = [] {
  std::size_t count = 0;
  for (const ChannelInfo& channel : kChannels) count += channel.pace == Pace::kStep ? 1 : 0;
  return count;
}();

/// Names of the per-step channels, in the order of their messages in a log.
inline constexpr std::array<std::string_view, kStepChannels> kStepNames = [] {
  std::array<std::string_view, kStepChannels> names;
  std::size_t i = 0;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace == Pace::kStep) names[i++] = channel.name;
  }
  return names;
}();

/// Largest size of a step in a log, in bytes, with its wall clock.
inline constexpr std::int64_t kMostStepBytes =
    (kStepChannels + 1) * (kMostEventOverhead + runtime::kMaxMessageBytes);

inline bool IsStepChannel(std::string_view channel) {
  return std::ranges::find(kStepNames, channel) != kStepNames.end();
}

inline bool IsOfRun(const Event& event, std::int64_t run_id) {
  return event.data.size() >= runtime::kHeaderEnd &&
         runtime::ReadInt64(event.data, runtime::kRunIdOffset) == run_id;
}

/// The step of a message of this run; -1 if the message is of another run.
inline std::int64_t StepOf(const Event& event, std::int64_t run_id) {
  return IsOfRun(event, run_id) ? runtime::ReadInt64(event.data, runtime::kStepOffset) : -1;
}

/// The step of a run in lockstep that begins with this event; nullopt if no step begins here.
/// @param front_events number of events before step 0
/// @param step_events number of events of each step
inline std::optional<std::int64_t> StepBegunBy(const Event& event, std::int64_t front_events,
                                               std::int64_t step_events, std::int64_t run_id) {
  const std::int64_t step = StepOf(event, run_id);
  if (step < 0 || event.channel != kStepNames.front() || event.number < front_events) {
    return std::nullopt;
  }
  const std::int64_t before = event.number - front_events;
  if (before % step_events != 0 || before / step_events != step) return std::nullopt;
  return step;
}

}  // namespace fogline::log
