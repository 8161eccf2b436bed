// A driver with errors of perception, a reaction time and anticipation. The driver uses one of the
// car-following models.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/random.h"
#include "scenario/sections/human.h"
#include "services/models/driver/following.h"
#include "services/models/driver/ornstein_uhlenbeck.h"
#include "services/models/driver/situation.h"

namespace fogline::models {

/// Properties of a driver that may change from step to step.
struct Attention {
  double reaction_time_s;    // T_r
  double gap_error;          // V_s
  double approach_error_ps;  // r_c
};

/// Human Driver Model (Treiber, Kesting & Helbing, Physica A 360:71, 2006) for one car ahead:
///
///     s_est   = s e^(V_s w_s)                  w_s, w_l: Ornstein-Uhlenbeck of variance 1
///     v_l,est = v_l - s r_c w_l
///
/// s is the gap, v the own speed, v_l the speed of the car ahead, and a the own acceleration. V_s
/// and r_c are the sizes of the errors (Attention). At the time t, the driver acts on the situation
/// at t - T_r, interpolated linearly between two steps. A driver who anticipates assumes that the
/// acceleration of the own car and the closing speed have been constant since t - T_r:
///
///     v'   = v + T_r a             s' = s_est - T_r (v - v_l,est)
///     v_l' = v' - (v - v_l,est)                    with all values at the time t - T_r
///
/// The equations come from other literature that quotes the paper. Only the abstract of the paper
/// itself was checked. If errors and reaction time are 0, the result equals the result of the
/// car-following model, bit by bit.
class HumanDriver {
 public:
  /// Longest reaction time in steps.
  static constexpr std::size_t kMaxReactionSteps = 254;

  /// @param human parameters; human.reaction_time_s is the longest possible reaction time of the
  /// driver
  /// @param random random numbers for the driver's errors; each driver has a separate stream
  /// @throw std::invalid_argument for a parameter out of its range or a reaction time that is too
  /// long.
  HumanDriver(const HumanParameters& human, const Following& model, const Random& random,
              double step_s);

  /// The acceleration in this step. Call Step() once per step, in the order of steps, because
  /// errors and memory continue from step to step. Until the reaction time T_r has passed since the
  /// first step, the driver acts on the situation of the first step.
  double Step(std::int64_t step, const Situation& seen);
  /// The acceleration of a driver whose attention changes. A reaction time above the constructor's
  /// reaction time is reduced to the constructor's reaction time.
  double Step(std::int64_t step, const Situation& seen, const Attention& attention);

 private:
  Situation Misjudged(std::int64_t step, const Situation& seen, const Attention& attention);
  // The situation that the driver saw `reaction_time_s` ago.
  Situation Remembered(double reaction_time_s) const;
  const Situation& SeenAgo(std::size_t steps) const;

  HumanParameters human_;
  Following model_;
  Random random_;
  OrnsteinUhlenbeck gap_error_;
  OrnsteinUhlenbeck approach_error_;
  double step_s_;
  std::array<Situation, kMaxReactionSteps + 2> seen_{};  // a ring buffer
  std::size_t last_ = 0;
  bool begun_ = false;
};

}  // namespace fogline::models
