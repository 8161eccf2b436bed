#include "tools/watch/senders/sender_sequence.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <random>
#include <set>

#include "tests/unit/tools/watch/now.h"

namespace fogline::watch {
namespace {

using Counts = SenderSequence::Counts;
using runtime::LcmPacket;

LcmPacket Short(std::uint32_t number) { return {.number = number}; }

LcmPacket Fragment(std::uint32_t number, std::uint16_t fragment, std::uint16_t fragments) {
  return {.number = number, .fragment = fragment, .fragments = fragments};
}

Counts After(std::initializer_list<LcmPacket> packets) {
  SenderSequence sequence;
  for (const LcmPacket& packet : packets) sequence.Add(packet, 0, kNow);
  return sequence.counts();
}

Counts AfterNumbers(std::initializer_list<std::uint32_t> numbers) {
  SenderSequence sequence;
  for (const std::uint32_t number : numbers) sequence.Add(Short(number), 0, kNow);
  return sequence.counts();
}

void AddRange(SenderSequence& sequence, std::uint32_t first, std::uint32_t count,
              std::int64_t dropped = 0, TimePoint now = kNow) {
  for (std::uint32_t i = 0; i < count; ++i) sequence.Add(Short(first + i), dropped, now);
}

TEST(SenderSequenceTest, LosesNothingOfACompleteSequenceWhereverItBegins) {
  SenderSequence sequence;
  AddRange(sequence, 300, 5000);
  EXPECT_EQ(sequence.counts(), Counts{.received = 5000});
}

TEST(SenderSequenceTest, CountsAGapAtOnce) {
  EXPECT_EQ(AfterNumbers({0, 1, 5, 6}), (Counts{.received = 4, .lost = 3}));
}

TEST(SenderSequenceTest, CountsALateMessageAsReceivedAndNotAsLost) {
  EXPECT_EQ(AfterNumbers({0, 3, 1, 2, 4}), (Counts{.received = 5, .late = 2}));
}

TEST(SenderSequenceTest, CountsEveryCopyOnceAndNoCopyAsLate) {
  EXPECT_EQ(AfterNumbers({0, 1, 1, 0, 2, 2}), (Counts{.received = 3, .duplicates = 3}));
}

TEST(SenderSequenceTest, CountsOnBeyondTheLargestNumber) {
  EXPECT_EQ(AfterNumbers({0xfffffffe, 0xffffffff, 0, 1}), Counts{.received = 4});
  EXPECT_EQ(AfterNumbers({0xfffffffe, 1, 2}), (Counts{.received = 3, .lost = 2}));
  EXPECT_EQ(AfterNumbers({0xffffffff, 1, 0}), (Counts{.received = 3, .late = 1}));
}

TEST(SenderSequenceTest, IgnoresMessagesFromBeforeTheFirstOne) {
  EXPECT_EQ(AfterNumbers({10, 9, 8, 11}), Counts{.received = 2});
}

TEST(SenderSequenceTest, CountsALongGapAsLostWhenTheNextNumberConfirmsIt) {
  SenderSequence sequence;
  AddRange(sequence, 0, 10);
  sequence.Add(Short(10'000), 0, kNow);
  EXPECT_EQ(sequence.counts(), Counts{.received = 10});
  sequence.Add(Short(10'001), 0, kNow);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 12, .lost = 9990}));
}

TEST(SenderSequenceTest, BelievesNoSingleNumberThatIsFarAway) {
  for (const std::uint32_t far : {10'000U, 0x40000000U, 0x80000000U, 0xf0000000U}) {
    SenderSequence sequence;
    AddRange(sequence, 0, 10);
    sequence.Add(Short(far), 0, kNow);
    AddRange(sequence, 10, 10);
    sequence.Add(Short(far + 1), 0, kNow);
    AddRange(sequence, 20, 10);
    EXPECT_EQ(sequence.counts(), (Counts{.received = 30, .stray = 2})) << far;
  }
}

TEST(SenderSequenceTest, LosesNothingWhenASenderBeginsAgain) {
  SenderSequence sequence;
  AddRange(sequence, 5000, 10);
  AddRange(sequence, 0, 10);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 20, .restarts = 1}));
  // The sender has begun again once, and has sent the numbers 0 to 9 since then. If these numbers
  // come a second time, they may be repeated messages. The sequence takes them for another
  // beginning only after kBeginsAgain without a newer number.
  AddRange(sequence, 0, 10, 0, kNow + SenderSequence::kBeginsAgain);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 30, .restarts = 2}));
}

TEST(SenderSequenceTest, TakesAJumpOverAMillionMessagesForABeginning) {
  SenderSequence sequence;
  AddRange(sequence, 0, 10);
  AddRange(sequence, 2'000'000, 10);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 20, .restarts = 1}));
}

TEST(SenderSequenceTest, TellsWhatThisProcessDroppedFromWhatTheNetworkLost) {
  SenderSequence sequence;
  AddRange(sequence, 0, 10, 0);
  sequence.Add(Short(13), 2, kNow);  // 3 missing, 2 dropped here
  EXPECT_EQ(sequence.counts(), (Counts{.received = 11, .lost = 1, .missed_here = 2}));
  sequence.Add(Short(15), 2, kNow);  // no further drop
  EXPECT_EQ(sequence.counts(), (Counts{.received = 12, .lost = 2, .missed_here = 2}));
  sequence.Add(Short(16), 7, kNow);  // the drops were packets of other senders
  sequence.Add(Short(18), 7, kNow);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 14, .lost = 3, .missed_here = 2}));
}

