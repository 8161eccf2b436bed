#include "services/runtime/discovery/run_seeker.h"

#include <algorithm>

#include "services/runtime/transport/lcm_url.h"

namespace fogline::runtime {

std::optional<Announcement> RunSeeker::Look(TimePoint now) {
  pauses_.Attend(now);
  listener_.Look();
  const std::vector<Announcement> runs = listener_.Runs();
  for (const Announcement& run : runs) {
    if (!run.Awaits(role_)) {
      std::erase_if(in_vain_, [&](const Try& last) { return last.run_id == run.run_id; });
    }
  }
  std::erase_if(in_vain_,
                [&](const Try& last) { return pauses_.HeldAgainst(last.at, now) >= kTryAgain; });
  if (tried_) return std::nullopt;
  for (const Announcement& run : runs) {
    if (!run.Awaits(role_) || IsOwn(run) ||
        std::ranges::find(in_vain_, run.run_id, &Try::run_id) != in_vain_.end()) {
      continue;
    }
    tried_ = {.run_id = run.run_id, .at = now};
    own_.reset();
    return run;
  }
  return std::nullopt;
}

bool RunSeeker::IsOwn(const Announcement& run) const {
  return own_ && own_->run_id == run.run_id && SameNetwork(own_->url, run.url);
}

bool RunSeeker::InVain(TimePoint now) {
  if (!tried_) return false;
  now = pauses_.Attend(now);
  listener_.Look();
  const std::vector<Announcement> runs = listener_.Runs();
  const bool announced =
      std::ranges::find(runs, tried_->run_id, &Announcement::run_id) != runs.end();
  // The announcement of a run may come as late as kGone after this object was made. Until then, a
  // missing announcement does not show that the run is over.
  const bool would_know = pauses_.HeldAgainst(began_, now) > Announcements::kGone;
  return pauses_.HeldAgainst(tried_->at, now) > kSilentLimit || (would_know && !announced);
}

void RunSeeker::GiveUp(TimePoint now) {
  in_vain_.push_back({.run_id = tried_->run_id, .at = now});
  tried_.reset();
  if (in_vain_.size() > kMaxInVain) in_vain_.pop_front();
}

}  // namespace fogline::runtime
