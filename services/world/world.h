// The road: it moves the three cars, keeps the time of the run and knows everything. What the cars
// do is not decided here: the preceding car follows its profile, the others their commands.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "fogline/arbitration_t.hpp"
#include "fogline/ego_t.hpp"
#include "fogline/follower_command_t.hpp"
#include "fogline/truth_t.hpp"
#include "scenario/scenario.h"
#include "services/world/fog_schedule.h"
#include "services/world/leader.h"
#include "services/world/motion.h"

namespace fogline {

/// The preceding car, the host and one following car in one lane, as point masses whose
/// acceleration is constant within a step (services/world/motion.h). Cars that have collided do
/// not push each other: unless the run ends there, they go on as commanded, through one another,
/// and the gap between them is negative.
class World {
 public:
  using Output = std::tuple<truth_t, ego_t>;

  /// @throw std::invalid_argument if the scenario's recorded leader has no speeds.
  explicit World(const Scenario& scenario);

  /// Step 0: the state that the scenario describes. Begins a new run.
  const Output& Start(std::int64_t run_id);

  /// Goes on behind a step that another instance gave out, as this one would have.
  void Resume(const truth_t& truth);

  /// With the commands of step k, step k + 1. The acceleration that truth and ego report is the
  /// command, or (v(k+1) - v(k)) / step_s of a car that came to rest within the step.
  /// @pre Start() was called; `host` and `followers` are those of the last step given out.
  /// @throw std::invalid_argument if a command is not finite, or not one per following car.
  const Output& Step(const arbitration_t& host, const follower_command_t& followers);

  /// The step given out last.
  const truth_t& truth() const { return std::get<truth_t>(output_); }

 private:
  struct Car {
    Motion motion;
    double command_mps2 = 0;  // in force during the step
    double applied_mps2 = 0;  // mean over the step that ended
  };
  // In the order of the lane, from the front. The car at index i follows the one at i - 1.
  enum : std::size_t { kPreceding, kHost, kFollower, kNumCars };

  double TimeOf(std::int64_t step) const;
  double GapOf(std::size_t car) const;
  void Command(const arbitration_t& host, const follower_command_t& followers);
  void Integrate();
  void RecordCollision(double begin_s, double duration_s);
  const Output& Publish();

  WorldSection world_;
  std::int64_t steps_;
  std::int64_t step_us_;
  double step_s_;
  Leader leader_;
  FogSchedule fog_;

  std::int64_t run_id_ = 0;
  std::int64_t step_ = 0;
  std::array<Car, kNumCars> cars_;
  std::int8_t collision_ = truth_t::COLLISION_NONE;
  double collision_time_s_ = 0;
  Output output_{};
};

}  // namespace fogline
