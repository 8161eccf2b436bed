#include "tools/relay/subscriptions.h"

#include <algorithm>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace fogline {
namespace {

// Answers kept for each client. A testbed has tens of channels; names that change all the time
// would fill the memory.
constexpr std::size_t kMaxKnown = 1000;
// Bytes of expressions: so many for each that a client may have, and room for a few long ones.
// Boost takes up to 320 bytes of memory for one.
constexpr std::size_t kMeanBytes = 32;
constexpr std::size_t kSpareBytes = 256;
// Processor time that one channel may cost. An expression that Boost does not give up takes up to a
// fifth of a second, and a client may have many.
constexpr double kMatchLimitS = 0.1;

double ProcessorTimeS() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

std::string Subscriptions::Add(std::string_view pattern) {
  if (entries_.size() >= limit_) return fmt::format("more than {} subscriptions", limit_);
  const std::size_t most = kMeanBytes * limit_ + kSpareBytes;
  if (bytes_ + pattern.size() > most)
    return fmt::format("more than {} bytes of subscriptions", most);
  try {
    // A string of its own, with a zero behind it: Boost 1.81 looks one character beyond the end of
    // "[" and the like.
    std::string text(pattern);
    boost::regex expression(text, boost::regex::perl);
    entries_.push_back({std::move(text), std::move(expression)});
  } catch (const std::exception&) {
    return "a subscription that is no regular expression";
  }
  bytes_ += pattern.size();
  known_.clear();
  return "";
}

void Subscriptions::Remove(std::string_view pattern) {
  const auto found = std::ranges::find(entries_, pattern, &Entry::pattern);
  if (found == entries_.end()) return;
  bytes_ -= pattern.size();
  entries_.erase(found);
  known_.clear();
}

bool Subscriptions::Match(std::string_view channel) {
  if (const auto known = known_.find(channel); known != known_.end()) return known->second;
  const double end = ProcessorTimeS() + kMatchLimitS;
  const bool match = std::ranges::any_of(entries_, [&](const Entry& entry) {
    if (ProcessorTimeS() > end) throw std::runtime_error("its expressions take too long");
    return boost::regex_match(channel.begin(), channel.end(), entry.expression);
  });
  if (known_.size() >= kMaxKnown) known_.clear();
  known_.emplace(channel, match);
  return match;
}

}  // namespace fogline
