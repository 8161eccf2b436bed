// The rule (fire_rule.h) that decides in lockstep when a node computes a step. A node stores a ring
// of messages per input. It computes step k exactly once, when all its inputs for step k have come,
// in any order. It encodes its outputs once and stores the bytes. No message is sent again without
// a request: a node that lacks an input asks for it (RESEND). If a node cannot compute a requested
// output yet, it asks for its own inputs. So any loss below 100 % only costs time.
//
// Catching up. RUN says which step the world has reached. A node joins late if, for example, the
// role's earlier process was killed. A late node computes all steps from step 0 on, and asks for
// the inputs of many steps at a time. The recorder sends old inputs, and the producers send the
// newest inputs. The node does not publish old outputs, because the recorder has them.
//
// The role that begins the steps (the world) also waits for GO, keeps to the pace, and stays at
// most kMaxAhead steps ahead of the log on disk (step_gate.h).
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/runtime/lockstep/retry_timer.h"
#include "services/runtime/lockstep/step_gate.h"
#include "services/runtime/node/fire_rule.h"
#include "services/runtime/node/parts.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class LockstepRule final : public FireRule {
 public:
  /// @param gate the gate of the role that begins the steps; nullptr for every other role
  explicit LockstepRule(Parts& parts, StepGate* gate = nullptr);

  void OnGo(const run_t& run, TimePoint now) override;
  void OnInput(std::size_t input, std::int64_t step, Arrival& arrival) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override;
  void Expect(std::int64_t step) override { expected_ = std::max(expected_, step); }
  void OnAskedAhead(std::int64_t step, TimePoint now) override;
  void WriteStatus(TimePoint now) override;
  void SetFinal(std::int64_t step) override;

 private:
  std::int64_t next() const { return parts_.steps.next(); }
  StepRing::Verdict Judge(const Input& input, std::int64_t step, Bytes bytes) const;
  /// The first input that the next step waits for; nullptr if no input is missing.
  const Input* FirstMissing() const;
  /// The lowest step of this input whose message the role still needs.
  std::int64_t FirstNeeded(const Input& input) const;
  /// Computes every step that can be computed.
  void Advance(TimePoint now);
  /// Does the work that is due for gate_: asks for the recorder's STATUS, or reports DONE. @return
  /// the latest time for the next call
  TimePoint PollGate(TimePoint now);
  TimePoint Repair(TimePoint now);
  void AskForMissing(TimePoint now);
  /// The steps that one request asks for. They are between `first` and `last`, and begin with a
  /// step that the input lacks. `count` is 0 if there is nothing to ask for.
  StepRange Lacking(const Input& input, std::int64_t first, std::int64_t last) const;
  /// Whether this role is behind the run, so that it asks for many steps at a time.
  bool CatchingUp() const { return next() <= late_; }

  Parts& parts_;
  StepGate* const gate_;
  std::int64_t expected_;    // highest step that is known to have begun
  std::int64_t late_;        // a late role catches up until it has computed this step
  std::int64_t asked_ = -1;  // last step for whose inputs the role has asked
  RetryTimer retry_;
};

}  // namespace fogline::runtime
