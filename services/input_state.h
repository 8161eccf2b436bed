// The state of a role's input, in real time.
#pragma once

#include <cstdint>
#include <string_view>

namespace fogline {

enum class InputState : std::uint8_t {
  kAwaited,  // no message has come yet, and the first message is not overdue
  kOk,
  kStale,  // overdue: the last value is still used
  kLost,   // overdue for so long that the last value is not used
};

/// The name of a state, for texts that a person reads.
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

/// Whether an input in this state has a value that may be used.
constexpr bool Usable(InputState state) {
  return state == InputState::kOk || state == InputState::kStale;
}

/// An input that may be missing: the newest message that came in time, and the state of the input.
/// An algorithm that takes a Heard must also work without this input.
template <class M>
struct Heard {
  InputState state = InputState::kAwaited;
  // nullptr until the first message has come; never nullptr if the state is Usable().
  const M* newest = nullptr;
};

}  // namespace fogline
