// The cars behind the host.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "fogline/follower_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/scenario.h"
#include "services/follower/car_driver.h"

namespace fogline {

/// Drives the following cars, each behind the one before it: with the same ACC as the host's
/// (acc_driver.h) or as a person (person.h). They see the truth: the gap, and the speeds of both
/// cars. They stand for the traffic that a host which slows down for no reason endangers, and are
/// no part of the host's automation.
class Follower {
 public:
  /// @throws InputError if the weights of scenario.follower make no well-conditioned problem, or a
  ///     person's reaction time is too many steps
  explicit Follower(const Scenario& scenario) { Restart(scenario); }

  /// Begins anew, as Follower(scenario) would; cheaper where an ACC's parameters are the same.
  /// @throws as the constructor; Restart() must then succeed before the next Step()
  void Restart(const Scenario& scenario);

  /// One command for each following car, nearest to the host first; none where `truth` has none.
  const follower_command_t& Step(const truth_t& truth);

 private:
  std::vector<std::unique_ptr<CarDriver>> drivers_;
  follower_command_t out_{};
};

}  // namespace fogline
