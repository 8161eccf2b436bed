#include "services/runtime/lockstep/lead_rule.h"

#include <algorithm>

namespace fogline::runtime {

void LeadRule::OnGo(const run_t& run, TimePoint now) {
  gate_.OnGo(run, now);
  Expect(next());
  Advance(now);
}

void LeadRule::OnProgress() {
  gate_.BegunBefore(progress());
  LockstepRule::OnProgress();
}

TimePoint LeadRule::Poll(TimePoint now) {
  if (gate_.started()) Expect(next());
  if (gate_.Finished(next()) && InputsReady()) SetState(status_t::DONE);
  if (const auto step = gate_.WantsRecorded(next(), now)) {
    Ask(ChannelOf<status_t>().name, {.first = *step, .count = 1});
  }
  const TimePoint at = gate_.NextPoll(next(), now);
  return Running() ? std::min(at, LockstepRule::Poll(now)) : at;
}

}  // namespace fogline::runtime
