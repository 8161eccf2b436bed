#include "services/runtime/run_seeker.h"

#include <algorithm>

namespace fogline {

std::optional<Announcement> RunSeeker::Look(TimePoint now) {
  listener_.Look();
  if (tried_) return std::nullopt;
  for (const Announcement& run : listener_.Runs()) {
    if (!run.Awaits(role_) || std::ranges::find(in_vain_, run.run_id) != in_vain_.end()) continue;
    tried_ = {.run_id = run.run_id, .at = now};
    return run;
  }
  return std::nullopt;
}

void RunSeeker::GiveUp() {
  in_vain_.push_back(tried_->run_id);
  if (in_vain_.size() > kMaxInVain) in_vain_.pop_front();
  tried_.reset();
}

}  // namespace fogline
