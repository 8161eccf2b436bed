// The whole experiment in one process without transport of messages, for sweeps, calibration and
// tests. ClosedLoop calls the same Step functions as the processes, in the order of the graph
// table. The results equal those of the distributed run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/errors.h"
#include "scenario/sections/scenario.h"
#include "services/acc/acc.h"
#include "services/algorithm.h"
#include "services/arbitrator/arbitrator.h"
#include "services/driver/driver.h"
#include "services/follower/follower.h"
#include "services/fusion/fusion.h"
#include "services/lidar/lidar.h"
#include "services/metrics/sample.h"
#include "services/radar/radar.h"
#include "services/world/world.h"

namespace fogline::closed_loop {

/// The messages of one step; they belong to the algorithms and are valid until the next step.
struct StepView {
  const truth_t& truth;
  const ego_t& ego;
  const radar_t& radar;
  const lidar_t& lidar;
  const track_t& track;
  const accel_command_t& acc;
  const driver_command_t& driver;
  const arbitration_t& host;
  const follower_command_t& follower;

  /// Calls `visit(message)` for each message, in the order of the graph table.
  template <class Visit>
  void ForEachMessage(Visit&& visit) const {
    visit(truth);
    visit(ego);
    visit(radar);
    visit(lidar);
    visit(track);
    visit(acc);
    visit(driver);
    visit(host);
    visit(follower);
  }

  metrics::Sample ToSample() const {
    return metrics::MakeSample(truth, radar, lidar, track, acc, driver, host, follower);
  }
};

class ClosedLoop {
 public:
  /// @throws InputError if the weights of an ACC make an ill-conditioned problem.
  explicit ClosedLoop(const Scenario& scenario);

  /// Resets the object for another run. This run equals the run of a new ClosedLoop(scenario) bit
  /// by bit. Restart() is cheaper than a new object, because an ACC with an unchanged section keeps
  /// its precomputed gains.
  /// @throws as the constructor; Restart() must then succeed before the next Run()
  void Restart(const Scenario& scenario);

  /// Computes all steps, and calls `visit(const StepView&)` after each step. Call Run() once after
  /// construction, and once after each Restart().
  /// @throws InputError if a person drives
  template <class Visit>
  void Run(std::int64_t run_id, Visit&& visit) {
    if (person_) throw InputError(std::string(kPersonNeedsRealtime));
    static const arbitration_t kBeforeTheRun{};
    const arbitration_t* last = &kBeforeTheRun;
    const EndOfRun end(world_);
    const auto* made = &world_.Start(run_id);
    while (true) {
      const auto& [truth, ego] = *made;
      const radar_t& radar = radar_.Step(truth);
      const lidar_t& lidar = lidar_.Step(truth);
      PassOnDemandInput(on_demand_.fusion, fusion_, truth);
      const track_t& track = fusion_.Step(ego, radar, lidar);
      const accel_command_t& acc = acc_.Step(ego, track);
      PassOnDemandInput(on_demand_.driver, driver_, *last);
      const driver_command_t& driver = driver_.Step(truth);
      PassOnDemandInput(on_demand_.arbitrator, arbitrator_, truth);
      const arbitration_t& host = arbitrator_.Step(ego, radar, lidar, track, acc, driver);
      const follower_command_t& follower = follower_.Step(truth);
      visit(StepView{truth, ego, radar, lidar, track, acc, driver, host, follower});
      if (truth.last) return;
      made = &world_.Step(host, follower);
      last = &host;
    }
  }

 private:
  /// Ends the run of a world, even if a step throws.
  class EndOfRun {
   public:
    explicit EndOfRun(world::World& world) : world_(world) {}
    ~EndOfRun() { world_.End(); }
    EndOfRun(const EndOfRun&) = delete;
    EndOfRun& operator=(const EndOfRun&) = delete;

   private:
    world::World& world_;
  };

  /// Which roles use their inputs on demand in this scenario (services/algorithm.h).
  struct OnDemandRoles {
    explicit OnDemandRoles(const Scenario& scenario)
        : fusion(AlgorithmTraits<fusion::Fusion>::UsesOnDemandInput(scenario)),
          driver(AlgorithmTraits<driver::Driver>::UsesOnDemandInput(scenario)),
          arbitrator(AlgorithmTraits<arbitrator::Arbitrator>::UsesOnDemandInput(scenario)) {}
    bool fusion;
    bool driver;
    bool arbitrator;
  };

  template <class A, class M>
  static void PassOnDemandInput([[maybe_unused]] bool is_used, [[maybe_unused]] A& algorithm,
                                [[maybe_unused]] const M& message) {
    if constexpr (AlgorithmTraits<A>::kHasOnDemand) {
      if (is_used) algorithm.SetOnDemandInput(message);
    }
  }

  bool person_;  // whether the scenario has a person who drives
  OnDemandRoles on_demand_;
  world::World world_;
  radar::Radar radar_;
  lidar::Lidar lidar_;
  fusion::Fusion fusion_;
  acc::Acc acc_;
  driver::Driver driver_;
  arbitrator::Arbitrator arbitrator_;
  follower::Follower follower_;
};

/// Runs one scenario after another. Only one thread may use an object.
class ReusedLoop {
 public:
  /// One run; `visit` as in ClosedLoop::Run(). @throws as the constructor of ClosedLoop
  template <class Visit>
  void Run(const Scenario& scenario, Visit&& visit) {
    if (loop_) {
      loop_->Restart(scenario);
    } else {
      loop_.emplace(scenario);
    }
    loop_->Run(0, visit);
  }
  /// One run with `seed` in place of the scenario's seed.
  template <class Visit>
  void Run(const Scenario& scenario, std::int64_t seed, Visit&& visit) {
    scenario_ = scenario;
    scenario_.seed = seed;
    Run(scenario_, visit);
  }

 private:
  std::optional<ClosedLoop> loop_;
  Scenario scenario_;
};

}  // namespace fogline::closed_loop
