#include "services/runtime/seat/seat_gate.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr Duration kDeadman = milliseconds(300);

class SeatGateTest : public testing::Test {
 protected:
  static driver_input_t Input(std::int64_t instance, std::int64_t sequence, bool present = true) {
    driver_input_t input{};
    input.header.step = -1;
    input.instance = instance;
    input.sequence = sequence;
    input.latency_us = -1;
    input.present = present ? 1 : 0;
    return input;
  }
  /// The sequence of the newest input; -1 if no person is there.
  std::int64_t Newest() const {
    const driver_input_t* input = gate_.Newest(now_);
    return input == nullptr ? -1 : input->sequence;
  }

  runtime::SeatGate gate_{kDeadman};
  TimePoint now_ = TimePoint() + std::chrono::hours(1);
};

TEST_F(SeatGateTest, IsEmptyBeforeTheFirstInput) { EXPECT_EQ(Newest(), -1); }

TEST_F(SeatGateTest, HasTheNewestInputOfItsSeat) {
  EXPECT_EQ(gate_.Take(Input(1, 0), now_), nullptr);
  EXPECT_EQ(gate_.Take(Input(1, 5), now_), nullptr);
  EXPECT_EQ(Newest(), 5);
  EXPECT_EQ(gate_.Take(Input(1, 4), now_), nullptr) << "an old one is late, not wrong";
  EXPECT_EQ(Newest(), 5);
}

// A process without the key of the run can only repeat messages. A repeated message of an earlier
// seat must not count as an input.
TEST_F(SeatGateTest, IgnoresARepetitionOfASeatThatHadTheDriverBefore) {
  gate_.Take(Input(1, 3), now_);
  gate_.Take(Input(1, 4, false), now_);
  gate_.Take(Input(2, 0), now_);
  gate_.Take(Input(2, 1, false), now_);
  EXPECT_EQ(gate_.Take(Input(1, 3), now_), nullptr);
  EXPECT_EQ(Newest(), -1);
  gate_.Take(Input(2, 2), now_);
  EXPECT_EQ(Newest(), 2);
}

TEST_F(SeatGateTest, IsEmptyAfterASilenceAsLongAsTheDeadman) {
  gate_.Take(Input(1, 0), now_);
  now_ += kDeadman - milliseconds(1);
  EXPECT_EQ(Newest(), 0);
  now_ += milliseconds(1);
  EXPECT_EQ(Newest(), -1);
  gate_.Take(Input(1, 1), now_);
  EXPECT_EQ(Newest(), 1) << "the seat is there again";
}

// A copy of an old message must not look like a sign of life.
TEST_F(SeatGateTest, IsNotKeptAwakeByRepetitions) {
  gate_.Take(Input(1, 3), now_);
  for (int i = 0; i < 30; ++i) {
    now_ += milliseconds(10);
    gate_.Take(Input(1, 3), now_);
  }
  EXPECT_EQ(Newest(), -1);
}

TEST_F(SeatGateTest, IsEmptyWhenTheSeatSaysSo) {
  gate_.Take(Input(1, 0), now_);
  EXPECT_EQ(gate_.Take(Input(1, 1, false), now_), nullptr);
  EXPECT_EQ(Newest(), -1);
}

TEST_F(SeatGateTest, RefusesASecondSeatWhileTheFirstHasTheDriver) {
  gate_.Take(Input(1, 0), now_);
  EXPECT_EQ(gate_.Take(Input(2, 9), now_), &status_t::second_seat);
  EXPECT_EQ(Newest(), 0);
  now_ += kDeadman;
  EXPECT_EQ(gate_.Take(Input(2, 10), now_), nullptr);
  EXPECT_EQ(Newest(), 10);
  EXPECT_EQ(gate_.Take(Input(1, 1), now_), &status_t::second_seat);
}

TEST_F(SeatGateTest, GivesTheDriverToAnotherSeatAtOnceWhenTheFirstIsEmpty) {
  gate_.Take(Input(1, 0), now_);
  gate_.Take(Input(1, 1, false), now_);
  EXPECT_EQ(gate_.Take(Input(2, 0, false), now_), nullptr) << "this seat is empty, too";
  EXPECT_EQ(Newest(), -1);
  EXPECT_EQ(gate_.Take(Input(2, 1), now_), nullptr);
  EXPECT_EQ(Newest(), 1);
}

TEST_F(SeatGateTest, RefusesEveryValueOutsideOfItsRange) {
  const auto refuses = [&](const char* what, auto change) {
    driver_input_t input = Input(1, 0);
    input.device = "a wheel";
    change(input);
    EXPECT_EQ(gate_.Take(input, now_), &status_t::out_of_range) << what;
  };
  refuses("throttle", [](driver_input_t& input) { input.throttle = 1.01; });
  refuses("throttle", [](driver_input_t& input) { input.throttle = -0.01; });
  refuses("brake", [](driver_input_t& input) { input.brake = 2; });
  refuses("brake",
          [](driver_input_t& input) { input.brake = std::numeric_limits<double>::quiet_NaN(); });
  refuses("instance", [](driver_input_t& input) { input.instance = 0; });
  refuses("sequence", [](driver_input_t& input) { input.sequence = -1; });
  refuses("step", [](driver_input_t& input) { input.header.step = -2; });
  refuses("latency", [](driver_input_t& input) { input.latency_us = -2; });
  refuses("device_kind", [](driver_input_t& input) { input.device_kind = 4; });
  refuses("device", [](driver_input_t& input) { input.device = std::string(65, 'x'); });
  refuses("buttons", [](driver_input_t& input) { input.buttons = 4; });
  refuses("axes", [](driver_input_t& input) {
    input.num_axes = 17;
    input.axes.assign(17, 0);
  });
  refuses("axes", [](driver_input_t& input) {
    input.num_axes = 1;
    input.axes = {1.5};
  });
  EXPECT_EQ(Newest(), -1);
}

TEST_F(SeatGateTest, RefusesWhatASeatSendsTooOften) {
  int taken = 0;
  for (int i = 0; i < 2000; ++i) {  // 2000 in a second
    now_ += std::chrono::microseconds(500);
    const auto refused = gate_.Take(Input(1, i), now_);
    taken += refused == nullptr ? 1 : 0;
    EXPECT_TRUE(refused == nullptr || refused == &status_t::too_frequent);
  }
  EXPECT_NEAR(taken, runtime::kMostInputsPerSecond + runtime::kMostInputsAtOnce, 2);
  EXPECT_NE(Newest(), -1) << "the seat still drives";
}

// The messages of another seat must not use up the number of messages that the driving seat may
// send.
TEST_F(SeatGateTest, DoesNotCountTheFloodOfASecondSeatForTheFirst) {
  gate_.Take(Input(1, 0), now_);
  for (int i = 0; i < 10'000; ++i) gate_.Take(Input(2, i), now_);
  EXPECT_EQ(gate_.Take(Input(1, 1), now_), nullptr);
  EXPECT_EQ(Newest(), 1);
}

}  // namespace
}  // namespace fogline
