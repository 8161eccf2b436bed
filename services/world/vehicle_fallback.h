// The fallback of the cars in real time if their commands are missing: a car follows its last
// command for a short time, and then stops. The world needs no other process for this fallback.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fogline/arbitration_t.hpp"
#include "fogline/follower_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/host_modes.h"
#include "services/input_state.h"
#include "services/models/minimal_risk/minimal_risk.h"

namespace fogline::world {

/// The fallback of one car. It depends on the state of the input that gives the commands of this
/// car:
///
///     input          | acceleration of the car
///     ---------------|---------------------------------------------------------
///     OK             | the command
///     AWAITED, STALE | the last command; before any command, the applied acceleration
///     LOST           | minimal risk manoeuvre, in which the car then stays
class CarFallback {
 public:
  CarFallback(const MinimalRiskSection& limits, double step_s) : minimal_risk_(limits, step_s) {}

  /// The acceleration for the step that begins now. Call Step() once per step.
  /// @param command_mps2 the newest command, if any has come
  /// @param speed_mps, applied_mps2 of the car at the beginning of the step
  double Step(InputState state, std::optional<double> command_mps2, double speed_mps,
              double applied_mps2);

  /// Begins the minimal risk manoeuvre, if it has not begun yet.
  void BeginMinimalRisk(double applied_mps2) { minimal_risk_.Begin(applied_mps2); }
  bool in_minimal_risk() const { return minimal_risk_.begun(); }

 private:
  models::MinimalRisk minimal_risk_;
  std::optional<double> last_mps2_;
};

/// The fallback of the host and of the following cars. The results are the inputs of World::Step().
/// Each following car has a separate fallback. So if the messages lack the acceleration of one car,
/// only this car stops.
///
/// If the arbitrator has commanded the host's minimal risk manoeuvre, the vehicle stays in the
/// manoeuvre. The vehicle follows the arbitrator's commands while they continue the manoeuvre. If
/// no further commands come, or if a command does not continue the manoeuvre, the vehicle carries
/// out the manoeuvre by itself. A manoeuvre that the arbitrator has commanded ends only if a driver
/// takes over (mode RECOVERING, or EMERGENCY_BRAKING with authority of the human). If the host's
/// last mode is locked (IsLocked()), no driver can end the manoeuvre.
class VehicleFallback {
 public:
  explicit VehicleFallback(const Scenario& scenario);

  /// Computes the commands for the step that begins with `now`; host() and followers() return them.
  /// Call Step() once per step.
  void Step(const truth_t& now, const Heard<arbitration_t>& host,
            const Heard<follower_command_t>& followers);

  /// Begins the host's minimal risk manoeuvre. Call ResumeHost() if the host was in this manoeuvre
  /// when an earlier process of the world ended.
  void ResumeHost(const truth_t& now) { host_.BeginMinimalRisk(now.host_acceleration_mps2); }
  /// Begins the minimal risk manoeuvre of all following cars. Call ResumeFollowers() if a following
  /// car was in this manoeuvre when an earlier process ended. All cars begin it, because this
  /// process does not know which cars were in the manoeuvre.
  void ResumeFollowers(const truth_t& now);

  /// The command that the host carries out. While the vehicle stops by itself, the mode is
  /// MINIMAL_RISK and both authorities are 0. Before the first command, the mode is AUTOMATION.
  const arbitration_t& host() const { return host_out_; }
  const follower_command_t& followers() const { return followers_out_; }

  /// Whether the host is in a manoeuvre that no command ends. The vehicle began this manoeuvre by
  /// itself, or the arbitrator has commanded it.
  bool host_in_minimal_risk() const {
    return host_.in_minimal_risk() || (commanded_ && IsLocked(host_out_.mode));
  }
  /// Whether the vehicle carries out the manoeuvre by itself. The process of the world reports this
  /// to the arbitrator.
  bool host_stops_by_itself() const { return host_.in_minimal_risk(); }
  /// Whether any of the following cars is in the manoeuvre.
  bool follower_in_minimal_risk() const;
  /// State of the followers' commands: the worst state of all following cars. A message without an
  /// acceleration for a car counts as missing for this car.
  InputState follower_state() const { return follower_state_; }

 private:
  struct FollowingCar {
    CarFallback fallback;
    std::int64_t empty_steps = 0;  // consecutive messages without an acceleration for this car
  };

  void StepHost(const truth_t& now, const Heard<arbitration_t>& host);
  void StepFollower(std::size_t car, const truth_t& now,
                    const Heard<follower_command_t>& followers);

  /// State of a command that is missing in the last `steps` messages. The limits for inputs
  /// (HealthSection) apply.
  InputState StateAfter(std::int64_t steps) const;

  HealthSection health_;
  CarFallback host_;
  std::vector<FollowingCar> followers_;
  InputState follower_state_ = InputState::kAwaited;
  bool commanded_ = false;  // whether the arbitrator has commanded the manoeuvre
  arbitration_t host_out_{};
  follower_command_t followers_out_{};
};

}  // namespace fogline::world
