#include "tools/relay/subscriptions.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/core.h>

namespace fogline {
namespace {

// Answers kept for each client. A testbed has tens of channels; names that change all the time
// would fill the memory.
constexpr std::size_t kMaxKnown = 1000;

}  // namespace

std::string Subscriptions::Add(std::string_view pattern) {
  if (entries_.size() >= limit_) return fmt::format("more than {} subscriptions", limit_);
  try {
    // A string of its own, with a zero behind it: Boost 1.81 looks one character beyond the end of
    // "[" and the like.
    std::string text(pattern);
    boost::regex expression(text, boost::regex::perl);
    entries_.push_back({std::move(text), std::move(expression)});
  } catch (const std::exception&) {
    return "a subscription that is no regular expression";
  }
  known_.clear();
  return "";
}

void Subscriptions::Remove(std::string_view pattern) {
  const auto found = std::ranges::find(entries_, pattern, &Entry::pattern);
  if (found == entries_.end()) return;
  entries_.erase(found);
  known_.clear();
}

bool Subscriptions::Match(std::string_view channel) {
  if (const auto known = known_.find(channel); known != known_.end()) return known->second;
  const bool match = std::ranges::any_of(entries_, [channel](const Entry& entry) {
    return boost::regex_match(channel.begin(), channel.end(), entry.expression);
  });
  if (known_.size() >= kMaxKnown) known_.clear();
  known_.emplace(channel, match);
  return match;
}

}  // namespace fogline
