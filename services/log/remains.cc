#include "services/log/remains.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "services/log/about/log_graph.h"
#include "services/log/log_seal.h"
#include "services/log/step_order.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::log {
namespace {

static_assert(kTailBytes > (runtime::kRingSteps + 3) * kMostStepBytes);
// While a whole log is read, a STATUS is sent after each piece of this many bytes, so that the
// recorder does not count as silent. Even a slow disk reads such a piece in less than two
// heartbeats. (A heartbeat is the usual interval between two STATUS messages.)
constexpr std::int64_t kAliveEvery = 8 << 20;
// Largest number of consecutive steps that a log in real time can lack. A run that loses more steps
// has already ended for another reason.
constexpr std::int64_t kLongestGap = 1'000'000;

/// Follows the events of a log in the order in which the recorder writes them. In lockstep, these
/// are the events of whole steps. In real time, these are the messages that have arrived.
class Follower {
 public:
  /// @param steps number of steps that have ended
  /// @param head the log up to the end of these steps
  Follower(const LogFront& front, std::int64_t steps, const LogHead& head)
      : front_(front), remains_{.head = head, .steps = steps, .last = head.bytes} {}

  /// @param head the log up to the end of the event
  /// @return false at the first event that does not continue the steps of the recorder
  bool Take(const Event& event, const LogHead& head) {
    if (event.number != head.events - 1) return false;
    if (front_.realtime && IsBeside(event)) {
      if (next_ == 0) remains_.head = head;  // otherwise it goes with the step that has begun
      return true;
    }
    const std::int64_t step = StepOf(event, front_.run_id);
    if (step < 0) return false;
    return front_.realtime ? TakeRealtime(event, step, head) : TakeNext(event, step, head);
  }

  const Remains& remains() const { return remains_; }

 private:
  /// Whether the event is a STATUS, DRIVER_INPUT, TRIAL or wall clock of the run. In the log of a
  /// run in real time, such events may come between the messages of the steps. The step of the
  /// event is not checked: the STATUS of a role that has computed no step has step -1.
  bool IsBeside(const Event& event) const {
    constexpr std::array kBeside{ChannelOf<status_t>().name, ChannelOf<driver_input_t>().name,
                                 ChannelOf<trial_t>().name, kWallClockChannel};
    return std::ranges::find(kBeside, event.channel) != kBeside.end() &&
           IsOfRun(event, front_.run_id);
  }

  bool TakeNext(const Event& event, std::int64_t step, const LogHead& head) {
    const std::string_view expected = next_ < kStepChannels ? kStepNames[next_] : kWallClockChannel;
    if (event.channel != expected || step != remains_.steps) return false;
    if (event.channel == ChannelOf<truth_t>().name && runtime::Decode(event.data, truth_)) {
      last_ = truth_.last;
    }
    if (std::cmp_equal(++next_, front_.StepEvents())) {
      remains_.final = last_;
      EndSteps(step + 1, head);
    }
    return true;
  }

  /// In real time, steps may lack messages, and STATUS messages come between the steps. A step ends
  /// when it has all its messages, or when a later step begins.
  bool TakeRealtime(const Event& event, std::int64_t step, const LogHead& head) {
    if (!IsStepChannel(event.channel)) return false;
    if (step < remains_.steps || step > remains_.steps + kLongestGap) return false;
    if (step > remains_.steps) {
      const auto size = static_cast<std::int64_t>(SizeInFile(event));
      EndSteps(step, {.bytes = head.bytes - size, .events = head.events - 1});
    }
    if (event.channel == ChannelOf<truth_t>().name && runtime::Decode(event.data, truth_)) {
      remains_.final = truth_.last;
    }
    if (++next_ == kStepChannels) EndSteps(step + 1, head);
    return true;
  }

  void EndSteps(std::int64_t steps, const LogHead& head) {
    next_ = 0;
    remains_.last = remains_.head.bytes;
    remains_.steps = steps;
    remains_.head = head;
  }

