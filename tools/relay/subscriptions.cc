#include "tools/relay/subscriptions.h"

#include <algorithm>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace fogline::relay {
namespace {

// Limit for the stored matching results of each client. A testbed has tens of channels. Without
// this limit, names that change all the time would fill the memory.
constexpr std::size_t kMaxKnown = 1000;
// Limit for the bytes of all expressions of a client: kMeanBytes for each allowed expression, and
// kSpareBytes for a few long expressions. Boost takes up to 320 bytes of memory for each byte of an
// expression.
constexpr std::size_t kMeanBytes = 32;
constexpr std::size_t kSpareBytes = 256;
// Budget of processor time for new channel names, in seconds. The budget is full at first. An empty
// budget is full again after ten seconds. Boost itself does not limit the time enough. It gives up
// a match that takes too many steps. But a match within this limit takes up to a fifth of a second,
// and a client may have many expressions.
constexpr double kBudgetS = 0.1;
constexpr double kRefillPerS = kBudgetS / 10;
// For each new channel name, this much processor time is free: it is not charged to the budget. To
// match a name with tens of simple expressions takes no longer. So new names do not use the budget
// of a client that has only a few simple expressions. The relay needs about the same time to
// receive a name.
constexpr double kFreeS = 50e-6;

double ProcessorTimeS() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Subscriptions::Subscriptions(std::size_t limit) : limit_(limit), budget_s_(kBudgetS) {}

std::string Subscriptions::Add(std::string_view pattern) {
  if (entries_.size() >= limit_) return fmt::format("more than {} subscriptions", limit_);
  const std::size_t most = kMeanBytes * limit_ + kSpareBytes;
  if (bytes_ + pattern.size() > most)
    return fmt::format("more than {} bytes of subscriptions", most);
  try {
    // This copy ends with a zero byte. Boost 1.81 needs the zero, because it reads one character
    // beyond the end of expressions such as "[".
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

bool Subscriptions::Match(std::string_view channel, TimePoint now) {
  if (const auto known = known_.find(channel); known != known_.end()) return known->second;
  const std::chrono::duration<double> passed = now - filled_;
  budget_s_ = std::min(kBudgetS, budget_s_ + kRefillPerS * std::max(0.0, passed.count()));
  filled_ = now;
  const bool match = Search(channel);
  if (known_.size() >= kMaxKnown) known_.clear();
  known_.emplace(channel, match);
  return match;
}

bool Subscriptions::Search(std::string_view channel) {
  const double begin = ProcessorTimeS();
  const double end = begin + kFreeS + budget_s_;
  const auto check = [this, end] {
    if (ProcessorTimeS() <= end) return;
    budget_s_ = 0;
    throw std::runtime_error("its expressions take too long");
  };
  const bool match = std::ranges::any_of(entries_, [&](const Entry& entry) {
    check();
    return boost::regex_match(channel.begin(), channel.end(), entry.expression);
  });
  check();
  budget_s_ -= std::max(0.0, ProcessorTimeS() - begin - kFreeS);
  return match;
}

}  // namespace fogline::relay
