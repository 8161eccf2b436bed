// The car behind the host.
#pragma once

#include "fogline/follower_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/scenario.h"
#include "services/acc/acc_controller.h"

namespace fogline {

/// Drives the following car with the same ACC as the host's, with parameters of its own and with
/// perfect sensors: it sees the true gap to the host. It stands for the traffic that a host which
/// slows down for no reason endangers, and is no part of the host's automation.
class Follower {
 public:
  /// @throws InputError if the weights of scenario.follower make no well-conditioned problem.
  explicit Follower(const Scenario& scenario);

  /// Begins anew, as Follower(scenario) would; cheaper where its parameters are the same.
  void Restart(const Scenario& scenario) {
    controller_.Restart(scenario.follower, scenario.step_s);
  }

  /// One command for the nearest following car; none if `truth` has no following car.
  const follower_command_t& Step(const truth_t& truth);

 private:
  AccController controller_;
  follower_command_t out_{};
};

}  // namespace fogline