  const LogFront& front_;
  Remains remains_;
  // Index of the next message in kStepNames. In real time: number of messages of the step so far.
  std::size_t next_ = 0;
  truth_t truth_{};
  bool last_ = false;
};

/// Reads from `head` up to the first event that does not continue the steps.
Remains Follow(EventLogReader& reader, const LogFront& front, std::int64_t steps, LogHead head,
               const std::function<void(std::int64_t steps)>& alive) {
  Follower follower(front, steps, head);
  reader.GoTo(head);
  std::int64_t alive_at = head.bytes + kAliveEvery;
  while (const auto event = reader.Next()) {
    head.bytes = static_cast<std::int64_t>(reader.good_bytes());
    ++head.events;
    if (!follower.Take(*event, head)) break;
    if (alive && head.bytes >= alive_at) {
      alive(follower.remains().steps);
      alive_at = head.bytes + kAliveEvery;
    }
  }
  return follower.remains();
}

/// A position in a log at which reading can begin. In lockstep, the position is the first event of
/// a step. In real time, the position is any event of a step, because an event does not show
/// whether it is the first event of its step.
struct Start {
  std::int64_t step;
  LogHead head;
};

std::optional<Start> StartIn(runtime::Bytes content, std::int64_t from, const LogFront& front) {
  std::int64_t step = -1;
  std::int64_t number = 0;
  const auto accept = [&](const Event& event) {
    // Each event takes some bytes, so no event number exceeds the size of the file.
    if (event.number < 0 || event.number > std::ssize(content)) return false;
    const auto begun = StepBegunBy(event, front.head.events, front.StepEvents(), front.run_id);
    const bool is_any = front.realtime && IsStepChannel(event.channel);
    step = is_any ? StepOf(event, front.run_id) : begun.value_or(-1);
    number = event.number;
    return step >= 0;
  };
  const auto at = FindEvent(content, static_cast<std::size_t>(from), accept);
  if (!at) return std::nullopt;
  return Start{.step = step, .head = {.bytes = static_cast<std::int64_t>(*at), .events = number}};
}

/// The contents of the log, found from its last `tail` bytes; nullopt if these bytes do not show
/// where the last complete step is.
std::optional<Remains> ReadTail(EventLogReader& reader, const LogFront& front, std::int64_t tail) {
  const std::int64_t from = std::ssize(reader.content()) - tail;
  if (from <= front.head.bytes) return std::nullopt;
  const auto start = StartIn(reader.content(), from, front);
  if (!start) return std::nullopt;
  const Remains remains = Follow(reader, front, start->step, start->head, {});
  // In real time the tail may begin in the middle of a step, so a second step must end in the tail.
  const std::int64_t least = start->step + (front.realtime ? 2 : 1);
  return remains.steps >= least ? std::optional(remains) : std::nullopt;
}

}  // namespace

std::int64_t LogFront::StepEvents() const {
  return static_cast<std::int64_t>(kStepChannels) + (wall_clock ? 1 : 0);
}

LogFront ReadFront(const std::filesystem::path& file) {
  LogFront front;
  EventLogReader reader(file);
  while (!front.parts.Complete()) {
    const auto event = reader.Next();
    run_t run{};
    if (!event || event->channel != ChannelOf<run_t>().name || !runtime::Decode(event->data, run))
      break;
    if (front.parts.empty()) {
      front.run_id = run.header.run_id;
      front.realtime = run.realtime != 0;
      front.type_fingerprint = run.type_fingerprint;
    }
    if (run.header.run_id != front.run_id || !front.parts.Add(run)) break;
    front.head.bytes = static_cast<std::int64_t>(reader.good_bytes());
    ++front.head.events;
  }
  if (!front.parts.Complete()) return front;
  auto event = reader.Next();
  if (event && event->channel == kLogGraphChannel) {
    front.head.bytes = static_cast<std::int64_t>(reader.good_bytes());
    ++front.head.events;
    event = reader.Next();
  }
  if (front.realtime) return front;
  for (std::size_t i = 0; i < kStepChannels && event; ++i) event = reader.Next();
  front.wall_clock = event && event->channel == kWallClockChannel;
  return front;
}

Remains ReadRemains(const std::filesystem::path& file, const LogFront& front,
                    const std::function<void(std::int64_t steps)>& alive, std::int64_t tail) {
  EventLogReader reader(file);
  if (const auto remains = ReadTail(reader, front, tail)) return *remains;
  return Follow(reader, front, 0, front.head, alive);
}

std::string OddEnd(const std::filesystem::path& file, const LogFront& front,
                   const Remains& remains) {
  EventLogReader reader(file);
  const std::string before =
      remains.steps == 0 ? "the scenario" : fmt::format("step {}", remains.steps - 1);
  const std::int64_t rest = std::ssize(reader.content()) - remains.head.bytes;
  if (rest > kTailBytes) {
    return fmt::format("from byte {} on, {} bytes do not continue {}", remains.head.bytes, rest,
                       before);
  }
  reader.GoTo(remains.head);
  while (const auto event = reader.Next()) {
    if (IsLogSeal(*event)) continue;
    const std::int64_t step = StepOf(*event, front.run_id);
    const bool is_usual = (IsStepChannel(event->channel) || event->channel == kWallClockChannel) &&
                          step >= remains.steps && step < remains.steps + runtime::kRingSteps;
    if (is_usual) continue;
    return fmt::format("an event on channel {} (byte {}) does not continue {}",
                       EscapeControls(event->channel), reader.good_bytes() - SizeInFile(*event),
                       before);
  }
  return "";
}

}  // namespace fogline::log
