#include "services/runtime/transport/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/support/input_errors.h"

namespace fogline {
namespace {

using testing::HasSubstr;
using Message = std::vector<std::uint8_t>;

const TimePoint kNow = TimePoint{} + milliseconds(1'000'000);

/// A message of 100 bytes that contains a number.
Message Numbered(int number) {
  Message bytes(100, 0);
  bytes[0] = static_cast<std::uint8_t>(number >> 8);
  bytes[1] = static_cast<std::uint8_t>(number);
  return bytes;
}
int NumberOf(const Message& bytes) { return bytes[0] << 8 | bytes[1]; }

/// Sends `count` messages, one per millisecond. @return the messages that arrive until a second
/// after the last message was sent
std::vector<Message> Arrivals(runtime::Faults faults, int count) {
  std::vector<Message> arrived;
  const auto collect = [&](TimePoint now) {
    while (auto message = faults.Due(now)) arrived.push_back(std::move(message->bytes));
  };
  TimePoint now = kNow;
  for (int i = 0; i < count; ++i, now += milliseconds(1)) {
    faults.Take("TRUTH", Numbered(i), now);
    collect(now);
  }
  collect(now + milliseconds(1000));
  return arrived;
}

std::vector<int> Numbers(const std::vector<Message>& messages) {
  std::vector<int> numbers;
  for (const Message& message : messages) numbers.push_back(NumberOf(message));
  return numbers;
}

// With this number of messages, the share of messages with a fault is exact to one or two per cent.
constexpr int kMany = 10'000;
/// Five standard deviations of the number of messages with a fault of this probability.
double Tolerance(double chance) { return 5 * std::sqrt(kMany * chance * (1 - chance)); }

TEST(FaultsTest, ChangeNothingUnlessTheyAreAskedTo) {
  const std::vector<int> arrived = Numbers(Arrivals(runtime::Faults({}, Role::kAcc), 1000));
  ASSERT_EQ(arrived.size(), 1000U);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(arrived[static_cast<std::size_t>(i)], i);
}

TEST(FaultsTest, LoseAndDoubleAsManyAsTheyAreAskedTo) {
  const auto lossy = Arrivals(runtime::Faults({.loss = 0.3}, Role::kAcc), kMany);
  EXPECT_NEAR(static_cast<double>(lossy.size()), 0.7 * kMany, Tolerance(0.3));
  const auto doubled = Arrivals(runtime::Faults({.duplicate = 0.1}, Role::kAcc), kMany);
  EXPECT_NEAR(static_cast<double>(doubled.size()), 1.1 * kMany, Tolerance(0.1));
}

TEST(FaultsTest, LetLaterMessagesOvertake) {
  const std::vector<int> arrived =
      Numbers(Arrivals(runtime::Faults({.reorder = 0.1}, Role::kAcc), kMany));
  ASSERT_EQ(arrived.size(), static_cast<std::size_t>(kMany));
  int overtaken = 0;
  for (std::size_t i = 1; i < arrived.size(); ++i) overtaken += arrived[i] < arrived[i - 1] ? 1 : 0;
  // If two neighbouring messages are both delayed, the second does not overtake the first. So less
  // than a tenth of the messages are overtaken.
  EXPECT_GT(overtaken, 0.07 * kMany);
  EXPECT_LT(overtaken, 0.1 * kMany + Tolerance(0.1));
}

TEST(FaultsTest, DelayEveryMessageByTheSame) {
  runtime::Faults faults({.delay_ms = 5}, Role::kAcc);
  EXPECT_EQ(faults.NextDue(), TimePoint::max());
  faults.Take("TRUTH", Numbered(1), kNow);
  faults.Take("RADAR", Numbered(2), kNow + milliseconds(1));
  EXPECT_EQ(faults.NextDue(), kNow + milliseconds(5));
  EXPECT_FALSE(faults.Due(kNow + milliseconds(4)));
  EXPECT_EQ(faults.Due(kNow + milliseconds(5))->channel, "TRUTH");
  EXPECT_FALSE(faults.Due(kNow + milliseconds(5)));
  EXPECT_EQ(faults.Due(kNow + milliseconds(6))->channel, "RADAR");
}

TEST(FaultsTest, CutMessagesOff) {
  const auto arrived = Arrivals(runtime::Faults({.truncate = 0.2}, Role::kAcc), kMany);
  ASSERT_EQ(arrived.size(), static_cast<std::size_t>(kMany));
  int cut = 0;
  for (std::size_t i = 0; i < arrived.size(); ++i) {
    const Message whole = Numbered(static_cast<int>(i));
    ASSERT_LE(arrived[i].size(), whole.size());
    cut += arrived[i].size() < whole.size() ? 1 : 0;
    EXPECT_TRUE(std::equal(arrived[i].begin(), arrived[i].end(), whole.begin()));
  }
  EXPECT_NEAR(cut, 0.2 * kMany, Tolerance(0.2));
}

TEST(FaultsTest, FlipOneBit) {
  const auto arrived = Arrivals(runtime::Faults({.flip = 0.2}, Role::kAcc), kMany);
  ASSERT_EQ(arrived.size(), static_cast<std::size_t>(kMany));
  int flipped = 0;
  for (std::size_t i = 0; i < arrived.size(); ++i) {
    const Message whole = Numbered(static_cast<int>(i));
    int bits = 0;
    for (std::size_t k = 0; k < whole.size(); ++k) {
      bits += std::popcount(static_cast<unsigned>(whole[k] ^ arrived[i][k]));
    }
    EXPECT_LE(bits, 1);
    flipped += bits;
  }
  EXPECT_NEAR(flipped, 0.2 * kMany, Tolerance(0.2));
}

TEST(FaultsTest, AreTheSameForTheSameSeedAndRoleAndForNoOther) {
  const runtime::FaultRates rates{.loss = 0.3, .duplicate = 0.1, .reorder = 0.1, .flip = 0.1};
  runtime::FaultRates other_seed = rates;
  other_seed.seed = 2;
  const auto arrived = Arrivals(runtime::Faults(rates, Role::kAcc), 200);
  EXPECT_EQ(Arrivals(runtime::Faults(rates, Role::kAcc), 200), arrived);
  EXPECT_NE(Arrivals(runtime::Faults(rates, Role::kRadar), 200), arrived);
  EXPECT_NE(Arrivals(runtime::Faults(other_seed, Role::kAcc), 200), arrived);
}

TEST(FaultsTest, AreReadFromText) {
  const runtime::FaultRates rates = runtime::ParseFaults(
      "loss=0.3,duplicate=0.1,reorder=0.2,delay_ms=5,truncate=0.01,flip=0.02,seed=-7");
  EXPECT_EQ(rates.loss, 0.3);
  EXPECT_EQ(rates.duplicate, 0.1);
  EXPECT_EQ(rates.reorder, 0.2);
  EXPECT_EQ(rates.delay_ms, 5);
  EXPECT_EQ(rates.truncate, 0.01);
  EXPECT_EQ(rates.flip, 0.02);
  EXPECT_EQ(rates.seed, -7);
  EXPECT_TRUE(rates.Damage());
  EXPECT_FALSE(runtime::ParseFaults("loss=0.9").Damage());
}

TEST(FaultsTest, AreRefusedWithAReason) {
  const auto why = [](std::string_view text) {
    return test::ErrorOf([text] { runtime::ParseFaults(text); });
  };
  EXPECT_THAT(why("los=0.1"), HasSubstr("--faults: \"los\" is no kind of fault; any of loss="));
  EXPECT_THAT(why("loss"), HasSubstr("\"loss\" has no value"));
  EXPECT_THAT(why("loss=0.1,seed=1,loss=0.1"), HasSubstr("\"loss\" is given twice"));
  EXPECT_THAT(why("loss=0.1,,flip=0.1"), HasSubstr("\"\" has no value"));
  EXPECT_THAT(why("loss=a"), HasSubstr("loss=\"a\" is not a number"));
  EXPECT_THAT(why("loss="), HasSubstr("is not a number"));
  EXPECT_THAT(why("loss=0.1x"), HasSubstr("is not a number"));
  EXPECT_THAT(why("seed=0.5"), HasSubstr("is not a number"));
  for (const char* chance : {"loss=1", "loss=-0.1", "flip=nan", "reorder=inf"}) {
    EXPECT_THAT(why(chance), HasSubstr("is outside [0, 1)")) << chance;
  }
  EXPECT_THAT(why("delay_ms=1001"), HasSubstr("is outside [0, 1000] ms"));
}

}  // namespace
}  // namespace fogline
