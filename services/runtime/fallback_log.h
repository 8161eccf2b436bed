// What went wrong in a run in real time and what was done about it, from the STATUS of its roles:
// for a person at the run, and afterwards from the log.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "services/graph.h"
#include "services/runtime/culprit.h"
#include "services/runtime/input_state.h"

namespace fogline {

/// A change of what a role does about its inputs, or of an input that is lost or there again. (One
/// that is only stale is news if something is done about it.)
struct Fallback {
  std::int64_t step = 0;  // that was under way
  std::string role;
  std::string what;     // "TRACK, ACC_COMMAND lost: the human drives"
  std::string culprit;  // role that fell silent, "" if none is
  double age_s = 0;     // since the role heard of it last

  /// "step 217: arbitrator: TRACK lost (culprit: fusion, last heard 0.25 s ago): the human drives"
  std::string Text() const;

  std::string inputs;  // "TRACK, ACC_COMMAND lost"
  std::string does;    // "the human drives", as it may be printed
};

class FallbackLog {
 public:
  /// Changes that are kept: what follows adds little for a reader, and must not fill the memory.
  static constexpr std::size_t kMaxKept = 1000;

  /// @param step_us simulated time of a step
  /// @param speed simulated seconds per second
  /// @param steps of the run: that all is silent after its last one is no news
  FallbackLog(std::int64_t step_us, double speed, std::int64_t steps);

  /// Takes the next STATUS of a role. @return the change since its last one, nullptr if there is
  /// none; valid until the next call
  const Fallback* Add(const status_t& status);

  /// The first changes, kMaxKept at most.
  const std::vector<Fallback>& all() const { return all_; }
  /// How many changes came after these.
  std::int64_t left_out() const { return left_out_; }

 private:
  struct Known {
    std::array<InputState, kNumChannels> inputs{};  // LOST until it is OK again
    std::string does;
    // What its last STATUS says is lost, and how far the run was then.
    ChannelSet lost;
    std::int64_t utime = 0;
  };

  std::string Culprit(const status_t& status) const;
  /// The role has said nothing for so long that it does not count any more what it said.
  bool IsSilent(const Known& known, std::int64_t utime) const;

  std::int64_t step_us_;
  std::int64_t steps_;
  double silent_us_;  // simulated
  std::array<Known, kRoles.size()> roles_;
  Fallback newest_;
  std::vector<Fallback> all_;
  std::int64_t left_out_ = 0;
};

}  // namespace fogline
