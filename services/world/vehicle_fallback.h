// What the cars themselves do, in real time, when their commands stay away: the last one holds for
// a moment, then the car stops. No process but the world itself is needed for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fogline/arbitration_t.hpp"
#include "fogline/follower_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/scenario.h"
#include "services/minimal_risk/minimal_risk.h"
#include "services/minimal_risk/modes.h"
#include "services/runtime/input_state.h"

namespace fogline {

/// One car:
///
///     command        | carried out
///     ---------------|---------------------------------------------------------
///     OK             | the command
///     AWAITED, STALE | the last one; before the first, what is applied now
///     LOST           | minimal risk manoeuvre, whatever comes afterwards
class CarFallback {
 public:
  CarFallback(const MinimalRiskSection& limits, double step_s) : minimal_risk_(limits, step_s) {}

  /// The acceleration for the step that begins here. Once per step.
  /// @param command_mps2 the newest command, if any has come
  /// @param speed_mps, applied_mps2 of the car now
  double Step(InputState state, std::optional<double> command_mps2, double speed_mps,
              double applied_mps2);

  /// The manoeuvre begins, unless it has begun already.
  void BeginMinimalRisk(double applied_mps2) { minimal_risk_.Begin(applied_mps2); }
  bool in_minimal_risk() const { return minimal_risk_.begun(); }

 private:
  MinimalRisk minimal_risk_;
  std::optional<double> last_mps2_;
};

/// The host and the following cars. Their commands come out in the form that World::Step takes.
/// Each following car stops by itself: one whose acceleration a message leaves out does, and the
/// others go on.
///
/// Once the arbitrator has commanded the host's minimal risk manoeuvre the vehicle remembers it: it
/// goes on with that command as long as it comes, and by itself when it stays away or when another
/// arbitrator, which knows nothing of it, commands anything else. Only a driver who was asked and
/// has come (mode RECOVERING) ends it.
class VehicleFallback {
 public:
  explicit VehicleFallback(const Scenario& scenario);

  /// The commands for the step that begins with `now`. Once per step; see host() and followers().
  void Step(const truth_t& now, const Heard<arbitration_t>& host,
            const Heard<follower_command_t>& followers);

  /// A process before this one was in the manoeuvre: so is this one, from now on.
  void ResumeHost(const truth_t& now) { host_.BeginMinimalRisk(now.host_acceleration_mps2); }
  /// It is not known which of them: all following cars are.
  void ResumeFollowers(const truth_t& now);

  /// The host's command as it is carried out: while the vehicle stops by itself, or has no command
  /// yet, with the authorities and the mode that this means.
  const arbitration_t& host() const { return host_out_; }
  const follower_command_t& followers() const { return followers_out_; }

  /// The host is in a manoeuvre that nobody ends, by its own or by the arbitrator's command.
  bool host_in_minimal_risk() const {
    return host_.in_minimal_risk() || (commanded_ && IsLocked(host_out_.mode));
  }
  /// The vehicle itself does it: the arbitrator is to be told.
  bool host_stops_by_itself() const { return host_.in_minimal_risk(); }
  /// Any of the following cars is in the manoeuvre.
  bool follower_in_minimal_risk() const;
  /// How the followers' commands are, that of the car which is worst off; a message without one for
  /// it does not count.
  InputState follower_state() const { return follower_state_; }

 private:
  struct FollowingCar {
    CarFallback fallback;
    std::int64_t empty_steps = 0;  // messages without an acceleration for this car
  };

  void StepHost(const truth_t& now, const Heard<arbitration_t>& host);
  void StepFollower(std::size_t car, const truth_t& now,
                    const Heard<follower_command_t>& followers);

  /// How an input is whose last so many messages said nothing, by the limits of any other.
  InputState StateAfter(std::int64_t steps) const;

  HealthSection health_;
  CarFallback host_;
  std::vector<FollowingCar> followers_;
  InputState follower_state_ = InputState::kAwaited;
  bool commanded_ = false;  // by the arbitrator
  arbitration_t host_out_{};
  follower_command_t followers_out_{};
};

}  // namespace fogline
