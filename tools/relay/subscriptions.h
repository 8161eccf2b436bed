// The channels that one client of the relay wants, as regular expressions.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <boost/regex.hpp>

#include "common/clock.h"

namespace fogline::relay {

/// Expressions in Perl's syntax (as in LCM). An expression must match a whole channel name.
class Subscriptions {
 public:
  explicit Subscriptions(std::size_t limit);

  /// Adds an expression; the same expression may be added several times. The number and the total
  /// length of the expressions are limited. @return why the expression was not added; "" if it was
  /// added
  std::string Add(std::string_view pattern);

  /// Removes one copy of an expression; does nothing if it was not added.
  void Remove(std::string_view pattern);

  /// Whether one of the expressions matches this channel. The time to match a new name is charged
  /// to a budget of processor time, except for a short time for each name. A few simple expressions
  /// take no longer than this short time. The budget fills again slowly (a token bucket). The
  /// budget protects the relay: a client that publishes new names all the time could otherwise
  /// block the relay by the slow expressions of another client.
  /// @throws std::runtime_error if the budget is spent
  bool Match(std::string_view channel, TimePoint now);

 private:
  bool Search(std::string_view channel);

  struct Entry {
    std::string pattern;
    boost::regex expression;
  };
  std::size_t limit_;
  std::size_t bytes_ = 0;  // number of bytes of all expressions
  std::vector<Entry> entries_;
  std::map<std::string, bool, std::less<>> known_;  // matching results by channel
  double budget_s_;                                 // remaining processor time, seconds
  TimePoint filled_{};
};

}  // namespace fogline::relay
