// Collects the failures in a run in real time, and the reactions of its roles, from the STATUS of
// the roles. The texts of this class are shown during the run, or later from the log.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "services/graph.h"
#include "services/input_state.h"
#include "services/runtime/realtime/culprit.h"

namespace fogline::runtime {

/// A change in the run: a role reacts to its inputs in another way, an input is lost, or a lost
/// input comes again. (A stale input is reported only if the role reacts to it.)
struct Fallback {
  std::int64_t step = 0;  // the step that the run had reached at the change
  std::string role;
  std::string what;     // such as "TRACK, ACC_COMMAND lost: the human drives"
  std::string culprit;  // role that stopped publishing, "" if there is none
  double age_s = 0;     // age of the first lost input (if none is lost, of the first stale one)

  /// Returns a text such as "step 217: arbitrator: TRACK lost (culprit: fusion, last heard 0.25 s
  /// ago): the human drives".
  std::string Text() const;

  std::string inputs;  // such as "TRACK, ACC_COMMAND lost"
  std::string does;    // such as "the human drives"; safe to print
};

class FallbackLog {
 public:
  /// The largest number of changes that are stored. Further changes would be of little use to a
  /// reader, and must not fill the memory.
  static constexpr std::size_t kMaxKept = 1000;

  /// @param step_us simulated time of a step
  /// @param speed simulated seconds per second
  /// @param steps number of steps of the run; silence after the last step is not reported
  FallbackLog(std::int64_t step_us, double speed, std::int64_t steps);

  /// Evaluates the next STATUS of a role.
  /// @return the change since the last STATUS of this role, nullptr if nothing has changed; valid
  ///     until the next call
  const Fallback* Add(const status_t& status);

  /// The first changes, kMaxKept at most.
  const std::vector<Fallback>& all() const { return all_; }
  /// The number of changes that came after all() was full.
  std::int64_t left_out() const { return left_out_; }

 private:
  struct Known {
    std::array<InputState, kNumChannels> inputs{};  // a lost input stays LOST until it is OK again
    std::string does;
    // The lost inputs in the role's last STATUS, and the simulated time of this STATUS in us.
    ChannelSet lost;
    std::int64_t utime = 0;
  };

  std::string Culprit(const status_t& status) const;
  /// Whether the role has been silent for so long that its last STATUS does not count.
  bool IsSilent(const Known& known, std::int64_t utime) const;

  std::int64_t step_us_;
  std::int64_t steps_;
  double silent_us_;  // a role is silent after this simulated time without a STATUS
  std::array<Known, kRoles.size()> roles_;
  Fallback newest_;
  std::vector<Fallback> all_;
  std::int64_t left_out_ = 0;
};

}  // namespace fogline::runtime
