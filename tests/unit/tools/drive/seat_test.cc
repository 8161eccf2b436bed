#include "tools/drive/seat.h"

#include <string>

#include <gtest/gtest.h>

#include "services/runtime/wire/driver_input.h"

namespace fogline {
namespace {

using drive::InputMaker;
using drive::PedalState;

class InputMakerTest : public testing::Test {
 protected:
  const driver_input_t& Make(const PedalState& state) { return maker_.Make(state, now_); }

  InputMaker maker_{5, 99, driver_input_t::EVDEV, "A wheel"};
  TimePoint now_ = TimePoint() + std::chrono::hours(1);
};

TEST_F(InputMakerTest, MakesSoundMessagesInOrder) {
  for (int i = 0; i < 3; ++i) {
    const driver_input_t& input = Make({.throttle = 0.5, .axes = {0.1, -1}});
    EXPECT_EQ(runtime::WrongIn(input), nullptr);
    EXPECT_EQ(input.sequence, i);
    EXPECT_EQ(input.instance, 99);
    EXPECT_EQ(input.header.run_id, 5);
    EXPECT_EQ(input.device, "A wheel");
    EXPECT_EQ(input.num_axes, 2);
  }
}

TEST_F(InputMakerTest, ReleasesPedalsAndButtonsWhenTheSeatIsEmpty) {
  const driver_input_t& input =
      Make({.present = false, .throttle = 1, .brake = 1, .axes = {}, .buttons = 3});
  EXPECT_FALSE(input.present);
  EXPECT_EQ(input.throttle, 0);
  EXPECT_EQ(input.brake, 0);
  EXPECT_EQ(input.buttons, 0);
}

TEST_F(InputMakerTest, NamesTheNewestTruthOfItsRun) {
  EXPECT_EQ(Make({}).header.step, -1);
  maker_.SawTruth({.run_id = 5, .step = 8, .utime = 160'000});
  maker_.SawTruth({.run_id = 5, .step = 7, .utime = 140'000});
  maker_.SawTruth({.run_id = 6, .step = 20, .utime = 400'000});
  EXPECT_EQ(Make({}).header.step, 8);
  EXPECT_EQ(Make({}).header.utime, 160'000);
}

TEST_F(InputMakerTest, IsDueAtAChangeAndBeforeItsSilenceIsTooLong) {
  EXPECT_TRUE(maker_.Due({}, now_)) << "the first";
  Make({});
  now_ += milliseconds(20);
  EXPECT_FALSE(maker_.Due({}, now_));
  EXPECT_TRUE(maker_.Due({.brake = 0.1, .axes = {}}, now_));
  now_ += InputMaker::kEvery - milliseconds(20);
  EXPECT_TRUE(maker_.Due({}, now_));
  EXPECT_LT(InputMaker::kEvery, runtime::kInputEvery);
}

TEST_F(InputMakerTest, IsNotDueMoreOftenThanASeatMaySend) {
  int sent = 0;
  for (int i = 0; i < 1000; ++i) {
    now_ += milliseconds(1);
    const PedalState state{.brake = i / 1000.0, .axes = {}};
    if (!maker_.Due(state, now_)) continue;
    Make(state);
    ++sent;
  }
  EXPECT_GT(sent, 150);
  EXPECT_LE(sent, runtime::kMostInputsPerSecond);
}

TEST_F(InputMakerTest, CutsLongNamesAtAWholeCharacterAndLongListsOfAxes) {
  const std::string long_name =
      std::string(63, 'x') + "\xc3\xa4";  // 65 bytes; the last two are one character
  InputMaker maker(5, 99, driver_input_t::EVDEV, long_name);
  const driver_input_t& input = maker.Make({.axes = std::vector<double>(40, 0.5)}, now_);
  EXPECT_EQ(input.device, std::string(63, 'x'));
  EXPECT_EQ(input.num_axes, runtime::kMostAxes);
  EXPECT_EQ(runtime::WrongIn(input), nullptr);
}

}  // namespace
}  // namespace fogline
