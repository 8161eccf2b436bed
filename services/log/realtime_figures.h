// How well a run in real time met its due times, according to the STATUS messages in its log.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/graph.h"
#include "services/log/about/log_priority.h"
#include "services/runtime/realtime/fallback_log.h"

namespace fogline::log {

struct RealtimeFigures {
  double speed = 1;               // simulated seconds per second
  std::int64_t ticks = 0;         // steps that the world has begun
  std::int64_t ticks_late = 0;    // steps that the world has begun more than 5 ms late
  std::int64_t ticks_missed = 0;  // ticks that the world's process skipped
  // 99 % quantile of the time from the due time of a step until the world begins the step.
  std::int64_t jitter_p99_us = 0;
  // The time from sending TRUTH to receiving HOST_COMMAND, on the world's clock.
  std::int64_t latency_p50_us = 0;
  std::int64_t latency_p99_us = 0;
  std::int64_t latency_max_us = 0;
  // Steps that a role skipped, or computed without a due input.
  std::int64_t deadline_misses = 0;
  std::int64_t late_messages = 0;    // messages that came too late to be used
  std::int64_t missed_messages = 0;  // messages that are not in the log, whether published or not
  // At least this number of the missed messages was published. Messages that came too late for the
  // recorder do not count here.
  std::int64_t unlogged_messages = 0;
  // The channels that lack a published message, or may lack one. Messages before the first TRUTH of
  // the log do not count. A channel lacks a published message if STATUS shows this. A channel may
  // lack a published message if a message is missing, and no STATUS says whether it was published.
  // There are three cases:
  // - The log has no STATUS of the producer.
  // - The log has no seal, and the message is of a step after the last STATUS of the producer.
  // - The log has no seal, and several processes have been the producer.
  runtime::ChannelSet unlogged_channels;
  // Whether the log has a STATUS of the world. All figures except `speed` and `missed_messages`
  // come from STATUS, so without it they are unknown.
  bool has_status = false;
  // The first fallbacks (FallbackLog::kMaxKept at most), and the number of later fallbacks.
  std::vector<runtime::Fallback> fallbacks;
  std::int64_t fallbacks_left_out = 0;
  // nullopt in a log of lcm-logger, of an older version, or of a run that ended too early.
  std::optional<RealtimePriority> priority;
};

/// Whether a figure (a name of VisitFigures()) is known.
inline bool IsKnown(std::string_view figure, const RealtimeFigures& f) {
  return f.has_status || figure == "speed" || figure == "missed_messages";
}

/// Calls `visit(name, value, unit, description)` for every figure that is a number, in order.
template <class Visitor>
void VisitFigures(const RealtimeFigures& f, Visitor&& visit) {
  visit("speed", f.speed, "", "simulated seconds per second");
  visit("ticks", f.ticks, "", "steps that the world has begun");
  visit("ticks_late", f.ticks_late, "", "of these, more than 5 ms late");
  visit("ticks_missed", f.ticks_missed, "", "ticks at which the world stood still");
  visit("deadline_misses", f.deadline_misses, "", "steps without an input that was due");
  visit("late_messages", f.late_messages, "", "messages that came too late to be used");
  visit("missed_messages", f.missed_messages, "", "messages that are not in the log");
  visit("unlogged_messages", f.unlogged_messages, "", "of these, at least so many were published");
  visit("jitter_p99_us", f.jitter_p99_us, "us", "how far from its due time a step begins");
  visit("latency_p50_us", f.latency_p50_us, "us", "from sensor to command: median");
  visit("latency_p99_us", f.latency_p99_us, "us", "the same: 99 % are below");
  visit("latency_max_us", f.latency_max_us, "us", "the same: longest");
}

class RealtimeAccumulator {
 public:
  RealtimeAccumulator(double speed, std::int64_t step_us, std::int64_t steps)
      : speed_(speed), fallbacks_(step_us, speed, steps) {}

  RealtimeAccumulator(RealtimeAccumulator&&) = default;
  RealtimeAccumulator& operator=(RealtimeAccumulator&&) = default;

  /// Adds the next STATUS of the log.
  void Add(const status_t& status);
  void Add(RealtimePriority priority) { priority_ = std::move(priority); }
  /// Adds the next step of the log. `there` has the channels of which the step has a message.
  void AddStep(const runtime::ChannelSet& there);

  /// @param has_all whether the log has every message that the recorder has received; true for a
  ///     log that agrees with its seal
  RealtimeFigures Result(bool has_all = true) const;

 private:
  /// A process, with its last STATUS.
  struct Process {
    status_t status;
    bool is_checked = false;                            // whether `unlogged` is of this STATUS
    std::array<std::int64_t, kNumChannels> unlogged{};  // of each channel, up to this STATUS
  };

  /// Compares the number of published messages with the number of logged messages.
  void Check(Process& process);
  bool HasStatus(Role role) const;
  /// Whether the log lacks a message of a channel, and no STATUS says whether this message was
  /// published.
  bool MayLack(std::size_t channel, bool has_all) const;
  /// Lower bound of the number of messages of a channel that were published but are not in the log.
  /// Messages that came too late for the recorder do not count here.
  std::int64_t Unlogged(std::size_t channel) const;

  double speed_;
  runtime::FallbackLog fallbacks_;
  std::optional<RealtimePriority> priority_;
  std::int64_t steps_ = 0;                           // number of steps in the log
  std::int64_t late_steps_ = 0;                      // of these, the steps before the first TRUTH
  std::array<std::int64_t, kNumChannels> logged_{};  // number of logged messages of each channel
  // For each channel: the number of steps without a message of this channel, after the last STATUS
  // of its producer.
  std::array<std::int64_t, kNumChannels> unchecked_{};
  // The last STATUS of each process, by role and instance. The counters of a STATUS begin at the
  // start of the process.
  std::map<std::pair<std::string, std::int64_t>, Process> last_;
  std::deque<runtime::ChannelSet> kept_;  // the channels that each of the last steps has
  // The processes whose last STATUS names a step that AddStep() has not added yet, by this step.
  std::multimap<std::int64_t, Process*> due_;
};

}  // namespace fogline::log
