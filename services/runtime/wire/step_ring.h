// The last steps of one channel as encoded bytes, by step.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

/// The number of steps that a ring stores. The world runs at most kMaxAhead steps ahead of the
/// recorder. So each step that a role asks for is in the ring of the channel's producer or already
/// on disk. For steps on disk, the recorder answers the requests.
inline constexpr std::int64_t kRingSteps = 64;
inline constexpr std::int64_t kMaxAhead = 32;
static_assert(2 * kMaxAhead <= kRingSteps, "some steps would be neither in a ring nor on disk");

/// A step number that no run reaches. Arithmetic on steps up to this number does not overflow.
inline constexpr std::int64_t kMaxStep = 1'000'000'000'000;

/// Steps `first` to `first + count - 1`.
struct StepRange {
  std::int64_t first;
  std::int64_t count;
};

/// The slot of a step in any ring.
inline constexpr std::size_t RingSlot(std::int64_t step) {
  return static_cast<std::size_t>(step % kRingSteps);
}

/// Ring of messages. The ring reuses its buffers: after the buffers have reached the size of the
/// messages, the ring allocates no memory.
class StepRing {
 public:
  /// How a message that arrives is judged.
  enum class Verdict {
    kNew,        // must be stored with Store()
    kDuplicate,  // known already, or so old that it is not needed
    // The ring has other bytes for the step of this message. Either the channel has two producers,
    // or the output of its producer is not a function of its inputs.
    kConflict,
    kOutOfWindow,  // of a step that cannot have begun yet
    // The message is of a current step of the run. The reader of this ring is far behind and still
    // computes older steps, so it ignores the message.
    kElsewhere,
    kLate,  // came after the end of its step
  };

  /// Judges a message of a step, in a run in lockstep.
  /// @param needed the next step that the reader of this ring needs
  Verdict Classify(std::int64_t step, Bytes bytes, std::int64_t needed) const {
    const Slot& slot = slots_[RingSlot(step)];
    if (slot.step == step) {
      return std::ranges::equal(slot.bytes, bytes) ? Verdict::kDuplicate : Verdict::kConflict;
    }
    if (slot.step > step || step < needed) return Verdict::kDuplicate;
    return step < needed + kRingSteps ? Verdict::kNew : Verdict::kOutOfWindow;
  }

  void Store(std::int64_t step, Bytes bytes) {
    Slot& slot = slots_[RingSlot(step)];
    slot.step = step;
    slot.bytes.assign(bytes.begin(), bytes.end());
    newest_ = std::max(newest_, step);
  }

  bool Has(std::int64_t step) const { return step >= 0 && slots_[RingSlot(step)].step == step; }

  /// Bytes of a step that the ring has.
  Bytes Get(std::int64_t step) const { return slots_[RingSlot(step)].bytes; }

  /// Highest step stored, -1 if none.
  std::int64_t newest() const { return newest_; }

 private:
  struct Slot {
    std::int64_t step = -1;
    std::vector<std::uint8_t> bytes;
  };
  std::array<Slot, kRingSteps> slots_;
  std::int64_t newest_ = -1;
};

}  // namespace fogline::runtime
