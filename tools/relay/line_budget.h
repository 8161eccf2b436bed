// Lines on stderr, but not more than a person can read: who connects only to be refused, again and
// again, must not fill a disk with what is said about it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include <fmt/core.h>

#include "services/runtime/clock.h"

namespace fogline {

class LineBudget {
 public:
  void Print(const std::string& line) {
    const TimePoint now = Clock::now();
    if (now - began_ > kPeriod) {
      began_ = now;
      if (unsaid_ > 0) fmt::print(stderr, "fogline-relay: {} such lines not shown\n", unsaid_);
      said_ = 0;
      unsaid_ = 0;
    }
    if (said_ < kLines) {
      ++said_;
      fmt::print(stderr, "fogline-relay: {}\n", line);
    } else {
      ++unsaid_;
    }
  }

 private:
  static constexpr Duration kPeriod = milliseconds(1000);
  static constexpr int kLines = 20;
  TimePoint began_{};
  int said_ = 0;
  std::int64_t unsaid_ = 0;
};

}  // namespace fogline
