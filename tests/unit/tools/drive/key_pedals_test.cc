#include "tools/drive/key_pedals.h"

#include <optional>

#include <gtest/gtest.h>

namespace fogline {
namespace {

using drive::KeyPedals;
using drive::PedalKey;

class KeyPedalsTest : public testing::Test {
 protected:
  KeyPedalsTest() {
    PersonSection person;
    person.key_press_ps = 1;
    person.key_release_ps = 2;
    pedals_.emplace(person);
    pedals_->MoveTo(now_);
  }
  void Pass(Duration duration) {
    for (const TimePoint end = now_ + duration; now_ < end;) {
      now_ += milliseconds(10);
      pedals_->MoveTo(now_);
    }
  }
  void Type(PedalKey key) { pedals_->Character(key, now_); }

  std::optional<KeyPedals> pedals_;
  TimePoint now_ = TimePoint() + std::chrono::hours(1);
};

TEST_F(KeyPedalsTest, MovesWhileAKeyIsDownAndBackWhenItIsUp) {
  pedals_->Hold(PedalKey::kThrottle, true, now_);
  Pass(milliseconds(500));
  EXPECT_NEAR(pedals_->throttle(), 0.5, 0.011);
  Pass(milliseconds(5000));
  EXPECT_EQ(pedals_->throttle(), 1);
  pedals_->Hold(PedalKey::kThrottle, false, now_);
  Pass(milliseconds(250));
  EXPECT_NEAR(pedals_->throttle(), 0.5, 0.021);
  Pass(milliseconds(1000));
  EXPECT_EQ(pedals_->throttle(), 0);
}

TEST_F(KeyPedalsTest, MovesALittleAtATapRestsAndGoesBack) {
  Type(PedalKey::kBrake);
  Pass(KeyPedals::kPress);
  const double tapped = pedals_->brake();
  EXPECT_NEAR(tapped, 0.12, 0.011);
  Pass(KeyPedals::kFirstDelay - KeyPedals::kPress - milliseconds(20));
  EXPECT_EQ(pedals_->brake(), tapped) << "it is not known whether the key is still down";
  Pass(milliseconds(200));
  EXPECT_EQ(pedals_->brake(), 0);
}

TEST_F(KeyPedalsTest, MovesOnWhileATerminalRepeatsAKey) {
  Type(PedalKey::kThrottle);
  Pass(milliseconds(660));  // X11's delay before the first repetition
  for (int i = 0; i < 25; ++i) {
    Type(PedalKey::kThrottle);
    Pass(milliseconds(40));
  }
  EXPECT_NEAR(pedals_->throttle(), 1, 0.03) << "0.12 s and 1 s";
  Pass(KeyPedals::kPress + milliseconds(600));
  EXPECT_EQ(pedals_->throttle(), 0) << "the repetitions have ended";
}

TEST_F(KeyPedalsTest, LeavesOnePedalForTheOther) {
  pedals_->Hold(PedalKey::kThrottle, true, now_);
  Pass(milliseconds(800));
  pedals_->Hold(PedalKey::kBrake, true, now_);
  Pass(milliseconds(500));
  EXPECT_EQ(pedals_->throttle(), 0);
  EXPECT_NEAR(pedals_->brake(), 0.5, 0.011);
}

TEST_F(KeyPedalsTest, DropsAHeldKeyAndItsPedal) {
  pedals_->Hold(PedalKey::kThrottle, true, now_);
  Pass(milliseconds(500));
  pedals_->Drop();
  EXPECT_EQ(pedals_->throttle(), 0);
  now_ += std::chrono::seconds(10);  // the device is unplugged, and nothing moves the pedals
  Pass(milliseconds(500));
  EXPECT_EQ(pedals_->throttle(), 0);
  // The device is unplugged for 10 s again. A key is pressed after these 10 s. It moves its pedal
  // only from this moment on.
  pedals_->Drop();
  now_ += std::chrono::seconds(10);
  pedals_->Hold(PedalKey::kBrake, true, now_);
  Pass(milliseconds(500));
  EXPECT_NEAR(pedals_->brake(), 0.5, 0.011);
}

}  // namespace
}  // namespace fogline
