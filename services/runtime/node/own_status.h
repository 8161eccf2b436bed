// The state of a role in its run, and the STATUS that reports this state.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/node/run_news.h"
#include "services/runtime/node/work.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/refusals.h"

namespace fogline::runtime {

class OwnStatus {
 public:
  /// The longest time between two STATUS messages of a role.
  static constexpr Duration kHeartbeat = milliseconds(200);

  /// @param rule decides when the role computes a step; null until the role has joined a run
  OwnStatus(Bus& bus, Role role, const RunNews& run, Work& work,
            const std::unique_ptr<FireRule>& rule);

  /// The next STATUS. All parts of the role write their counts into this message.
  status_t& message() { return message_; }
  const status_t& message() const { return message_; }
  /// Counts a message that is refused.
  void Refuse(RefusalCounter kind) { ++(message_.*kind); }

  /// Whether the role waits: it has not received the whole scenario of a run yet.
  bool Waits() const { return message_.state == status_t::WAITING; }
  /// Whether the role may compute.
  bool Running() const {
    return !left_ && (message_.state == status_t::READY || message_.state == status_t::RUNNING);
  }
  /// Whether the role's part in the run is over, because of STOP, a signal, or a failure that the
  /// role has reported.
  bool left() const { return left_; }
  /// Whether the role has left its run, so that this process may take part in another run.
  bool released() const { return message_.state == status_t::LEFT; }

  void SetState(std::int8_t state);
  /// Ends the role's part in the run with an error.
  void Fail(const std::string& error);
  /// Ends the role's part in the run for an outside reason: STOP, or a signal. Existing results are
  /// kept.
  void Leave();
  /// Gives up the role's place in the run. @param why the reason, which STATUS reports
  void Release(const std::string& why);

  /// Publishes a STATUS now. While the role knows no run id, nothing is published.
  void Publish();
  /// Publishes a STATUS if one is due. @return when the next STATUS is due
  TimePoint Poll(TimePoint now);
  /// If there are failed sends to report, makes the next STATUS due soon. @return whether there are
  /// failed sends to report
  bool HastensForFailedSends();

 private:
  /// Encodes the message into buffer_. Shortens the error text if the message would be longer than
  /// kMaxMessageBytes.
  void EncodeMessage();

  void SetError(const std::string& error);

  Bus& bus_;
  const RunNews& run_;
  Work& work_;
  const std::unique_ptr<FireRule>& rule_;
  bool left_ = false;
  status_t message_{};
  std::vector<std::uint8_t> buffer_;
  TimePoint said_at_{};  // when the last STATUS was sent
  TimePoint due_{};      // when the next STATUS is due
  TimePoint use_at_{};   // when to measure CPU time and memory again
};

}  // namespace fogline::runtime
