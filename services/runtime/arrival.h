// A message that has come, as all its readers on one bus share it.
#pragma once

#include <any>

#include "services/runtime/clock.h"
#include "services/runtime/refusals.h"

namespace fogline {

/// Bytes, and what they say: decoded and checked when the first reader asks, and once however many
/// do. One object serves all messages of a channel, so nothing is allocated after the first.
class Arrival {
 public:
  /// Another message has come; the bytes live as long as its readers are being called.
  void Renew(Bytes bytes, TimePoint time) {
    bytes_ = bytes;
    time_ = time;
    examined_ = false;
  }

  Bytes bytes() const { return bytes_; }
  /// When it was handled, give or take what the bus handles between two looks at the clock.
  TimePoint time() const { return time_; }
  /// For readers that want no more than the bytes.
  operator Bytes() const { return bytes_; }

  /// The message; nullptr if the bytes are not exactly one M, or a value is not finite.
  template <class M>
  const M* As() {
    const Reading<M>& reading = Read<M>();
    return reading.wrong == nullptr ? &reading.message : nullptr;
  }
  /// Why it is none; nullptr if it is one.
  template <class M>
  RefusalCounter Wrong() {
    return Read<M>().wrong;
  }

 private:
  template <class M>
  struct Reading {
    M message{};
    RefusalCounter wrong = nullptr;
  };

  template <class M>
  const Reading<M>& Read() {
    auto* reading = std::any_cast<Reading<M>>(&reading_);
    if (reading == nullptr) {
      reading = &reading_.emplace<Reading<M>>();
      examined_ = false;
    }
    if (!examined_) {
      reading->wrong = Examine(bytes_, reading->message);
      examined_ = true;
    }
    return *reading;
  }

  Bytes bytes_;
  TimePoint time_{};
  std::any reading_;       // a Reading<M>
  bool examined_ = false;  // it is of these bytes
};

}  // namespace fogline
