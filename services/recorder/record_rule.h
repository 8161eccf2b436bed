// The recorder's rule in real time: the world does not wait for the recorder. The recorder writes
// steps in order as soon as they are complete. The recorder asks for a missing message while the
// producer can still have it. A step that stays incomplete is written without the missing messages.
// RUN tells the recorder that a step has begun, even if no message of the step has come. Each
// STATUS, each DRIVER_INPUT and each TRIAL is also written into the log, after the step in which it
// came. The reason is that the states of the roles, the acts of a person and the facts of a trial
// are part of the record.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <vector>

#include "services/runtime/node/fire_rule.h"
#include "services/runtime/node/rate_limiter.h"
#include "services/runtime/realtime/realtime_watch.h"
#include "services/runtime/wire/trial.h"

namespace fogline::recorder {

class RecordRule final : public runtime::FireRule {
 public:
  RecordRule(runtime::Parts& parts, const Scenario& scenario);

  void OnInput(std::size_t input, std::int64_t step, runtime::Arrival& arrival) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override;
  /// Writes the states of the inputs and the statistics into STATUS. Only messages that the log
  /// lacks count as late (`input_late`), because RealtimeFigures::unlogged_messages is computed
  /// from this count.
  void WriteStatus(TimePoint now) override;

  /// Calls `use` once for each STATUS, DRIVER_INPUT and TRIAL that came in this step or before.
  void TakeEvents(std::int64_t step,
                  const std::function<void(std::string_view channel, runtime::Bytes)>& use);

 private:
  /// A step that has begun and is not written yet.
  struct Open {
    std::int64_t step = -1;
    TimePoint seen{};  // time of its first message, or of the first sign that it has begun
    int asked = 0;
    TimePoint asked_at{};
  };
  struct Heard {
    std::int64_t step;  // the newest step when the message came
    std::size_t channel;
    std::vector<std::uint8_t> bytes;
  };

  /// Messages of an input that came after their step was written. Each message is counted once.
  struct Refused {
    std::int64_t count = 0;
    std::array<std::int64_t, runtime::kRingSteps>
        steps{};  // by slot: last counted step plus one; 0 if no step
  };

  /// Writes the steps that are due, and asks for the messages that other steps lack.
  /// @return the latest time for the next call
  TimePoint Fire(TimePoint now);
  /// Counts a late message that is not in the log.
  void CountRefused(std::size_t input, std::int64_t step);
  /// Notes that all steps up to this step have begun. If a message of these steps has not come
  /// after the time overdue_, the recorder asks for this message.
  void OpenUpTo(std::int64_t step, TimePoint now);
  Open& OpenAt(std::int64_t step, TimePoint now);
  bool Complete(std::int64_t step) const;
  /// Whether the recorder expects no further message of the step.
  bool GivenUp(std::int64_t step, TimePoint now);
  void AskForHoles(TimePoint now);
  void Listen();
  void ListenToInputs();
  /// The counter of the reason why a TRIAL is refused; nullptr if it is accepted.
  runtime::RefusalCounter WhyRefused(runtime::Arrival& trial);
  void Hear(std::size_t channel, runtime::Bytes bytes);

  runtime::Parts& parts_;
  runtime::RealtimeWatch watch_;
  Duration overdue_;  // time that the recorder waits before it asks for a message
  std::array<Open, runtime::kRingSteps> open_{};
  std::array<Refused, kNumChannels> refused_{};  // by index in Inputs::all()
  std::deque<Heard> heard_;
  runtime::RateLimiter inputs_per_s_;
  runtime::RateLimiter facts_per_s_{runtime::kMostTrialFactsPerSecond,
                                    runtime::kMostTrialFactsAtOnce};
  TimePoint ask_at_{};
  bool listening_ = false;
};

}  // namespace fogline::recorder
