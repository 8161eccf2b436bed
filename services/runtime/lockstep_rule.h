// Lockstep: a node keeps a ring of messages per input and computes step k exactly once, when all
// its inputs for step k are there, in whatever order they came. It encodes its outputs once and
// keeps the bytes. Nothing is ever sent twice on suspicion: who misses an input asks for it
// (RESEND), and who is asked for what he cannot compute yet asks further up. So any loss below 100
// % only costs time.
//
// Catching up. RUN says how far the world is. A node that joins late (its predecessor was killed)
// computes everything from step 0 on again, from inputs for which it asks many steps at a time. Old
// ones come from the recorder, the last ones from their producers. It publishes only what the
// recorder does not answer for.
#pragma once

#include <cstdint>

#include "services/runtime/fire_rule.h"
#include "services/runtime/patience.h"
#include "services/runtime/step_ring.h"

namespace fogline {

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
  /// All that the next step is made of is there.
  bool InputsReady() const { return FirstMissing() == nullptr; }

 private:
  /// First input that the next step waits for, or nullptr.
  const Input* FirstMissing() const;
  /// First step of an input that is of use.
  std::int64_t FirstNeeded(const Input& input) const;
  TimePoint Repair(TimePoint now);
  void AskForMissing(TimePoint now);
  /// Steps from `first` to `last` that an input lacks and that should be asked for together.
  StepRange Lacking(const Input& input, std::int64_t first, std::int64_t last) const;
  /// The next step is older than what was under way when this node joined.
  bool CatchingUp() const { return next() <= late_; }

  std::int64_t expected_;    // highest step that is known to be under way
  std::int64_t late_;        // last step to catch up with
  std::int64_t asked_ = -1;  // last step whose inputs were asked for
  Patience patience_;
};

}  // namespace fogline