TEST(SenderSequenceTest, TakesALateMessageFromTheCountThatHadIt) {
  SenderSequence sequence;
  sequence.Add(Short(0), 0, kNow);
  sequence.Add(Short(3), 1, kNow);  // 1 counts as missed here, 2 as lost
  EXPECT_EQ(sequence.counts(), (Counts{.received = 2, .lost = 1, .missed_here = 1}));
  sequence.Add(Short(1), 1, kNow);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 3, .lost = 1, .late = 1}));
  sequence.Add(Short(2), 1, kNow);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 4, .late = 2}));
}

TEST(SenderSequenceTest, CountsALongMessageOnceWhenAllItsFragmentsAreThere) {
  EXPECT_EQ(After({Short(0), Fragment(1, 0, 3), Fragment(1, 1, 3)}), Counts{.received = 1});
  EXPECT_EQ(After({Short(0), Fragment(1, 0, 3), Fragment(1, 2, 3), Fragment(1, 1, 3), Short(2)}),
            Counts{.received = 3});
}

TEST(SenderSequenceTest, LosesALongMessageWithoutOneOfItsFragments) {
  EXPECT_EQ(After({Short(0), Fragment(1, 0, 3), Fragment(1, 2, 3), Short(2)}),
            (Counts{.received = 2, .lost = 1}));
  EXPECT_EQ(After({Short(0), Fragment(1, 1, 3), Fragment(1, 2, 3), Short(2)}),
            (Counts{.received = 2, .lost = 1}));
  EXPECT_EQ(After({Short(0), Fragment(1, 0, 2), Short(2), Fragment(1, 1, 2)}),
            (Counts{.received = 3, .late = 1}));
}

TEST(SenderSequenceTest, ExplainsALongMessageByAFragmentThatWasDroppedHere) {
  SenderSequence sequence;
  sequence.Add(Short(0), 0, kNow);
  sequence.Add(Fragment(1, 0, 3), 0, kNow);
  sequence.Add(Fragment(1, 2, 3), 1, kNow);
  sequence.Add(Short(2), 1, kNow);
  EXPECT_EQ(sequence.counts(), (Counts{.received = 2, .missed_here = 1}));
}

TEST(SenderSequenceTest, BeginsWithTheFirstMessageThatItCanHaveWhole) {
  EXPECT_EQ(After({Fragment(1, 1, 3), Fragment(1, 2, 3), Short(2), Short(3)}),
            Counts{.received = 2});
}

TEST(SenderSequenceTest, RefusesFragmentsThatDoNotAgree) {
  EXPECT_EQ(After({Short(0), Fragment(1, 0, 2), Fragment(1, 1, 3), Fragment(1, 1, 2)}),
            (Counts{.received = 2, .stray = 1}));
}

TEST(SenderSequenceTest, CountsARepeatedLongMessageOnce) {
  EXPECT_EQ(After({Fragment(1, 0, 2), Fragment(1, 1, 2), Fragment(1, 0, 2), Fragment(1, 1, 2)}),
            (Counts{.received = 1, .duplicates = 1}));
}

/// A network that loses, doubles and delays messages a little. The expected counts come from a set
/// of all numbers that arrived.
TEST(SenderSequenceTest, AgreesWithASimplerCountOverRandomNetworks) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    constexpr std::uint32_t kBegin = std::numeric_limits<std::uint32_t>::max() - 1000;
    std::vector<std::uint32_t> arrivals{kBegin};
    for (std::uint32_t i = 1; i < 3000; ++i) {
      if (random() % 10 == 0) continue;
      const std::size_t back = random() % 5 == 0 ? random() % 20 : 0;
      const auto copies = random() % 20 == 0 ? 2 : 1;
      for (int copy = 0; copy < copies; ++copy) {
        const std::size_t at =
            std::max<std::size_t>(1, arrivals.size() - std::min(back, arrivals.size()));
        arrivals.insert(arrivals.begin() + static_cast<std::ptrdiff_t>(at), kBegin + i);
      }
    }
    SenderSequence sequence;
    std::set<std::uint32_t> seen;  // numbers since kBegin
    for (const std::uint32_t number : arrivals) {
      sequence.Add(Short(number), 0, kNow);
      seen.insert(number - kBegin);
    }
    const auto received = static_cast<std::int64_t>(seen.size());
    const Counts& counts = sequence.counts();
    EXPECT_EQ(counts.received, received) << seed;
    EXPECT_EQ(counts.lost, std::int64_t{*seen.rbegin()} + 1 - received) << seed;
    EXPECT_EQ(counts.duplicates, static_cast<std::int64_t>(arrivals.size()) - received) << seed;
    EXPECT_EQ(counts.stray + counts.restarts + counts.missed_here, 0) << seed;
  }
}

}  // namespace
}  // namespace fogline::watch
