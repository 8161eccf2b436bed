// The outputs of a role. This class publishes each step once, stores the last steps, and answers
// requests for them. In lockstep, a role that catches up does not publish steps that are far behind
// the run, because the recorder has these steps on disk and answers requests for them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/node/fire_rule.h"
#include "services/runtime/node/parts.h"
#include "services/runtime/node/rate_limiter.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/load_shedder.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class Outputs {
 public:
  Outputs(const Outputs&) = delete;  // the bus refers to this object
  Outputs& operator=(const Outputs&) = delete;
  /// @param rule decides when the role computes a step; null until the role has joined a run
  Outputs(Parts& parts, Role role, Work& work, const std::unique_ptr<FireRule>& rule);

  /// Publishes the output of a step on one of the role's channels (an index in kChannels), and
  /// stores the output. In lockstep, the output of a step that is at least 2 * kMaxAhead steps
  /// behind the run is only stored, because the recorder has this step on disk.
  /// @throws std::runtime_error if the output is too large
  void Publish(std::size_t channel, std::int64_t step, Bytes bytes);
  /// The rate limit for answers to requests. Answers with STATUS count, and answers with steps that
  /// are older than the two newest steps. Answers with the two newest steps do not count.
  RateLimiter& limiter() { return limiter_; }

 private:
  struct Output {
    std::size_t channel;
    Bus::Topic& topic;
    StepRing ring;
    std::array<TimePoint, kRingSteps> answered{};  // when each step was last published again
  };

  void OnResend(Bytes bytes);
  void AnswerFrom(Output& output, StepRange steps, TimePoint now);

  Parts& parts_;
  Work& work_;
  const std::unique_ptr<FireRule>& rule_;
  std::vector<Output> outputs_;
  // The limits in messages per second and in messages per burst. On a network that loses a third of
  // the messages, repairs need a few hundred messages a second.
  RateLimiter limiter_{2000, 500};
  LoadShedder requests_{3000};  // limit in RESEND per second; a bad network causes far fewer
};

}  // namespace fogline::runtime
