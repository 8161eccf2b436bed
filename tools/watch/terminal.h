// A terminal that is redrawn in place: alternate screen, no echo, one key at a time. ANSI escape
// sequences (ECMA-48) that every terminal of today knows; nothing of a terminal's database.
#pragma once

#include <termios.h>

#include <optional>
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

  /// To be waited on for keys, -1 if there are none.
  int fd() const { return fd_; }
  /// The next key that was pressed, if any.
  std::optional<char> Key();

 private:
  int fd_ = -1;
  termios before_{};
};

}  // namespace fogline
