// A progress bar on stderr for a person at a terminal. The bar appears when the work takes longer
// than two seconds.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/clock.h"

namespace fogline {

class Progress {
 public:
  /// @param what unit of the count, such as "step"; @param total full count
  /// @param shown false: no bar is ever drawn
  Progress(std::string what, std::int64_t total, bool shown = true);
  /// Erases the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Draws the bar, at most ten times a second. @param note text after the bar
  void Show(std::int64_t done, std::string_view note = "");
  /// Erases the bar, and prints a line on stderr in its place.
  void Say(std::string_view line);

 private:
  std::string what_;
  std::int64_t total_;
  bool terminal_;
  bool shown_ = false;
  TimePoint began_;
  TimePoint next_;
};

}  // namespace fogline
