#include "tools/watch/senders/sender_sequence.h"

#include <algorithm>
#include <utility>

namespace fogline::watch {

void SenderSequence::Add(const runtime::LcmPacket& packet, std::int64_t dropped, TimePoint now) {
  if (!begun_) {
    // The observer may have begun in the middle of a message. So the sequence begins at the first
    // fragment of a message.
    if (!packet.First()) return;
    begun_ = true;
    dropped_ = dropped;
    return Begin(packet, now);
  }
  unexplained_ += dropped - dropped_;
  dropped_ = dropped;
  Take(packet, now);
}

/// The age of a number: the newest number minus this number. The age is negative for a number that
/// is newer than the newest one so far.
std::int64_t SenderSequence::AgeOf(std::uint32_t number) const {
  return -std::int64_t{static_cast<std::int32_t>(number - newest_)};
}

void SenderSequence::Begin(const runtime::LcmPacket& packet, TimePoint now) {
  newest_ = packet.number;
  length_ = 1;
  whole_.reset();
  missed_.reset();
  partial_.clear();
  doubtful_.reset();
  unexplained_ = 0;
  progressed_ = now;
  if (!Completes(packet)) return;
  whole_[0] = true;
  ++counts_.received;
}

void SenderSequence::Take(const runtime::LcmPacket& packet, TimePoint now) {
  const std::int64_t age = AgeOf(packet.number);
  if (age < -kMaxJump || age >= kWindow) return Doubt(packet, now);
  if (age >= 0 && IsKnown(age) && now - progressed_ >= kBeginsAgain) return Doubt(packet, now);
  if (doubtful_) {  // this packet is not the successor of the doubtful packet
    ++counts_.stray;
    doubtful_.reset();
  }
  if (age < 0) return Advance(packet, -age, now);
  TakeOlder(packet, age);
}

/// Whether a message of this age is already known. It is known if it has arrived completely, or if
/// it was sent before the first message that counts.
bool SenderSequence::IsKnown(std::int64_t age) const {
  return age >= length_ || whole_[static_cast<std::size_t>(age)];
}

void SenderSequence::Advance(const runtime::LcmPacket& packet, std::int64_t ahead, TimePoint now) {
  const bool incomplete = !whole_[0];
  const auto shift = static_cast<std::size_t>(std::min(ahead, kWindow));
  whole_ <<= shift;
  missed_ <<= shift;
  newest_ = packet.number;
  length_ += ahead;
  progressed_ = now;
  Miss(incomplete ? ahead : ahead - 1);
  std::erase_if(partial_, [this](const Partial& p) { return AgeOf(p.number) >= kWindow; });
  // unexplained_ counts packets that this process dropped before this packet. If this packet is the
  // first fragment of its message, the dropped packets belong to earlier messages. So they cannot
  // explain why a later message is missing. Otherwise one of them may be the first fragment of this
  // message, so they still count.
  if (packet.First()) unexplained_ = 0;
  if (!Completes(packet)) return;
  whole_[0] = true;
  ++counts_.received;
}

/// Counts the `count` messages before the newest message as missing. If this process has dropped
/// packets, the oldest of these messages count as missed_here, at most one for each dropped packet.
/// The other messages count as lost.
void SenderSequence::Miss(std::int64_t count) {
  const std::int64_t here = std::min(count, unexplained_);
  unexplained_ -= here;
  counts_.missed_here += here;
  counts_.lost += count - here;
  for (std::int64_t age = std::min(count, kWindow - 1); age > count - here; --age) {
    missed_[static_cast<std::size_t>(age)] = true;
  }
}

void SenderSequence::TakeOlder(const runtime::LcmPacket& packet, std::int64_t age) {
  if (IsKnown(age)) {
    if (age < length_ && packet.First()) ++counts_.duplicates;
    return;
  }
  const auto bit = static_cast<std::size_t>(age);
  if (!Completes(packet)) return;
  whole_[bit] = true;
  ++counts_.received;
  if (age == 0) return;
  ++counts_.late;
  --(missed_[bit] ? counts_.missed_here : counts_.lost);
  missed_[bit] = false;
}

void SenderSequence::Doubt(const runtime::LcmPacket& packet, TimePoint now) {
  const std::optional<runtime::LcmPacket> before = std::exchange(doubtful_, packet);
  doubtful_->channel = "";
  if (!before || before->number == packet.number) return;
  if (packet.number != before->number + 1) {
    ++counts_.stray;
    return;
  }
  doubtful_.reset();
  const std::int64_t age = AgeOf(before->number);
  if (age < 0 && -age <= kMaxLost) {
    Advance(*before, -age, now);
    return Take(packet, now);
  }
  ++counts_.restarts;
  if (!before->First()) return Begin(packet, now);  // the beginning of that message is missing
  Begin(*before, now);
  Take(packet, now);
}

bool SenderSequence::Completes(const runtime::LcmPacket& packet) {
  if (packet.Whole()) return true;
  auto partial = std::ranges::find(partial_, packet.number, &Partial::number);
  if (partial == partial_.end()) {
    if (partial_.size() == kMaxPartial) partial_.erase(partial_.begin());
    partial_.push_back(
        {.number = packet.number, .arrived = 0, .fragments = std::vector<bool>(packet.fragments)});
    partial = partial_.end() - 1;
  }
  if (partial->fragments.size() != packet.fragments) {
    ++counts_.stray;
    return false;
  }
  if (partial->fragments[packet.fragment]) {
    if (packet.First()) ++counts_.duplicates;
    return false;
  }
  partial->fragments[packet.fragment] = true;
  if (++partial->arrived < packet.fragments) return false;
  partial_.erase(partial);
  return true;
}

}  // namespace fogline::watch
