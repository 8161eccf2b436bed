// Lockstep for the role that begins the steps (the world). It is a LockstepRule that also waits for
// GO, keeps to the pace, and stays near the log on disk (step_gate.h).
#pragma once

#include "services/runtime/lockstep/lockstep_rule.h"
#include "services/runtime/lockstep/step_gate.h"

namespace fogline::runtime {

class LeadRule final : public LockstepRule {
 public:
  LeadRule(Node& node, StepGate& gate) : LockstepRule(node), gate_(gate) {
    gate_.BegunBefore(progress());
  }

  void OnGo(const run_t& run, TimePoint now) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override;
  void SetFinal(std::int64_t step) override { gate_.SetFinal(step); }

 private:
  bool MayCompute(std::int64_t step, TimePoint now) override { return gate_.Open(step, now); }

  StepGate& gate_;
};

}  // namespace fogline::runtime
