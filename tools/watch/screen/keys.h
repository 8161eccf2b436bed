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

/// Takes bytes as they come. The escape sequences are those of ECMA-48 as xterm, the Linux console,
/// screen and tmux send them.
class KeyReader {
 public:
  void Take(std::string_view bytes) { bytes_ += bytes; }

  /// The next key. Bytes that are no key of this program are left out.
  /// @param complete whether no byte has come for a moment; an ESC at the end then is the Escape
  /// key
  std::optional<Key> Next(bool complete);

 private:
  std::string bytes_;
};

}  // namespace fogline::watch
