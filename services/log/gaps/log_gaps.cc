#include "services/log/gaps/log_gaps.h"

#include <numeric>

#include <fmt/core.h>

namespace fogline::log {

std::string NamesOfChannels(const std::bitset<kNumChannels>& channels) {
  std::string names;
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (channels[i]) names += fmt::format("{}{}", names.empty() ? "" : ", ", kChannels[i].name);
  }
  return names;
}

std::string InOneOfTheSteps(std::int64_t earliest, std::int64_t step) {
  return earliest == step ? "" : fmt::format(", in one of the steps {} to {}", earliest, step);
}

std::string Gap::Text() const {
  const std::string names = NamesOfChannels(channels);
  if (first == last) return fmt::format("step {} lacks {}", first, names);
  return fmt::format("steps {} to {} lack {}", first, last, names);
}

std::int64_t LogGaps::Messages() const {
  return std::accumulate(messages.begin(), messages.end(), std::int64_t{0});
}

bool LogGaps::Lacks(std::size_t channel) const {
  const bool begins_in_step = first > 0 && !gaps.empty() && gaps.front().first == first &&
                              gaps.front().channels[IndexOf<truth_t>()];
  return messages[channel] > (begins_in_step && gaps.front().channels[channel] ? 1 : 0);
}

void LogGaps::Add(std::int64_t step, const std::bitset<kNumChannels>& channels) {
  ++steps;
  for (std::size_t i = 0; i < kNumChannels; ++i) messages[i] += channels[i] ? 1 : 0;
  const bool goes_on =
      !gaps.empty() && gaps.back().last == step - 1 && gaps.back().channels == channels;
  if (goes_on) {
    gaps.back().last = step;
  } else if (gaps.size() < kMostGaps) {
    gaps.push_back({.first = step, .last = step, .channels = channels});
  } else {
    ++left_out;
  }
}

std::string LogGaps::Text() const {
  if (steps == 0) return "";
  std::string counts;
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (messages[i] == 0) continue;
    counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", kChannels[i].name, messages[i]);
  }
  return fmt::format("{} of {} step{} {} missing ({}), first: {}",
                     Messages() == 1 ? "1 message" : fmt::format("{} messages", Messages()), steps,
                     steps == 1 ? "" : "s", Messages() == 1 ? "is" : "are", counts,
                     gaps.front().Text());
}

}  // namespace fogline::log
