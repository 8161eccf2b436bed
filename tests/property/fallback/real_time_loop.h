// A run in real time with all roles in one process. The clock of the run is a number that the loop
// increases. A test can make a role send nothing from a step on. A role that lacks an input also
// sends nothing; in a real run its process does the same. The arbitrator and the world continue
// with the inputs that they have.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "services/acc/acc.h"
#include "services/arbitrator/failsafe_arbitrator.h"
#include "services/driver/driver.h"
#include "services/follower/follower.h"
#include "services/fusion/fusion.h"
#include "services/lidar/lidar.h"
#include "services/radar/radar.h"
#include "services/runtime/realtime/input_health.h"
#include "services/world/vehicle_fallback.h"
#include "services/world/world.h"

namespace fogline::test {

// Tolerance for the rounding of accelerations (m/s2) and speeds (m/s) in one step.
inline constexpr double kRounding = 1e-9;

/// The receiving end of one channel: the newest message, and the state of the input.
template <class M>
class Line {
 public:
  Line(const HealthSection& section, Duration period) : health_(section, period, TimePoint()) {}

  void Send(const M& message, TimePoint now) {
    if (message.header.step > health_.newest()) newest_ = message;
    health_.Arrived(message.header.step, now);
  }
  Heard<M> At(TimePoint now) { return {health_.Update(now), newest_ ? &*newest_ : nullptr}; }
  /// Whether the message of this step may still come: it has not come, and the input is not LOST.
  bool Waits(std::int64_t step, TimePoint now) {
    return health_.Update(now) != InputState::kLost && health_.newest() < step;
  }

 private:
  runtime::InputHealth health_;
  std::optional<M> newest_;
};

/// The data of a step that a test may check: the truth, the offers, the arbitrator's command, and
/// the command that the vehicle carries out in this step. A pointer is nullptr if the role that
/// sends this message sends nothing in this step.
struct Moment {
  const truth_t& truth;
  const accel_command_t* automation;
  const driver_command_t* human;
  const arbitration_t* sent;
  const arbitration_t& carried_out;
  const arbitrator::FailsafeArbitrator& arbitrator;
  const world::VehicleFallback& vehicle;
};

class RealTimeLoop {
 public:
  explicit RealTimeLoop(const Scenario& scenario)
      : period_(duration_cast<Duration>(std::chrono::duration<double>(scenario.step_s))),
        deadline_(duration_cast<Duration>(scenario.health.deadline_share * period_)),
        world_(scenario),
        radar_(scenario),
        lidar_(scenario),
        fusion_(scenario),
        acc_(scenario),
        driver_(scenario),
        follower_(scenario),
        arbitrator_(scenario),
        vehicle_(scenario),
        radars_(scenario.health, period_),
        lidars_(scenario.health, period_),
        tracks_(scenario.health, period_),
        automation_(scenario.health, period_),
        drivers_(scenario.health, period_),
        hosts_(scenario.health, period_),
        followers_(scenario.health, period_) {
    silent_from_.fill(std::numeric_limits<std::int64_t>::max());
  }

  /// Makes the role send nothing from this step on.
  void Silence(Role role, std::int64_t step) {
    silent_from_[static_cast<std::size_t>(role)] = step;
  }

  /// Runs to the end and calls `visit(const Moment&)` for every step.
  template <class Visit>
  void Run(Visit&& visit) {
    const auto* output = &world_.Start(1);
    while (true) {
      const auto& [truth, ego] = *output;
      const std::int64_t step = truth.header.step;
      const TimePoint tick = TimePoint() + step * period_;
      const auto [automation, human] = Offers(truth, ego, tick + kTravel);
      const arbitration_t* sent = nullptr;
      if (Speaks(Role::kArbitrator, step)) sent = &Arbitrate(ego, tick + 2 * kTravel);
      vehicle_.Step(truth, hosts_.At(tick + period_), followers_.At(tick + period_));
      visit(Moment{truth, automation, human, sent, vehicle_.host(), arbitrator_, vehicle_});
      if (truth.last) break;
      output = &world_.Step(vehicle_.host(), vehicle_.followers());
    }
  }

 private:
  static constexpr Duration kTravel = milliseconds(1);

  bool Speaks(Role role, std::int64_t step) const {
    return step < silent_from_[static_cast<std::size_t>(role)];
  }

  std::pair<const accel_command_t*, const driver_command_t*> Offers(const truth_t& truth,
                                                                    const ego_t& ego,
                                                                    TimePoint now) {
    const accel_command_t* automation = nullptr;
    const driver_command_t* human = nullptr;
    const std::int64_t step = truth.header.step;
    const auto* radar = Speaks(Role::kRadar, step) ? &radar_.Step(truth) : nullptr;
    const auto* lidar = Speaks(Role::kLidar, step) ? &lidar_.Step(truth) : nullptr;
    if (radar != nullptr) radars_.Send(*radar, now);
    if (lidar != nullptr) lidars_.Send(*lidar, now);
    if (radar != nullptr && lidar != nullptr && Speaks(Role::kFusion, step)) {
      const track_t& track = fusion_.Step(ego, *radar, *lidar);
      tracks_.Send(track, now);
      if (Speaks(Role::kAcc, step)) automation = &acc_.Step(ego, track);
    }
    if (Speaks(Role::kDriver, step)) human = &driver_.Step(truth);
    if (automation != nullptr) automation_.Send(*automation, now);
    if (human != nullptr) drivers_.Send(*human, now);
    if (Speaks(Role::kFollower, step)) followers_.Send(follower_.Step(truth), now);
    return {automation, human};
  }

  // The arbitrator decides at the time `now` if each of its inputs has its message of this step or
  // is LOST. Otherwise it decides at the deadline.
  const arbitration_t& Arbitrate(const ego_t& ego, TimePoint now) {
    const std::int64_t step = ego.header.step;
    const bool waits = std::apply([&](auto&... line) { return (line.Waits(step, now) || ...); },
                                  std::tie(radars_, lidars_, tracks_, automation_, drivers_));
    const TimePoint at = waits ? now + deadline_ : now;
    const arbitration_t& command = arbitrator_.Step(ego.header, {{InputState::kOk, &ego},
                                                                 radars_.At(at),
                                                                 lidars_.At(at),
                                                                 tracks_.At(at),
                                                                 automation_.At(at),
                                                                 drivers_.At(at)});
    hosts_.Send(command, at);
    return command;
  }

  Duration period_;
  Duration deadline_;
  world::World world_;
  radar::Radar radar_;
  lidar::Lidar lidar_;
  fusion::Fusion fusion_;
  acc::Acc acc_;
  driver::Driver driver_;
  follower::Follower follower_;
  arbitrator::FailsafeArbitrator arbitrator_;
  world::VehicleFallback vehicle_;
  Line<radar_t> radars_;
  Line<lidar_t> lidars_;
  Line<track_t> tracks_;
  Line<accel_command_t> automation_;
  Line<driver_command_t> drivers_;
  Line<arbitration_t> hosts_;
  Line<follower_command_t> followers_;
  std::array<std::int64_t, kRoles.size()> silent_from_{};
};

}  // namespace fogline::test
