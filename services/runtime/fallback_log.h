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
  std::string does;    // "the human drives"
};

class FallbackLog {
 public:
  /// @param step_us simulated time of a step
  explicit FallbackLog(std::int64_t step_us) : step_us_(step_us) {}

  /// Takes the next STATUS of a role. @return the change since its last one, nullptr if there is
  /// none
  const Fallback* Add(const status_t& status);

  const std::vector<Fallback>& all() const { return all_; }

 private:
  struct Known {
    std::array<InputState, kNumChannels> inputs{};
    std::string does;
  };

  std::string Culprit(const status_t& status) const;

  std::int64_t step_us_;
  std::array<Known, kRoles.size()> roles_;
  std::vector<Fallback> all_;
};

}  // namespace fogline
