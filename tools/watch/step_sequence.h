// Counts which steps of a channel were seen, lost, late or repeated. The caller passes steps and
// times as arguments.
#pragma once

#include <bitset>
#include <cstdint>

#include "common/clock.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::watch {

/// The steps of one channel of one run, as they arrive. Steps before the first seen step do not
/// count: an observer that starts in the middle of a run has not lost the beginning of this run.
class StepSequence {
 public:
  struct Counts {
    std::int64_t newest = -1;
    std::int64_t lost = 0;       // left the window before they were seen
    std::int64_t missing = 0;    // in the window, not seen yet; a repair may still bring them
    std::int64_t late = 0;       // seen for the first time after a newer step
    std::int64_t duplicate = 0;  // seen before, or older than the window
    std::int64_t stray = 0;      // impossible, or too far ahead to be believed
  };

  void Add(std::int64_t step, TimePoint now);
  Counts counts() const;

  /// Number of the newest steps that are remembered. Only the recorder can repeat an older step.
  static constexpr std::int64_t kWindow = runtime::kRingSteps;
  /// No run has this many steps. Below this limit, the arithmetic of this class does not overflow.
  static constexpr std::int64_t kMaxStep = std::int64_t{1} << 62;
  /// A step that is further ahead than this counts as stray. If the next new step is its successor,
  /// the sequence starts again at this successor. This rule and the number (MAX_DROPOUT) are from
  /// the algorithm for sequence numbers of RTP (RFC 3550, appendix A.1). The skipped steps are not
  /// counted as lost, because it is unknown whether they were ever sent.
  static constexpr std::int64_t kMaxJump = 3000;
  /// If no new step has come for this long, a step that is older than the last kWindow steps
  /// restarts the sequence. This happens when a log is played twice.
  static constexpr Duration kBeginsAgain = milliseconds(1000);

 private:
  void StartAt(std::int64_t step);
  void MoveTo(std::int64_t newest);

  Counts counts_;              // without `missing`, which counts() computes
  std::int64_t first_ = 0;     // first step of the sequence
  std::bitset<kWindow> seen_;  // bit i: step newest - i
  std::int64_t awaited_ = -1;  // successor of a step that was too far ahead
  TimePoint progressed_{};     // when counts_.newest last grew
};

}  // namespace fogline::watch
