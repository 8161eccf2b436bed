#include "services/runtime/run_seeker.h"

#include <algorithm>

namespace fogline {

std::optional<Announcement> RunSeeker::Look(TimePoint now) {
  pauses_.Attend(now);
  listener_.Look();
  if (tried_) return std::nullopt;
  for (const Announcement& run : listener_.Runs()) {
    if (!run.Awaits(role_) || std::ranges::find(in_vain_, run.run_id) != in_vain_.end()) continue;
    tried_ = {.run_id = run.run_id, .at = now};
    return run;
  }
  return std::nullopt;
}

bool RunSeeker::InVain(TimePoint now) {
  if (!tried_) return false;
  now = pauses_.Attend(now);
  listener_.Look();
  const std::vector<Announcement> runs = listener_.Runs();
  return pauses_.HeldAgainst(tried_->at, now) > kPatience ||
         std::ranges::find(runs, tried_->run_id, &Announcement::run_id) == runs.end();
}

void RunSeeker::GiveUp() {
  Ignore(tried_->run_id);
  tried_.reset();
}

void RunSeeker::Ignore(std::int64_t run_id) {
  in_vain_.push_back(run_id);
  if (in_vain_.size() > kMaxInVain) in_vain_.pop_front();
}

}  // namespace fogline
