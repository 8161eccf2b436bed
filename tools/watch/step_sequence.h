// Which steps of a channel have been seen: what was lost, came late or came twice. Not a receiver:
// it is told the steps and the times.
#pragma once

#include <bitset>
#include <cstdint>

#include "services/runtime/clock.h"
#include "services/runtime/step_ring.h"

namespace fogline {

/// The steps of one channel of one run, as they arrive. Steps before the first one seen count as
/// nothing: whoever begins to watch in the middle of a run has not lost its beginning.
class StepSequence {
 public:
  struct Counts {
    std::int64_t newest = -1;
    std::int64_t lost = 0;       // left the window without having been seen
    std::int64_t missing = 0;    // in the window, not seen yet: a repair may still bring them
    std::int64_t late = 0;       // seen for the first time after a newer one
    std::int64_t duplicate = 0;  // seen before, or older than the window
    std::int64_t stray = 0;      // impossible, or so far ahead that they belong to nothing
  };

  void Add(std::int64_t step, TimePoint now);
  Counts counts() const;

  /// Nobody but the recorder can repeat a step that is so much older than the newest.
  static constexpr std::int64_t kWindow = kRingSteps;
  /// No run has so many steps; the arithmetic below has no end in sight.
  static constexpr std::int64_t kMaxStep = std::int64_t{1} << 62;
  /// A step so far ahead is believed only when its successor follows at once: MAX_DROPOUT of the
  /// algorithm for sequence numbers of RTP (RFC 3550, appendix A.1), as is the rule. What lies
  /// between is not counted as lost, nobody knows whether it was ever sent.
  static constexpr std::int64_t kMaxJump = 3000;
  /// Old steps while nothing new has come for so long: the run begins again, as when a log is
  /// played twice.
  static constexpr Duration kBeginsAgain = milliseconds(1000);

 private:
  void StartAt(std::int64_t step);
  void MoveTo(std::int64_t newest);

  Counts counts_;              // `missing` is computed when asked for
  std::int64_t first_ = 0;     // first step of the sequence
  std::bitset<kWindow> seen_;  // bit i: step newest - i
  std::int64_t awaited_ = -1;  // successor of a step too far ahead
  TimePoint progressed_{};     // when `newest` grew last
};

}  // namespace fogline
