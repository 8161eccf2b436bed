#include "tools/drive/evdev_map.h"

#include <linux/input-event-codes.h>

#include <gtest/gtest.h>

#include "tests/support/input_errors.h"

namespace fogline {
namespace {

using drive::AxisRange;
using drive::PedalAxis;

TEST(PedalAxisTest, ReachesBothEndsWithinTheDeadZones) {
  const PedalAxis pedal{.code = ABS_GAS};
  const AxisRange range{.least = 0, .most = 1000};
  EXPECT_EQ(pedal.Travel(0, range), 0);
  EXPECT_EQ(pedal.Travel(29, range), 0);
  EXPECT_NEAR(pedal.Travel(500, range), 0.5, 1e-12);
  EXPECT_EQ(pedal.Travel(971, range), 1);
  EXPECT_EQ(pedal.Travel(1000, range), 1);
  EXPECT_EQ(pedal.Travel(4000, range), 1) << "a value beyond the stated range";
}

TEST(PedalAxisTest, TurnsAnInvertedAxis) {
  const PedalAxis pedal{.code = ABS_Z, .inverted = true};
  const AxisRange range{.least = -32768, .most = 32767};
  EXPECT_EQ(pedal.Travel(32767, range), 0);
  EXPECT_EQ(pedal.Travel(-32768, range), 1);
}

TEST(PedalAxisTest, IsReleasedWithoutARange) {
  EXPECT_EQ(PedalAxis{}.Travel(7, {.least = 0, .most = 0}), 0);
  EXPECT_EQ(drive::Scaled(7, {.least = 0, .most = 0}), 0);
}

TEST(ScaledTest, IsFromMinusOneToOne) {
  EXPECT_EQ(drive::Scaled(0, {.least = 0, .most = 255}), -1);
  EXPECT_EQ(drive::Scaled(255, {.least = 0, .most = 255}), 1);
  EXPECT_EQ(drive::Scaled(0, {.least = -100, .most = 100}), 0);
}

TEST(UsualMapTest, KnowsPedalsGamepadsWheelsAndKeyboards) {
  const auto pedals = drive::UsualMap({.gas_and_brake = true, .triggers = true});
  ASSERT_TRUE(pedals && pedals->throttle && pedals->brake);
  EXPECT_EQ(pedals->throttle->code, ABS_GAS);
  EXPECT_EQ(pedals->brake->code, ABS_BRAKE);
  const auto gamepad = drive::UsualMap({.triggers = true, .is_gamepad = true});
  ASSERT_TRUE(gamepad && gamepad->throttle && gamepad->brake);
  EXPECT_EQ(gamepad->throttle->code, ABS_RZ);
  EXPECT_FALSE(gamepad->throttle->inverted);
  EXPECT_EQ(gamepad->brake->code, ABS_Z);
  EXPECT_EQ(gamepad->take_over, BTN_SOUTH);
  const auto wheel = drive::UsualMap({.triggers = true});
  ASSERT_TRUE(wheel && wheel->throttle && wheel->brake);
  EXPECT_EQ(wheel->throttle->code, ABS_Z);
  EXPECT_TRUE(wheel->throttle->inverted);
  const auto keyboard = drive::UsualMap({.arrow_keys = true});
  ASSERT_TRUE(keyboard);
  EXPECT_FALSE(keyboard->throttle);
  EXPECT_EQ(keyboard->take_over, KEY_SPACE);
  EXPECT_FALSE(drive::UsualMap({}));
}

TEST(ParsePedalTest, ReadsANameAndItsDirection) {
  EXPECT_EQ(drive::ParsePedal("ABS_RZ", "--brake").code, ABS_RZ);
  EXPECT_FALSE(drive::ParsePedal("ABS_RZ", "--brake").inverted);
  EXPECT_TRUE(drive::ParsePedal("-ABS_RZ", "--brake").inverted);
  EXPECT_EQ(test::ErrorOf([] {
              drive::ParsePedal("RZ", "--brake");
            }).substr(0, std::string("error: --brake").size()),
            "error: --brake");
  EXPECT_EQ(drive::ParseButton("BTN_SOUTH", "--take-over"), BTN_SOUTH);
  EXPECT_NE(test::ErrorOf([] { drive::ParseButton("A", "--take-over"); }), "");
}

TEST(MapOfTest, UsesTheNamedAxesAndButtons) {
  const auto pedals = drive::MapOf({.gas_and_brake = true}, {.brake = "-ABS_RZ"});
  ASSERT_TRUE(pedals && pedals->throttle && pedals->brake);
  EXPECT_EQ(pedals->throttle->code, ABS_GAS);
  EXPECT_EQ(pedals->brake->code, ABS_RZ);
  EXPECT_TRUE(pedals->brake->inverted);
  const auto unknown = drive::MapOf({}, {.throttle = "ABS_X", .brake = "ABS_Y"});
  ASSERT_TRUE(unknown && unknown->throttle && unknown->brake);
  EXPECT_EQ(unknown->throttle->code, ABS_X);
  const auto keyboard = drive::MapOf({.arrow_keys = true}, {.give_back = "KEY_B"});
  ASSERT_TRUE(keyboard);
  EXPECT_EQ(keyboard->take_over, KEY_SPACE);
  EXPECT_EQ(keyboard->give_back, KEY_B);
  EXPECT_TRUE(test::ErrorOf([] {
                drive::MapOf({.arrow_keys = true}, {.brake = "NONE"});
              }).starts_with("error: --brake NONE: no axis"));
}

TEST(MapOfTest, IsNoneUnlessEachPedalHasAnAxisOfItsOwn) {
  EXPECT_FALSE(drive::MapOf({.gas_and_brake = true}, {.throttle = "ABS_BRAKE"}));
  EXPECT_FALSE(drive::MapOf({.arrow_keys = true}, {.throttle = "ABS_X"}));
  EXPECT_FALSE(drive::MapOf({.arrow_keys = true}, {.brake = "ABS_X"}));
  EXPECT_FALSE(drive::MapOf({}, {.brake = "ABS_X"}));
  EXPECT_FALSE(drive::MapOf({}, {}));
}

}  // namespace
}  // namespace fogline
