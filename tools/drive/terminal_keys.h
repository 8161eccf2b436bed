// The keys of the terminal at standard input, as pedals and buttons.
#pragma once

#include <termios.h>

#include <string>

#include "tools/drive/key_pedals.h"
#include "tools/drive/pedal_source.h"

namespace fogline::drive {

enum class TerminalKey : std::uint8_t { kThrottle, kBrake, kTakeOver, kGiveBack };

/// Finds keys in the characters of a terminal: the arrow keys up and down, space and t (take over),
/// and g (give back). Each arrow key has two usual sequences, such as ESC [ A and ESC O A for up.
/// Other characters are ignored.
class KeyParser {
 public:
  /// Calls `use(TerminalKey)` for each key. A sequence may be split between two calls.
  template <class Use>
  void Parse(std::string_view characters, Use&& use) {
    for (const char c : characters) {
      if (state_ == State::kEscape) {
        state_ = c == '[' || c == 'O' ? State::kSequence
                 : c == '\x1b'        ? State::kEscape
                                      : State::kPlain;
        continue;
      }
      if (state_ == State::kSequence) {
        // A sequence ends with a letter or ~. Digits and ; may come before this character.
        if ((c >= '0' && c <= '9') || c == ';') continue;
        state_ = State::kPlain;
        if (c == 'A') use(TerminalKey::kThrottle);
        if (c == 'B') use(TerminalKey::kBrake);
        continue;
      }
      if (c == '\x1b') state_ = State::kEscape;
      if (c == ' ' || c == 't' || c == 'T') use(TerminalKey::kTakeOver);
      if (c == 'g' || c == 'G') use(TerminalKey::kGiveBack);
    }
  }

 private:
  enum class State : std::uint8_t { kPlain, kEscape, kSequence };
  State state_ = State::kPlain;
};

/// A terminal that gives each character immediately and does not show it. The destructor restores
/// the terminal. Ctrl-C and Ctrl-Z still send signals. So after Ctrl-C the program ends in its
/// usual way.
class RawTerminal {
 public:
  /// @throws InputError if standard input is not a terminal, or if the program is in the background
  RawTerminal();
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

 private:
  termios before_{};
};

class TerminalKeys final : public PedalSource {
 public:
  /// A button counts as down for this time after its character has come, because a terminal does
  /// not report that a key goes up. If a step of the run is not longer than this time, the button
  /// is down in the driver's newest input in at least one step.
  static constexpr Duration kButton = milliseconds(300);

  explicit TerminalKeys(const PersonSection& person) : pedals_(person) {}

  PedalState Read(TimePoint now) override;
  int fd() const override;
  std::int8_t kind() const override { return driver_input_t::KEYBOARD; }
  std::string name() const override { return "terminal"; }

 private:
  RawTerminal terminal_;
  KeyParser parser_;
  KeyPedals pedals_;
  TimePoint at_{};
  TimePoint take_over_until_{};
  TimePoint give_back_until_{};
  bool closed_ = false;  // the terminal was closed
};

}  // namespace fogline::drive
