// The world moves the cars, counts the time of the run, and knows the complete true state. The
// preceding car follows its profile. The other cars follow their commands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "fogline/arbitration_t.hpp"
#include "fogline/ego_t.hpp"
#include "fogline/follower_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/models/traffic/traffic.h"
#include "services/models/vehicle/longitudinal_vehicle.h"
#include "services/models/vehicle/motion.h"
#include "services/world/fog_schedule.h"
#include "services/world/leader.h"
#include "services/world/leader_friction.h"

namespace fogline::world {

/// The preceding car, the host and the cars that follow it, in one lane. The preceding car has the
/// speed of its profile. If the profile brakes harder than friction allows, the car is faster than
/// its profile for some time (leader_friction.h). With profile sumo, the preceding car is the
/// nearest car ahead of the host among the cars that SUMO moves (services/models/traffic). So the
/// preceding car may be another car than in the previous step. Each other car is a point mass or a
/// vehicle. A point mass has exactly the commanded acceleration. A vehicle follows the command as
/// far as it can (services/models/vehicle). The acceleration of every car is constant within a step
/// (services/models/vehicle/motion.h). Cars that have collided do not push each other. If the run
/// does not end, these cars continue to follow their commands, and the gap between them is
/// negative.
class World {
 public:
  using Output = std::tuple<truth_t, ego_t>;

  /// @throw std::invalid_argument if the scenario's recorded leader has no speeds
  /// @throw InputError if the places of the scenario's hills do not increase, a step is too short
  ///     for the delays of a vehicle, the leader's profile states a braking that friction does not
  ///     allow, or the leader comes from SUMO and this machine has no SUMO
  explicit World(const Scenario& scenario);

  /// Whether the leader comes from SUMO. If it does, copies share the simulation of SUMO.
  static bool CopiesShareState(const Scenario& scenario) {
    return scenario.lead.profile == LeadProfile::kSumo;
  }

  /// Does the part of the next Start() that can take a long time: SUMO loads its network.
  /// @throw InputError if the leader comes from SUMO, and SUMO refuses its network or routes
  void Prepare();

  /// Step 0: the state that the scenario describes. Begins a new run.
  /// @throw InputError of Prepare(), if Prepare() was not called before
  const Output& Start(std::int64_t run_id);

  /// Continues after a step that another instance published. With point masses, this instance
  /// computes the same steps that the other instance would compute. TRUTH does not contain the
  /// state of a vehicle's engine and brakes, so a vehicle begins as if it had kept its acceleration
  /// for a long time.
  /// @throw std::invalid_argument if that instance had another number of cars;
  ///     std::runtime_error if the leader comes from SUMO, whose state is lost
  void Resume(const truth_t& truth);

  /// Computes step k + 1 from the commands of step k. The acceleration that truth and ego report is
  /// the command, or a vehicle's response to the command. For a car that came to rest within the
  /// step, the reported acceleration is (v(k+1) - v(k)) / step_s.
  /// @pre Start() or Resume() was called; `host` and `followers` are the commands of the last
  ///     published step
  /// @throw std::invalid_argument if a command is not finite, or if there are more or fewer
  ///     commands than following cars.
  const Output& Step(const arbitration_t& host, const follower_command_t& followers);

  /// Ends the run. A process can have only one simulation of SUMO, so another object can begin a
  /// run with SUMO only after End().
  void End();

  /// The last published step.
  const truth_t& truth() const { return std::get<truth_t>(output_); }

 private:
  struct Car {
    models::Motion motion;
    double begin_mps = 0;          // speed at the beginning of the step
    double acceleration_mps2 = 0;  // constant during the step, or until the car rests
    double applied_mps2 = 0;       // mean acceleration over the step that ended
  };
  // The cars in the order of the lane, from the front. The car at index i follows the car at index
  // i - 1.
  enum : std::size_t { kPreceding, kHost, kFirstFollower };

  double TimeOf(std::int64_t step) const;
  double GapOf(std::size_t car) const;
  std::size_t num_followers() const { return cars_.size() - kFirstFollower; }
  void MakeVehicles(const Scenario& scenario);
  void PlaceAll();
  // Puts a car on the road as if it had kept this acceleration for a long time.
  void Place(std::size_t car, const models::Motion& motion, double acceleration_mps2);
  void Command(const arbitration_t& host, const follower_command_t& followers);
  void Lead();
  void BeginTraffic();
  void FollowTraffic();
  void PlaceByTraffic();
  void Obey(std::size_t car, double command_mps2);
  void Integrate();
  void RecordCollision(double begin_s, double duration_s);
  const Output& Publish();

  WorldSection world_;
  std::int64_t steps_;
  std::int64_t step_us_;
  double step_s_;
  Leader leader_;
  LeaderFriction friction_;
  FogSchedule fog_;
  std::shared_ptr<models::Traffic>
      traffic_;  // nullptr if the leader has a profile; shared with copies
  std::vector<models::Motion> in_traffic_;  // the host and its followers at the end of the step
  std::optional<models::LeaderInTraffic> ahead_;  // at the end of the step; nullopt if none

  bool prepared_ = false;  // whether the cars have their places of step 0
  std::int64_t run_id_ = 0;
  std::int64_t step_ = 0;
  std::vector<Car> cars_;
  std::optional<double> profile_mps_;  // speed of the leader's profile at the end of the step;
                                       // nullopt if friction limits the braking
  std::vector<std::optional<models::LongitudinalVehicle>>
      vehicles_;  // vehicle of each car; nullopt for a point mass
  std::int8_t collision_ = truth_t::COLLISION_NONE;
  double collision_time_s_ = 0;
  Output output_{};
};

}  // namespace fogline::world
