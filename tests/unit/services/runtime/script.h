// A role or a run coordinator alone on a bus in memory. The test publishes the messages of all
// other processes, and receives the answers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenario/io/loader.h"
#include "services/runtime/node/node.h"
#include "services/runtime/node/work.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/scenario_parts.h"

namespace fogline::test {

/// Publishes the messages of all other processes of a run, and collects the answers.
class Script {
 public:
  static constexpr std::int64_t kRunId = 7;

  explicit Script(const Scenario& scenario = {}) : text_(PrintScenario(scenario)) {}

  runtime::Bus& bus() { return bus_; }
  const std::string& text() const { return text_; }

  /// Collects all messages on the channel of M from this call on.
  template <class M>
  std::vector<M>& Listen() {
    auto& heard = std::get<std::vector<M>>(heard_);
    bus_.Subscribe(ChannelOf<M>().name, [&heard](runtime::Bytes bytes) {
      M message{};
      if (runtime::Decode(bytes, message)) heard.push_back(message);
    });
    return heard;
  }

  template <class M>
  void Say(M message) {
    if constexpr (std::is_same_v<M, run_t>) {
      if (message.sequence == 0) message.sequence = ++sequence_;
    }
    std::vector<std::uint8_t> bytes;
    runtime::Encode(message, bytes);
    bus_.Publish(ChannelOf<M>().name, bytes);
    if (bus_.Wait(Duration::zero())) bus_.Drain();  // Wait() sets the time of arrival
  }

  /// A message of a step. All fields except the header are zero.
  template <class M>
  static M Of(std::int64_t step) {
    M message{};
    message.header = {.run_id = kRunId, .step = step, .utime = step * 100'000};
    return message;
  }

  /// The runner announces the run with all parts of the scenario.
  /// @param speed of a run in real time, 0 for a run in lockstep
  void SayRun(std::int8_t phase, std::int64_t progress, double speed = 0) {
    const std::vector<std::string> parts = runtime::SplitScenario(text_);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      run_t run = runtime::MakeRunPart(kRunId, phase, 0, runtime::HashOf(text_), parts, i);
      run.progress = progress;
      run.realtime = speed > 0 ? 1 : 0;
      run.pace = speed;
      Say(WithDriver(std::move(run), 0));
    }
  }

  /// Adds to a message of the runner that the driver is started elsewhere.
  /// @param holder instance of the process that is the driver of the run, 0 if the run waits for a
  /// driver
  static run_t WithDriver(run_t run, std::int64_t holder) {
    run.num_external = 1;
    run.external = {"driver"};
    run.holder = {holder};
    return run;
  }

  void AskFor(std::string_view channel, std::int64_t first, std::int32_t count) {
    auto resend = Of<resend_t>(first);
    resend.channel = channel;
    resend.count = count;
    resend.requester = "test";
    Say(resend);
  }

  /// Calls the role once, for the work that is due at this time. The time since the last call does
  /// not matter.
  void Poll(runtime::Work& role, TimePoint now = Clock::now()) {
    wakes_[&role] = std::max(role.node().Poll(now), now + milliseconds(1));
    bus_.Drain();
  }
  /// Calls the role at each time that the role has requested, up to this time, as its process
  /// would.
  void PollUpTo(runtime::Work& role, TimePoint now = Clock::now()) {
    TimePoint& wake = wakes_.try_emplace(&role, TimePoint::max()).first->second;
    while (wake < now) Poll(role, wake);
    Poll(role, now);
  }

 private:
  std::map<runtime::Work*, TimePoint> wakes_;  // the next call that each role has requested
  std::string text_;
  std::int64_t sequence_ = 0;  // of the runner's messages
  std::tuple<std::vector<run_t>, std::vector<resend_t>, std::vector<status_t>, std::vector<truth_t>,
             std::vector<driver_command_t>, std::vector<track_t>, std::vector<arbitration_t>>
      heard_;
  runtime::Bus bus_{"memq://"};
};

}  // namespace fogline::test
