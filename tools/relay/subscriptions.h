// The channels that one client of the relay wants, as regular expressions.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <boost/regex.hpp>

namespace fogline {

/// Expressions in Perl's syntax (as LCM's), each for whole channel names.
class Subscriptions {
 public:
  explicit Subscriptions(std::size_t limit) : limit_(limit) {}

  /// Adds one; the same may be there several times. Their number is limited, and their length
  /// together. @return "" or what is wrong with it
  std::string Add(std::string_view pattern);

  /// Takes one that was added away; others are ignored.
  void Remove(std::string_view pattern);

  /// Whether one of them is for this channel.
  /// @throws std::runtime_error for expressions that take too long to say so
  bool Match(std::string_view channel);

 private:
  struct Entry {
    std::string pattern;
    boost::regex expression;
  };
  std::size_t limit_;
  std::size_t bytes_ = 0;  // of all expressions
  std::vector<Entry> entries_;
  std::map<std::string, bool, std::less<>> known_;  // answers; channels come again and again
};

}  // namespace fogline
