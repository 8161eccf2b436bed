// A terminal that is redrawn in place: alternate screen, no echo, one key at a time. The class uses
// ANSI escape sequences (ECMA-48) that every current terminal knows, and no terminal database.
#pragma once

#include <termios.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/watch/screen/keys.h"
#include "tools/watch/traffic_text.h"

namespace fogline::watch {

class Terminal {
 public:
  /// Takes over stdout. If stdin is a terminal, also takes over the keys of stdin.
  Terminal();
  /// Restores the screen.
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Replaces the shown text.
  void Draw(const std::vector<Line>& lines);

  /// Whether output to the terminal fails, for example because its window was closed.
  bool gone() const { return gone_; }

  /// The size of the window; 80 by 24 if the terminal does not report a size.
  struct Size {
    std::size_t columns = 80;
    std::size_t rows = 24;
    bool operator==(const Size&) const = default;
  };
  static Size size();

  /// Descriptor to wait on for keys; -1 if no keys can come.
  int fd() const { return has_keys_ ? fd_ : -1; }
  /// The next key that was pressed, if any. Does not wait.
  std::optional<Key> NextKey();

 private:
  /// Reads the bytes that have come. @return whether there were any
  bool Read();
  void Write(const std::string& text);

  int fd_ = -1;
  bool has_keys_ = false;
  bool gone_ = false;
  KeyReader keys_;
  termios before_{};
};

}  // namespace fogline::watch
