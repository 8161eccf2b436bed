// The keys of a terminal, from the bytes that the terminal sends.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fogline::watch {

enum class Key {
  kUp,
  kDown,
  kPageUp,
  kPageDown,
  kHome,
  kEnd,
  kNextTable,
  kOpen,
  kClose,
  kSort,
  kReverse,
  kQuit,
};

/// Finds the keys in the bytes of a terminal. The escape sequences are those of ECMA-48 that xterm,
/// the Linux console, screen and tmux send.
class KeyReader {
 public:
  void Take(std::string_view bytes) { bytes_ += bytes; }

  /// The next key. Skips bytes that are not a key of this program.
  /// @param complete whether no byte has come for a moment. If so, an ESC at the end of the bytes
  ///     is the key Escape; otherwise it may be the beginning of a sequence
  std::optional<Key> Next(bool complete);

 private:
  std::string bytes_;
};

}  // namespace fogline::watch
