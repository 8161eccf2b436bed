// A driver who misjudges, is late and knows it: around any car-following model.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scenario/human.h"
#include "services/driver_models/following.h"
#include "services/driver_models/ornstein_uhlenbeck.h"
#include "services/driver_models/situation.h"
#include "services/runtime/random.h"

namespace fogline {

/// What of a driver may change from step to step.
struct Attention {
  double reaction_time_s;    // T_r
  double gap_error;          // V_s
  double approach_error_ps;  // r_c
};

/// Human Driver Model (Treiber, Kesting & Helbing, Physica A 360:71, 2006) for the one car ahead:
///
///     s_est   = s e^(V_s w_s)                  w_s, w_l: Ornstein-Uhlenbeck of variance 1
///     v_l,est = v_l - s r_c w_l
///
/// He acts on what he saw T_r ago, between two steps in proportion. If he anticipates, he takes his
/// own acceleration and the closing speed of then for constant since:
///
///     v'   = v + T_r a             s' = s_est - T_r (v - v_l,est)
///     v_l' = v' - (v - v_l,est)                    all of t - T_r
///
/// The equations are the paper's as they are generally given; of its text only the abstract was
/// checked. Without errors and reaction time this is the model within, bit by bit.
class HumanDriver {
 public:
  /// Longest reaction time in steps.
  static constexpr std::size_t kMaxReactionSteps = 254;

  /// @param human with the longest reaction time that he will have
  /// @param random whose errors they are: a stream of its own for each driver
  /// @throw std::invalid_argument for a parameter out of its range or a reaction time too long.
  HumanDriver(const HumanParameters& human, const Following& model, const Random& random,
              double step_s);

  /// What he does in this step. Once per step, in order: his errors and what he has seen go with
  /// him from step to step. Before T_r is over he goes by the first situation.
  double Step(std::int64_t step, const Situation& seen);
  /// The same for one who is not always the same.
  double Step(std::int64_t step, const Situation& seen, const Attention& attention);

 private:
  Situation Misjudged(std::int64_t step, const Situation& seen, const Attention& attention);
  // What was seen so long ago.
  Situation Remembered(double reaction_time_s) const;
  const Situation& SeenAgo(std::size_t steps) const;

  HumanParameters human_;
  Following model_;
  Random random_;
  OrnsteinUhlenbeck gap_error_;
  OrnsteinUhlenbeck approach_error_;
  double step_s_;
  std::array<Situation, kMaxReactionSteps + 2> seen_{};  // a ring
  std::size_t last_ = 0;
  bool begun_ = false;
};

}  // namespace fogline
