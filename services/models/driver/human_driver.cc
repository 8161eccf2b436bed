#include "services/models/driver/human_driver.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/whole_steps.h"

namespace fogline::models {
namespace {

const HumanParameters& Checked(const HumanParameters& human) {
  const bool valid = human.reaction_time_s >= 0.0 && human.gap_error >= 0.0 &&
                     human.approach_error_ps >= 0.0 && human.error_time_s > 0.0;
  if (!valid) throw std::invalid_argument("human driver: a parameter is out of its range");
  return human;
}

// A time as a number of whole steps, and the remaining part of a step.
struct Steps {
  double whole;
  double rest;
};
Steps StepsIn(double time_s, double step_s) {
  const double steps = time_s / step_s;
  const double whole = WholeSteps(time_s, step_s);
  return {whole, std::max(0.0, steps - whole)};
}

double Mix(double newer, double older, double share) { return newer + share * (older - newer); }

}  // namespace

HumanDriver::HumanDriver(const HumanParameters& human, const Following& model, const Random& random,
                         double step_s)
    : human_(Checked(human)),
      model_(model),
      random_(random),
      gap_error_(human.error_time_s, step_s),
      approach_error_(human.error_time_s, step_s),
      step_s_(step_s) {
  const Steps steps = StepsIn(human.reaction_time_s, step_s);
  if (steps.whole > static_cast<double>(kMaxReactionSteps)) {
    throw std::invalid_argument("human driver: the reaction time is longer than 254 steps");
  }
}

double HumanDriver::Step(std::int64_t step, const Situation& seen) {
  return Step(step, seen, {human_.reaction_time_s, human_.gap_error, human_.approach_error_ps});
}

double HumanDriver::Step(std::int64_t step, const Situation& seen, const Attention& attention) {
  const double reaction_time_s = std::min(attention.reaction_time_s, human_.reaction_time_s);
  const Situation now = Misjudged(step, seen, attention);
  if (!begun_) seen_.fill(now);
  begun_ = true;
  last_ = (last_ + 1) % seen_.size();
  seen_[last_] = now;
  Situation then = Remembered(reaction_time_s);
  if (human_.anticipates) {
    const double gained = reaction_time_s * then.acceleration_mps2;
    if (then.ahead) {
      then.ahead->gap_m -= reaction_time_s * (then.speed_mps - then.ahead->speed_mps);
      then.ahead->speed_mps += gained;
    }
    then.speed_mps += gained;
  }
  return model_.Acceleration(then);
}

Situation HumanDriver::Misjudged(std::int64_t step, const Situation& seen,
                                 const Attention& attention) {
  const auto [gap_normal, approach_normal] = random_.Normal2(step, 0);
  const double gap_error = attention.gap_error * gap_error_.Step(gap_normal);
  const double approach_error_ps =
      attention.approach_error_ps * approach_error_.Step(approach_normal);
  Situation misjudged = seen;
  if (misjudged.ahead) {
    CarAhead& ahead = *misjudged.ahead;
    ahead.speed_mps -= ahead.gap_m * approach_error_ps;
    ahead.gap_m *= std::exp(gap_error);
  }
  return misjudged;
}

Situation HumanDriver::Remembered(double reaction_time_s) const {
  const auto [whole, rest] = StepsIn(reaction_time_s, step_s_);
  const auto steps = static_cast<std::size_t>(whole);
  const Situation& newer = SeenAgo(steps);
  const Situation& older = SeenAgo(steps + 1);
  // If a car appeared or vanished between the two situations, the situation that is nearer to the
  // wanted time decides whether there is a car ahead.
  Situation then = rest < 0.5 ? newer : older;
  then.speed_mps = Mix(newer.speed_mps, older.speed_mps, rest);
  then.acceleration_mps2 = Mix(newer.acceleration_mps2, older.acceleration_mps2, rest);
  if (newer.ahead && older.ahead) {
    then.ahead = {Mix(newer.ahead->gap_m, older.ahead->gap_m, rest),
                  Mix(newer.ahead->speed_mps, older.ahead->speed_mps, rest),
                  Mix(newer.ahead->acceleration_mps2, older.ahead->acceleration_mps2, rest)};
  }
  return then;
}

const Situation& HumanDriver::SeenAgo(std::size_t steps) const {
  return seen_[(last_ + seen_.size() - steps) % seen_.size()];
}

}  // namespace fogline::models
