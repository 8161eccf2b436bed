// A message that has come. All readers of a message on one bus share the same object.
#pragma once

#include <any>

#include "common/clock.h"
#include "services/runtime/wire/refusals.h"

namespace fogline::runtime {

/// The bytes of a message and the decoded message. When the first reader asks for the message, this
/// class decodes and checks the bytes. All other readers get the same result. One object serves all
/// messages of a channel, so only the first message allocates memory.
class Arrival {
 public:
  /// Takes the next message. The bytes must stay valid while the readers of this message are
  /// called.
  void Renew(Bytes bytes, TimePoint time) {
    bytes_ = bytes;
    time_ = time;
    examined_ = false;
  }

  Bytes bytes() const { return bytes_; }
  /// The time at which the bus handled the message. The bus does not read its clock for every
  /// message, so the result may be the time of a slightly earlier message.
  TimePoint time() const { return time_; }
  /// The bytes, for handlers with a parameter of type Bytes.
  operator Bytes() const { return bytes_; }

  /// The message; nullptr if the bytes are not exactly one M, or a value is not finite.
  template <class M>
  const M* As() {
    const Reading<M>& reading = Read<M>();
    return reading.wrong == nullptr ? &reading.message : nullptr;
  }
  /// The counter in status_t for the kind of error in the bytes; nullptr if the bytes are a valid
  /// M.
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
  bool examined_ = false;  // whether reading_ belongs to bytes_
};

}  // namespace fogline::runtime
