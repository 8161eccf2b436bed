// The cars behind the host.
#pragma once

#include <variant>
#include <vector>

#include "fogline/follower_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/follower/acc_driver.h"
#include "services/follower/person.h"

namespace fogline::follower {

/// The driver of a following car.
using CarDriver = std::variant<AccDriver, Person>;

/// The algorithm of the role `follower`: it drives the following cars. The driver of each car is
/// the same ACC as in the host (acc_driver.h), or a person (person.h). Each driver receives the
/// truth: the gap to the car ahead, and the speeds and accelerations of both cars. The following
/// cars represent the traffic that a host endangers if the host slows down for no reason. The
/// following cars are not part of the host's automation.
class Follower {
 public:
  /// @throws InputError if the weights of scenario.follower make an ill-conditioned problem, or a
  ///     person's reaction time is more than 254 steps
  explicit Follower(const Scenario& scenario) { Restart(scenario); }

  /// Resets the object to the state of a new Follower(scenario). If the parameters of the ACCs are
  /// unchanged, Restart() is cheaper than a new object.
  /// @throws the exceptions of the constructor; Restart() must then succeed before the next Step()
  void Restart(const Scenario& scenario);

  /// One command for each following car in `truth`, nearest to the host first.
  const follower_command_t& Step(const truth_t& truth);

 private:
  std::vector<CarDriver> drivers_;
  follower_command_t out_{};
};

}  // namespace fogline::follower
