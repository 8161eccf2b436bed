// Lockstep for the role that begins the steps (the world): as LockstepRule, but not before GO, not
// faster than the pace, and not too far ahead of what is on disk (lead_gate.h).
#pragma once

#include "services/runtime/lead_gate.h"
#include "services/runtime/lockstep_rule.h"

namespace fogline {

class LeadRule final : public LockstepRule {
 public:
  LeadRule(Node& node, LeadGate& gate) : LockstepRule(node), gate_(gate) {
    gate_.BegunBefore(progress());
  }

  void OnGo(const run_t& run, TimePoint now) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override;
  void SetFinal(std::int64_t step) override { gate_.SetFinal(step); }

 private:
  bool MayCompute(std::int64_t step, TimePoint now) override { return gate_.Open(step, now); }

  LeadGate& gate_;
};

}  // namespace fogline
