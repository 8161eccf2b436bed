// The messages that the log of a run in lockstep lacks. Such a log comes from a logger that joined
// late, or that lost some messages. A run in real time counts its missing messages in
// RealtimeFigures.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "services/graph.h"

namespace fogline::log {

/// Successive steps that lack the messages of the same channels.
struct Gap {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::bitset<kNumChannels> channels;

  /// "step 394 lacks RADAR", or "steps 394 to 396 lack RADAR, LIDAR".
  std::string Text() const;
};

struct LogGaps {
  /// At most this many gaps are stored, so that the memory is limited.
  static constexpr std::size_t kMostGaps = 1000;

  std::int64_t first = 0;  // the first step of which the log has a message
  std::int64_t steps = 0;  // number of steps from `first` on that lack a message
  std::array<std::int64_t, kNumChannels> messages{};  // missing messages of each channel
  std::vector<Gap> gaps;                              // the first gaps, at most kMostGaps
  std::int64_t left_out = 0;                          // number of later gaps

  /// Whether the log lacks its first steps, or a message of a later step.
  bool Any() const { return first > 0 || steps > 0; }
  std::int64_t Messages() const;
  /// Whether a step lacks the message of this channel (an index of kChannels). The first step of a
  /// log that begins late does not count if it lacks TRUTH: a logger usually begins in the middle
  /// of a step, and a step without TRUTH is in no measure.
  bool Lacks(std::size_t channel) const;
  /// Adds a step that lacks the messages of these channels. Steps come in order.
  void Add(std::int64_t step, const std::bitset<kNumChannels>& channels);
  /// A remark on all gaps, such as "2 messages of 2 steps are missing (RADAR 1, LIDAR 1), first:
  /// step 394 lacks RADAR"; "" if no message is missing. The text does not contain the steps before
  /// `first`.
  std::string Text() const;
};

/// For an event after a gap: ", in one of the steps 394 to 396"; "" if both steps are the same.
std::string InOneOfTheSteps(std::int64_t earliest, std::int64_t step);

/// The names of these channels, such as "RADAR, LIDAR".
std::string NamesOfChannels(const std::bitset<kNumChannels>& channels);

}  // namespace fogline::log
