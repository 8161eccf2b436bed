#include "tools/watch/step_sequence.h"

#include <algorithm>

namespace fogline::watch {

void StepSequence::Add(std::int64_t step, TimePoint now) {
  if (step < 0 || step > kMaxStep) {
    ++counts_.stray;
    return;
  }
  const std::int64_t newest = counts_.newest;
  if (newest < 0) {
    StartAt(step);
    progressed_ = now;
    return;
  }
  if (step - newest > kMaxJump) {
    const bool believed = step == awaited_;
    awaited_ = step + 1;
    if (!believed) {
      ++counts_.stray;
      return;
    }
    StartAt(step);
    progressed_ = now;
    return;
  }
  if (step > newest) {
    awaited_ = -1;
    MoveTo(step);
    progressed_ = now;
    return;
  }
  const std::int64_t age = newest - step;
  if (age >= kWindow) {
    if (now - progressed_ >= kBeginsAgain) {
      StartAt(step);
      progressed_ = now;
    } else {
      ++counts_.duplicate;
    }
    return;
  }
  const auto bit = static_cast<std::size_t>(age);
  if (seen_[bit]) {
    ++counts_.duplicate;
    return;
  }
  seen_[bit] = true;
  ++counts_.late;
}

StepSequence::Counts StepSequence::counts() const {
  Counts counts = counts_;
  if (counts.newest < 0) return counts;
  const std::int64_t in_window = std::min(kWindow, counts.newest - first_ + 1);
  for (std::int64_t age = 0; age < in_window; ++age) {
    if (!seen_[static_cast<std::size_t>(age)]) ++counts.missing;
  }
  return counts;
}

void StepSequence::StartAt(std::int64_t step) {
  counts_.newest = step;
  first_ = step;
  seen_.reset();
  seen_[0] = true;
  awaited_ = -1;
}

void StepSequence::MoveTo(std::int64_t newest) {
  const std::int64_t by = newest - counts_.newest;
  // The loop visits the steps that leave the window, and the skipped steps that are older than the
  // new window. A step that was not seen counts as lost.
  for (std::int64_t step = std::max(first_, counts_.newest - kWindow + 1); step <= newest - kWindow;
       ++step) {
    const std::int64_t age = counts_.newest - step;
    if (age < 0 || !seen_[static_cast<std::size_t>(age)]) ++counts_.lost;
  }
  seen_ <<= static_cast<std::size_t>(std::min(by, kWindow));
  seen_[0] = true;
  counts_.newest = newest;
}

}  // namespace fogline::watch
