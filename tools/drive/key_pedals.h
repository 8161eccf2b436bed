// Two keys as pedals. While a key is down, its pedal moves at a fixed rate. So a key can set every
// position of the pedal, not only released and full.
#pragma once

#include <algorithm>
#include <array>

#include "common/clock.h"
#include "scenario/sections/person.h"

namespace fogline::drive {

enum class PedalKey : std::uint8_t { kThrottle, kBrake };

/// Moves two pedals by keys. While its key is down, a pedal moves down at the rate key_press_ps
/// (shares of its travel per second). Otherwise it moves back at the rate key_release_ps. Only the
/// newest key counts, because a driver has one foot for both pedals.
///
/// A terminal reports only characters, and does not report that a key goes up. The first character
/// comes when the key goes down. Further characters come while the key stays down; the second one
/// comes after a longer delay. So this class treats each character as a key that is down for
/// kPress. The pedal moves back only when no further character can be expected: kFirstDelay after a
/// first character, and kPress after a later one. So a tap moves a pedal a little, and the pedal
/// rests there for a moment. When the person releases the key, the pedal does not move back at
/// once, but a little later.
class KeyPedals {
 public:
  /// After a character has come, its key counts as down for this time. Characters of a key that is
  /// down come every 33 to 40 ms (Linux console, X11: 25 to 30 in a second). The value is three
  /// times as long, so that delays of a terminal over a network do not interrupt a pedal.
  static constexpr Duration kPress = milliseconds(120);
  /// The pedal waits this long for the second character. The value is a little longer than the
  /// longest usual delay of the second character: X11's 660 ms (Linux console: 250 ms).
  static constexpr Duration kFirstDelay = milliseconds(700);

  explicit KeyPedals(const PersonSection& person)
      : press_ps_(person.key_press_ps), release_ps_(person.key_release_ps) {}

  /// Handles a character of this key.
  void Character(PedalKey key, TimePoint now) {
    Key& one = keys_[static_cast<std::size_t>(key)];
    const bool again = now < one.rests_until;
    one.pressed_until = now + kPress;
    one.rests_until = now + (again && one.seen ? kPress : kFirstDelay);
    one.seen = true;
    Key& other = keys_[1 - static_cast<std::size_t>(key)];
    other.pressed_until = other.rests_until = now;
  }

  /// Handles a key that goes down or up, on a device that reports both.
  void Hold(PedalKey key, bool down, TimePoint now) {
    Key& one = keys_[static_cast<std::size_t>(key)];
    one.pressed_until = one.rests_until = down ? TimePoint::max() : now;
    if (!down) return;
    Key& other = keys_[1 - static_cast<std::size_t>(key)];
    other.pressed_until = other.rests_until = now;
  }

  /// Releases both keys and both pedals at once, because the device is gone.
  void Drop() {
    keys_ = {};
    moved_ = {};
  }

  /// Moves the pedals up to this time. Call it at least every 20 ms.
  void MoveTo(TimePoint now) {
    const double passed_s = moved_ == TimePoint() ? 0 : std::max(0.0, Seconds(now - moved_));
    moved_ = now;
    for (Key& key : keys_) {
      if (now < key.pressed_until) {
        key.travel = std::min(1.0, key.travel + press_ps_ * passed_s);
      } else if (now >= key.rests_until) {
        key.travel = std::max(0.0, key.travel - release_ps_ * passed_s);
        key.seen = false;
      }
    }
  }

  double throttle() const { return keys_[0].travel; }
  double brake() const { return keys_[1].travel; }

 private:
  struct Key {
    TimePoint pressed_until{};
    TimePoint rests_until{};
    bool seen = false;  // whether a character has come since the pedal last moved back
    double travel = 0;
  };

  double press_ps_;
  double release_ps_;
  TimePoint moved_{};
  std::array<Key, 2> keys_;
};

}  // namespace fogline::drive
