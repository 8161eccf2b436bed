// A terminal that is redrawn in place: alternate screen, no echo, one key at a time. ANSI escape
// sequences (ECMA-48) that every terminal of today knows; nothing of a terminal's database.
#pragma once

#include <termios.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/watch/traffic_text.h"

namespace fogline {

class Terminal {
 public:
  /// Takes stdout, and stdin's keys if that is a terminal too.
  Terminal();
  /// Gives back the screen as it was.
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Replaces what is shown, as much of it as fits.
  void Draw(std::vector<Line> lines);

  /// Whether the terminal takes nothing more, such as when its window was closed.
  bool gone() const { return gone_; }

  /// To be waited on for keys, -1 if there are none.
  int fd() const { return has_keys_ ? fd_ : -1; }
  /// The next key that was pressed, if any.
  std::optional<char> Key();

 private:
  void Write(const std::string& text);

  int fd_ = -1;
  bool has_keys_ = false;
  bool gone_ = false;
  termios before_{};
};

}  // namespace fogline
