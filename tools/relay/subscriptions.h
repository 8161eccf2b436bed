// The channels that one client of the relay wants, as regular expressions.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <boost/regex.hpp>

#include "services/runtime/clock.h"

namespace fogline {

/// Expressions in Perl's syntax (as LCM's), each for whole channel names.
class Subscriptions {
 public:
  explicit Subscriptions(std::size_t limit);

  /// Adds one; the same may be there several times. Their number is limited, and their length
  /// together. @return "" or what is wrong with it
  std::string Add(std::string_view pattern);

  /// Takes one that was added away; others are ignored.
  void Remove(std::string_view pattern);

  /// Whether one of them is for this channel. What that costs beyond what a few simple expressions
  /// do goes off a budget of processor time, which fills again slowly (a token bucket): whoever
  /// publishes ever new names makes the slow expressions of others no slower for everybody.
  /// @throws std::runtime_error if the budget is spent
  bool Match(std::string_view channel, TimePoint now);

 private:
  bool Search(std::string_view channel);

  struct Entry {
    std::string pattern;
    boost::regex expression;
  };
  std::size_t limit_;
  std::size_t bytes_ = 0;  // of all expressions
  std::vector<Entry> entries_;
  std::map<std::string, bool, std::less<>> known_;  // answers; channels come again and again
  double budget_s_;                                 // processor time left
  TimePoint filled_{};
};

}  // namespace fogline
