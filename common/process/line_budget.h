// Rate limiter for lines on stderr. Without a limit, a program whose connections are refused again
// and again would fill a disk with messages.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/process/console.h"

namespace fogline {

class LineBudget {
 public:
  /// @param program name of the program; each line begins with this name
  explicit LineBudget(std::string program) : program_(std::move(program)) {}

  void Print(const std::string& line) {
    const TimePoint now = Clock::now();
    if (now - began_ > kPeriod) {
      began_ = now;
      if (unsaid_ > 0) Notice(fmt::format("{}: {} such lines not shown", program_, unsaid_));
      said_ = 0;
      unsaid_ = 0;
    }
    if (said_ < kLines) {
      ++said_;
      Notice(fmt::format("{}: {}", program_, line));
    } else {
      ++unsaid_;
    }
  }

 private:
  static constexpr Duration kPeriod = milliseconds(1000);
  static constexpr int kLines = 20;
  std::string program_;
  TimePoint began_{};
  int said_ = 0;
  std::int64_t unsaid_ = 0;
};

}  // namespace fogline
