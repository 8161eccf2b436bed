#include "tools/web/seat/seat.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline::web {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint64_t kAnna = 3;
constexpr std::uint64_t kBert = 4;

/// A seat, and a clock that begins at 100 s.
class SeatTest : public testing::Test {
 protected:
  TimePoint At(double ms) const {
    return TimePoint(std::chrono::seconds(100)) +
           duration_cast<Duration>(std::chrono::duration<double, std::milli>(ms));
  }
  static SeatInput Brakes() {
    return {.age_ms = 5,
            .present = true,
            .brake = 0.5,
            .axes = {0.25},
            .buttons = driver_input_t::TAKE_OVER,
            .device_kind = driver_input_t::WHEEL,
            .device = "G29",
            .latency_ms = 17};
  }
  static void ExpectEmptySeat(const std::optional<driver_input_t>& message) {
    ASSERT_TRUE(message);
    EXPECT_FALSE(message->present);
    EXPECT_EQ(message->throttle, 0);
    EXPECT_EQ(message->brake, 0);
    EXPECT_EQ(message->buttons, 0);
    EXPECT_EQ(runtime::WrongIn(*message), nullptr);
  }

  Seat seat_{99};
};

TEST_F(SeatTest, AnInputBecomesAMessage) {
  seat_.Hear({.run_id = 7, .step = 12, .utime = 240'000});
  ASSERT_TRUE(seat_.Sit(kAnna, At(0)));
  const auto message = seat_.Take(kAnna, Brakes(), At(10)).message;
  ASSERT_TRUE(message);
  EXPECT_EQ(message->header.run_id, 7);
  EXPECT_EQ(message->header.step, 12);
  EXPECT_EQ(message->header.utime, 240'000);
  EXPECT_EQ(message->instance, 99);
  EXPECT_EQ(message->sequence, 0);
  EXPECT_EQ(message->time_us, 100'005'000);  // 5 ms before the frame came
  EXPECT_EQ(message->latency_us, 17'000);
  EXPECT_EQ(message->device_kind, driver_input_t::WHEEL);
  EXPECT_EQ(message->device, "G29");
  EXPECT_TRUE(message->present);
  EXPECT_EQ(message->brake, 0.5);
  EXPECT_EQ(message->num_axes, 1);
  EXPECT_THAT(message->axes, ElementsAre(0.25));
  EXPECT_EQ(message->buttons, driver_input_t::TAKE_OVER);
  EXPECT_EQ(runtime::WrongIn(*message), nullptr);
  EXPECT_EQ(seat_.Take(kAnna, Brakes(), At(20)).message->sequence, 1);
}

TEST_F(SeatTest, BeforeARunItHasNoStep) {
  const auto message = seat_.Look(At(0));
  ExpectEmptySeat(message);
  EXPECT_EQ(message->header.step, -1);
  EXPECT_EQ(message->latency_us, -1);
}

TEST_F(SeatTest, OnlyOneClientDrives) {
  EXPECT_TRUE(seat_.Sit(kAnna, At(0)));
  EXPECT_FALSE(seat_.Sit(kBert, At(0)));
  EXPECT_TRUE(seat_.Sit(kAnna, At(0)));
  EXPECT_FALSE(seat_.Take(kAnna, Brakes(), At(0)).sits);
  const Seat::Taken refused = seat_.Take(kBert, Brakes(), At(1));
  EXPECT_FALSE(refused.message);
  EXPECT_FALSE(refused.sits);
  EXPECT_THAT(refused.why, HasSubstr("another person"));
  EXPECT_FALSE(refused.too_many);
  EXPECT_FALSE(seat_.Leave(kBert, At(2)));
  EXPECT_TRUE(seat_.Take(kAnna, Brakes(), At(3)).message);
}

TEST_F(SeatTest, APageThatIsOnlyOpenDoesNotKeepTheSeat) {
  SeatInput away = Brakes();
  away.present = false;
  seat_.Sit(kAnna, At(0));
  seat_.Take(kAnna, away, At(1));
  // The input of a second page on which no person is present has no effect.
  const Seat::Taken nothing = seat_.Take(kBert, away, At(2));
  EXPECT_FALSE(nothing.message);
  EXPECT_EQ(nothing.why, "");
  EXPECT_TRUE(seat_.Has(kAnna));
  const Seat::Taken taken = seat_.Take(kBert, Brakes(), At(3));
  ASSERT_TRUE(taken.message);
  EXPECT_TRUE(taken.message->present);
  EXPECT_TRUE(taken.sits);
  EXPECT_EQ(taken.before, kAnna);
  // From now on the seat is Bert's, as long as Bert is there.
  EXPECT_THAT(seat_.Take(kAnna, Brakes(), At(4)).why, HasSubstr("another person"));
  seat_.Take(kBert, away, At(5));
  EXPECT_TRUE(seat_.Take(kAnna, Brakes(), At(6)).sits);
}

TEST_F(SeatTest, ARefusedInputDoesNotTakeTheSeat) {
  SeatInput away = Brakes();
  away.present = false;
  seat_.Sit(kAnna, At(0));
  const auto tries = static_cast<int>(2 * runtime::kMostInputsPerSecond);
  for (int i = 0; i < tries; ++i) seat_.Take(kAnna, away, At(1));
  const Seat::Taken refused = seat_.Take(kBert, Brakes(), At(1));
  EXPECT_THAT(refused.why, HasSubstr("inputs a second"));
  EXPECT_TRUE(refused.too_many);
  EXPECT_FALSE(refused.sits);
  EXPECT_TRUE(seat_.Has(kAnna));
  const Seat::Taken taken = seat_.Take(kBert, Brakes(), At(1001));
  EXPECT_TRUE(taken.sits);
  EXPECT_EQ(taken.before, kAnna);
}

TEST_F(SeatTest, ASilentPersonLosesTheSeatToOneWhoIsThere) {
  seat_.Sit(kAnna, At(0));
  seat_.Take(kAnna, Brakes(), At(1));
  EXPECT_FALSE(seat_.Take(kBert, Brakes(), At(300)).message);
  ExpectEmptySeat(seat_.Look(At(301)));
  EXPECT_TRUE(seat_.Take(kBert, Brakes(), At(302)).sits);
}

TEST_F(SeatTest, AFreeSeatNeedsNoNewConnection) {
  seat_.Sit(kAnna, At(0));
  seat_.Sit(kBert, At(0));
  seat_.Take(kAnna, Brakes(), At(1));
  seat_.Leave(kAnna, At(2));
  const Seat::Taken taken = seat_.Take(kBert, Brakes(), At(3));
  EXPECT_TRUE(taken.sits);
  EXPECT_FALSE(taken.before);
}

TEST_F(SeatTest, WhoLeavesReleasesThePedalsAtOnce) {
  seat_.Sit(kAnna, At(0));
  seat_.Take(kAnna, Brakes(), At(1));
  const auto message = seat_.Leave(kAnna, At(2));
  ExpectEmptySeat(message);
  EXPECT_EQ(message->latency_us, -1) << "the message before has the measurement";
  EXPECT_TRUE(seat_.Sit(kBert, At(3)));
  EXPECT_EQ(seat_.Take(kBert, Brakes(), At(4)).message->sequence, 2);
}

TEST_F(SeatTest, APageThatIsSilentFor300msDrivesNoMore) {
  seat_.Sit(kAnna, At(0));
  seat_.Take(kAnna, Brakes(), At(100));
  EXPECT_EQ(seat_.next_look(), At(400));
  EXPECT_FALSE(seat_.Look(At(399)));
  EXPECT_FALSE(seat_.lost());
  ExpectEmptySeat(seat_.Look(At(400)));
  EXPECT_TRUE(seat_.lost());
  // While the page stays silent, the seat reports every 50 ms that it is empty.
  EXPECT_EQ(seat_.next_look(), At(450));
  EXPECT_FALSE(seat_.Look(At(449)));
  ExpectEmptySeat(seat_.Look(At(450)));
  // The next input of the page counts.
  EXPECT_TRUE(seat_.Take(kAnna, Brakes(), At(460)).message->present);
  EXPECT_FALSE(seat_.lost());
  EXPECT_FALSE(seat_.Look(At(500)));
}

TEST_F(SeatTest, WhileNoClientHasTheSeatItSaysSoEvery50ms) {
  for (int i = 0; i < 5; ++i) {
    ExpectEmptySeat(seat_.Look(At(50 * i)));
    EXPECT_FALSE(seat_.Look(At(50 * i + 49)));
    EXPECT_EQ(seat_.next_look(), At(50 * (i + 1)));
  }
}

TEST_F(SeatTest, AClientThatSitsAndSaysNothingIsSilent) {
  seat_.Look(At(0));
  seat_.Sit(kAnna, At(10));
  EXPECT_FALSE(seat_.Look(At(300)));
  ExpectEmptySeat(seat_.Look(At(310)));
  EXPECT_TRUE(seat_.lost());
}

TEST_F(SeatTest, AnInputWithoutAPersonHasReleasedPedals) {
  seat_.Sit(kAnna, At(0));
  SeatInput away = Brakes();
  away.present = false;
  ExpectEmptySeat(seat_.Take(kAnna, away, At(1)).message);
  // The page is not silent: it reports that no person drives.
  EXPECT_FALSE(seat_.lost());
}

TEST_F(SeatTest, TakesAtMost250InputsASecond) {
  seat_.Sit(kAnna, At(0));
  int taken = 0;
  std::string why;
  for (int ms = 0; ms < 10'000; ++ms) {
    const Seat::Taken now = seat_.Take(kAnna, Brakes(), At(ms));
    taken += now.message ? 1 : 0;
    if (!now.message) why = now.why;
  }
  EXPECT_GE(taken, 2500);
  EXPECT_LE(taken, 2500 + static_cast<int>(runtime::kMostInputsAtOnce));
  EXPECT_THAT(why, HasSubstr("250 inputs a second"));
  // The limit does not apply to the message that says that the person has left.
  SeatInput away = Brakes();
  away.present = false;
  while (seat_.Take(kAnna, Brakes(), At(10'000)).message) continue;
  ExpectEmptySeat(seat_.Take(kAnna, away, At(10'000)).message);
}

}  // namespace
}  // namespace fogline::web
