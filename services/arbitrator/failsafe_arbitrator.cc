#include "services/arbitrator/failsafe_arbitrator.h"

#include <algorithm>

#include "common/whole_steps.h"

namespace fogline::arbitrator {
namespace {

// Availability of the automation: the worst availability of five inputs. These inputs are the
// automation's command, the track from which the command is computed, radar, LiDAR, and the pairs
// of radar and LiDAR values of the same step. Without pairs there is no Degree of Conflict, so the
// arbitrator cannot judge the automation.
Offer AutomationOffer(const ArbitratorInputs& inputs, InputState pairs) {
  return std::max({OfferOf(inputs.radar.state), OfferOf(inputs.lidar.state), OfferOf(pairs),
                   OfferOf(inputs.track.state), OfferOf(inputs.automation.state)});
}

// The newest message; an empty message if no message has come.
template <class M>
const M& OrNone(const Heard<M>& input) {
  static const M kNone{};
  return input.newest != nullptr ? *input.newest : kNone;
}

// The newest message if it is usable, otherwise an empty message.
template <class M>
const M& UsableOrNone(const Heard<M>& input) {
  static const M kNone{};
  return Usable(input.state) ? *input.newest : kNone;
}

}  // namespace

FailsafeArbitrator::FailsafeArbitrator(const Scenario& scenario)
    : arbitrator_(scenario),
      pairs_(scenario.health),
      minimal_risk_(scenario.minimal_risk, scenario.step_s),
      person_(scenario.person.drives),
      person_due_step_(StepsUntil(scenario.person.deadman_s, scenario.step_s)) {
  out_.threshold = scenario.arbitrator.threshold;
}

const arbitration_t& FailsafeArbitrator::Step(const header_t& header,
                                              const ArbitratorInputs& inputs) {
  const std::int64_t known = pairs_.newest();
  const InputState pairs = pairs_.Update(header.step, inputs.radar.newest, inputs.lidar.newest);
  // A pair counts only once, even if it is the newest pair for several steps.
  if (pairs_.newest() > known) {
    arbitrator_.Observe(pairs_.radar(), pairs_.lidar(), OrNone(inputs.track));
  }
  if (pairs_.has_pair()) Regular(inputs, AutomationOffer(inputs, pairs));
  person_came_ = person_came_ || OrNone(inputs.driver).readiness > 0;
  decision_ = Judge(header.step, inputs, pairs);
  switch (decision_) {
    case Decision::kRegular:
      break;
    case Decision::kAutomation:
      if (arbitrator_.asks()) break;  // the regular command then needs no driver
      Drive(arbitration_t::AUTOMATION, inputs.automation.newest->acceleration_mps2);
      break;
    case Decision::kHuman:
      // HUMAN does not tell the vehicle that the driver has ended a manoeuvre.
      Drive(
          arbitrator_.recovers_from_manoeuvre() ? arbitration_t::RECOVERING : arbitration_t::HUMAN,
          inputs.driver.newest->acceleration_mps2);
      break;
    case Decision::kHold:
      Drive(last_mode_, last_mps2_.value_or(inputs.ego.newest->acceleration_mps2));
      break;
    case Decision::kMinimalRisk:
      Stop(*inputs.ego.newest);
      break;
  }
  out_.header = header;
  if (decision_ != Decision::kRegular) arbitrator_.Overrule(out_);
  last_mps2_ = out_.acceleration_mps2;
  last_mode_ = out_.mode;
  arbitrator_.Guard(*inputs.ego.newest, UsableOrNone(inputs.track), out_);
  return out_;
}

// Makes the regular decision, from the pairs of radar and LiDAR values so far. A missing
// acceleration counts as 0. If the command depends on a missing acceleration, Judge() chooses
// another decision, so this command is not sent. An exception is a manoeuvre of TakeOver: the
// manoeuvre uses 0 in place of the missing acceleration of the automation.
void FailsafeArbitrator::Regular(const ArbitratorInputs& inputs, Offer automation) {
  arbitrator_.SetAutomationThere(automation != kGone);
  out_ = arbitrator_.Choose(*inputs.ego.newest, OrNone(inputs.track),
                            UsableOrNone(inputs.automation), UsableOrNone(inputs.driver));
}

// Availability of the human. A person may be gone although the driver's process sends its messages:
// the seat is empty or silent. The readiness is then 0. At the start of the run, the first input of
// the person may still be missing, so the result is kNotYet until person_due_step_.
Offer FailsafeArbitrator::HumanOffer(std::int64_t step, const ArbitratorInputs& inputs) const {
  const Offer offer = OfferOf(inputs.driver.state);
  const bool absent = person_ && offer == kThere && inputs.driver.newest->readiness <= 0;
  if (!absent) return offer;
  return !person_came_ && step < person_due_step_ ? kNotYet : kGone;
}

Decision FailsafeArbitrator::Judge(std::int64_t step, const ArbitratorInputs& inputs,
                                   InputState pairs) const {
  if (minimal_risk_.begun()) return Decision::kMinimalRisk;
  if (arbitrator_.in_manoeuvre()) return Decision::kRegular;
  if (demanded_) return Decision::kMinimalRisk;
  const Offer automation = AutomationOffer(inputs, pairs);
  // A driver who must be asked drives only after taking over. If the automation has failed, there
  // is no time to ask. So a driver who has not taken over counts as gone.
  const bool unasked = automation != kThere && arbitrator_.must_ask();
  const Offer human = unasked ? kGone : HumanOffer(step, inputs);
  const bool disputed = pairs_.has_pair() && arbitrator_.wants_human();
  return Decide(automation, human, disputed ? kDisputed : kCalm);
}

void FailsafeArbitrator::Drive(std::int8_t mode, double acceleration_mps2) {
  out_.mode = mode;
  out_.lambda_human = HumanDrives(mode) ? 1 : 0;
  out_.lambda_automation = 1 - out_.lambda_human;
  out_.acceleration_mps2 = acceleration_mps2;
}

void FailsafeArbitrator::Stop(const ego_t& ego) {
  minimal_risk_.Begin(ego.acceleration_mps2);
  out_.mode = arbitration_t::MINIMAL_RISK;
  out_.lambda_automation = 0;
  out_.lambda_human = 0;
  out_.acceleration_mps2 = minimal_risk_.Step(ego.speed_mps);
}

}  // namespace fogline::arbitrator
