#include "services/driver/driver.h"

#include <stdexcept>

#include "common/errors.h"
#include "common/text.h"
#include "services/host_modes.h"

namespace fogline::driver {
namespace {

models::Situation Truly(const truth_t& truth) {
  return {.speed_mps = truth.host_speed_mps,
          .acceleration_mps2 = truth.host_acceleration_mps2,
          .ahead = models::CarAhead{.gap_m = truth.host_gap_m,
                                    .speed_mps = truth.preceding_speed_mps,
                                    .acceleration_mps2 = truth.preceding_acceleration_mps2}};
}

/// @param awareness nullptr if the driver is always aware
models::HumanDriver MakeHuman(const Scenario& scenario, const models::Following& following,
                              const models::Awareness* awareness) {
  HumanParameters parameters = scenario.human.errors;
  if (awareness != nullptr) parameters.reaction_time_s = awareness->LongestReactionTime_s();
  try {
    return models::HumanDriver(parameters, following, Random(scenario.seed, Stream::kHumanErrors),
                               scenario.step_s);
  } catch (const std::invalid_argument& error) {
    throw InputError("/step_s: " + NumberText(scenario.step_s) +
                     " s is too short for the driver: " + error.what());
  }
}

}  // namespace

Driver::Driver(const Scenario& scenario)
    : following_(scenario.human.following, scenario.driver, scenario.human.coolness),
      errors_(scenario.human.errors),
      person_(scenario.person),
      pedals_(scenario.person),
      readiness_(scenario.driver.readiness),
      step_s_(scenario.step_s) {
  const HumanSection& human = scenario.human;
  out_.readiness = readiness_;
  out_.input_sequence = -1;
  if (person_.drives) {
    SetLiveInput(nullptr);
    return;
  }
  if (human.sight == Sight::kFog) sight_.emplace(human.fog_sight);
  if (human.loses_awareness) awareness_.emplace(human.awareness, scenario.driver.readiness);
  if (human.misjudges) {
    human_.emplace(MakeHuman(scenario, following_, awareness_ ? &*awareness_ : nullptr));
  }
}

// Sets the driver's task: to monitor in AUTOMATION and in the locked modes, to drive in all other
// modes. In most modes other than AUTOMATION, the driver drives or has been asked to drive. If the
// driver does not take over, the car begins a minimal risk manoeuvre, which the driver may still
// end. A collision warning and emergency braking also draw the driver's attention to the road. In
// the locked modes, the driver has no task, because the car stands until the end of the run, or is
// in a manoeuvre that no driver can end.
void Driver::SetOnDemandInput(const arbitration_t& host) {
  const bool monitors = host.mode == arbitration_t::AUTOMATION || IsLocked(host.mode);
  task_ = monitors ? models::DriverTask::kMonitors : models::DriverTask::kDrives;
}

void Driver::SetLiveInput(const driver_input_t* input) {
  static const driver_input_t kReleased{};
  if (input != nullptr && input->present == 0) input = nullptr;
  const driver_input_t& act = input != nullptr ? *input : kReleased;
  out_.acceleration_mps2 = pedals_.Acceleration(act.throttle, act.brake);
  out_.readiness = input != nullptr ? readiness_ : 0;
  out_.acknowledged = input != nullptr && Acknowledges(act) ? 1 : 0;
  out_.gives_back = (act.buttons & driver_input_t::GIVE_BACK) != 0 ? 1 : 0;
  out_.input_instance = act.instance;
  out_.input_sequence = input != nullptr ? act.sequence : -1;
}

bool Driver::Acknowledges(const driver_input_t& input) const {
  const bool button = (input.buttons & driver_input_t::TAKE_OVER) != 0;
  const bool pedal = pedals_.TakesOver(input.throttle, input.brake);
  return (button && person_.take_over_by != TakeOverBy::kPedal) ||
         (pedal && person_.take_over_by != TakeOverBy::kButton);
}

const driver_command_t& Driver::Step(const truth_t& truth) {
  if (person_.drives) {
    out_.header = truth.header;
    return out_;
  }
  if (awareness_) PassTime(truth.header.step);
  out_.header = truth.header;
  out_.acceleration_mps2 = Drive(truth);
  return out_;
}

void Driver::PassTime(std::int64_t step) {
  if (last_step_) {
    const auto steps = static_cast<double>(step - *last_step_);
    awareness_->Step(task_, steps * step_s_);
  }
  last_step_ = step;
  out_.readiness = awareness_->awareness();
}

double Driver::Drive(const truth_t& truth) {
  models::Situation seen = Truly(truth);
  if (sight_) seen = sight_->Perceive(seen, truth.fog_visibility_m);
  if (!human_) return following_.Acceleration(seen);
  if (!awareness_) return human_->Step(truth.header.step, seen);
  return human_->Step(
      truth.header.step, seen,
      {.reaction_time_s = awareness_->ReactionTime_s(),
       .gap_error = errors_.gap_error + awareness_->GapError(),
       .approach_error_ps = errors_.approach_error_ps + awareness_->ApproachError_ps()});
}

}  // namespace fogline::driver
