// How an input of a role is, in real time.
#pragma once

#include <cstdint>
#include <string_view>

namespace fogline {

enum class InputState : std::uint8_t {
  kAwaited,  // has never come, and is not overdue yet
  kOk,
  kStale,  // overdue: the last value holds
  kLost,   // overdue for so long that somebody else must drive
};

/// As in STATUS and in messages to people.
constexpr std::string_view NameOf(InputState state) {
  switch (state) {
    case InputState::kAwaited:
      return "awaited";
    case InputState::kOk:
      return "ok";
    case InputState::kStale:
      return "stale";
    case InputState::kLost:
      return "lost";
  }
  return "";
}

/// There is a value that may be used.
constexpr bool Usable(InputState state) {
  return state == InputState::kOk || state == InputState::kStale;
}

/// An input as an algorithm gets it that has to do without: the newest message that came in time,
/// and how the input is.
template <class M>
struct Heard {
  InputState state = InputState::kAwaited;
  const M* newest = nullptr;  // nullptr while none has come; there is one if the state is usable
};

}  // namespace fogline
