// The inputs of a role: the channels that the role reads, and the last steps of each channel. A
// message is refused if it is of another run, of another type, or of a step that the run does not
// have. The role's FireRule (fire_rule.h) decides which other messages are stored.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/node/own_status.h"
#include "services/runtime/node/run_news.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

/// One channel that a role reads.
struct Input {
  std::size_t channel;       // index in kChannels
  std::int64_t fingerprint;  // fingerprint of the channel's message type
  std::int64_t lag;          // step k uses this input's step k - lag
  bool on_demand;            // whether this is an input on demand (algorithm.h)
  StepRing ring;
  TimePoint heard{};
  // Called with each message that is new and valid; may be empty.
  std::function<void(std::int64_t step, Arrival& arrival)> keep{};

  /// Whether this input has the message that a step uses. Also true if step - lag is below 0,
  /// because the step then uses no message of this input.
  bool ReadyFor(std::int64_t step) const { return step < lag || ring.Has(step - lag); }
};

class Inputs {
 public:
  Inputs(const Inputs&) = delete;  // the bus refers to this object
  Inputs& operator=(const Inputs&) = delete;
  /// Subscribes to the channels that the role reads in every scenario. The recorder reads every
  /// channel that has a message in each step (Pace::kStep).
  /// @param rule decides which messages are stored; null until the role has joined a run
  Inputs(Bus& bus, Role role, const RunNews& run, OwnStatus& own,
         const std::unique_ptr<FireRule>& rule);

  /// The role's inputs in the order of kChannels. Inputs that ReadOnDemand() has added come last.
  /// References are valid until the next ReadOnDemand().
  std::span<Input> all() { return inputs_; }
  std::span<const Input> all() const { return inputs_; }
  /// The input of a channel (an index in kChannels). @pre the role reads the channel
  Input& Of(std::size_t channel);
  /// Subscribes to a channel that the role reads only in some scenarios. Call this function in
  /// Work::Join() if the scenario of the run needs the channel.
  Input& ReadOnDemand(std::size_t channel);

  /// Stores a message of an input if `verdict` permits this and the message is valid. Counts the
  /// message if it is refused. In lockstep, the role fails if two messages of the same step and
  /// channel have different bytes.
  /// @param verdict what the role's FireRule has decided about the message
  /// @return whether the message was stored
  bool Keep(std::size_t input, std::int64_t step, Arrival& arrival, StepRing::Verdict verdict);
  /// Stores a message that the recorder has read from the log of an earlier recorder process.
  void Remember(std::size_t input, std::int64_t step, Bytes bytes);

 private:
  Input& Read(std::size_t channel, bool on_demand);
  void OnMessage(std::size_t input, Arrival& arrival);
  /// The error text for a message that contradicts an earlier message of its step and channel.
  std::string Contradiction(std::int64_t step, const ChannelInfo& channel) const;

  Bus& bus_;
  const Role role_;
  const RunNews& run_;
  OwnStatus& own_;
  const std::unique_ptr<FireRule>& rule_;
  std::vector<Input> inputs_;
  std::int64_t remembered_ = 0;  // all steps before this step were read from a log
};

}  // namespace fogline::runtime
