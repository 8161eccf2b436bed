// Lockstep: a node keeps a ring of messages per input. It computes step k exactly once, when all
// its inputs for step k are there, in any order of arrival. It encodes its outputs once and keeps
// the bytes. No message is sent again without a request: a node that misses an input asks for it
// (RESEND). A node that is asked for an output that it cannot compute yet asks for its own inputs.
// So any loss below 100 % only costs time.
//
// Catching up. RUN says how far the world is. A node that joins late (its predecessor was killed)
// computes all steps from step 0 on, and asks for the inputs of many steps at a time. The recorder
// sends old inputs, their producers send the last ones. The node does not publish old outputs,
// because the recorder has them.
#pragma once

#include <cstdint>

#include "services/runtime/lockstep/fire_rule.h"
#include "services/runtime/lockstep/retry_timer.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class LockstepRule : public FireRule {
 public:
  explicit LockstepRule(Node& node);

  StepRing::Verdict Classify(std::size_t input, std::int64_t step, Bytes bytes) override;
  void OnInput(std::size_t input, std::int64_t step, TimePoint time) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override;
  void Expect(std::int64_t step) override { expected_ = std::max(expected_, step); }
  void OnAskedAhead(std::int64_t step, TimePoint now) override;
  void WriteStatus(TimePoint now) override;

 protected:
  /// Whether the step may be computed now although its inputs are there.
  virtual bool MayCompute(std::int64_t /*step*/, TimePoint /*now*/) { return true; }
  /// Computes every step that can be computed.
  void Advance(TimePoint now);
  /// Whether all inputs of the next step are there.
  bool InputsReady() const { return FirstMissing() == nullptr; }

 private:
  /// The first input that the next step waits for; nullptr if there is none.
  const Input* FirstMissing() const;
  /// The first step of an input that the node still needs.
  std::int64_t FirstNeeded(const Input& input) const;
  TimePoint Repair(TimePoint now);
  void AskForMissing(TimePoint now);
  /// The steps from `first` to `last` that an input lacks and that one request should ask for.
  StepRange Lacking(const Input& input, std::int64_t first, std::int64_t last) const;
  /// Whether the next step is older than the steps that were under way when this node joined.
  bool CatchingUp() const { return next() <= late_; }

  std::int64_t expected_;    // highest step that is known to be under way
  std::int64_t late_;        // last step to catch up with
  std::int64_t asked_ = -1;  // last step whose inputs were asked for
  RetryTimer retry_;
};

}  // namespace fogline::runtime
