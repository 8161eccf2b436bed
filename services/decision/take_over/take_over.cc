#include "services/decision/take_over/take_over.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/whole_steps.h"
#include "services/models/driver/pedal_response.h"

namespace fogline::take_over {
namespace {

// Index of the random number that decides whether the driver is absent. TakeOverTime uses the draws
// from 0 to 99 of a step.
constexpr std::uint32_t kAbsenceDraw = 100;

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

MinimalRiskSection LimitsOf(const TakeOverSection& section) {
  return {.deceleration_mps2 = section.emergency_deceleration_mps2, .jerk_mps3 = section.jerk_mps3};
}

/// Returns a_P in m/s2, or nullopt if no person can override. A person overrides only if the
/// person's offer is at most a_P.
std::optional<double> OverrideOf(const PersonSection& person) {
  if (!person.drives || person.override_by == OverrideBy::kNone) return std::nullopt;
  const models::PedalResponse pedals(person);
  const double braking_mps2 = pedals.Acceleration(0, person.override_pedal);
  if (braking_mps2 < pedals.Acceleration(0, 0)) return braking_mps2;
  throw InputError(fmt::format(
      "/person/override_pedal: a brake at {} brakes no harder than the released pedals: "
      "/person/full_brake_mps2 is {}, and /person/coasting_mps2 is {}",
      person.override_pedal, person.full_brake_mps2, person.coasting_mps2));
}

/// Upper bound of the time until the car stands (services/models/minimal_risk/README.md).
double LongestTimeToRest_s(double speed_mps, double acceleration_mps2, double deceleration_mps2,
                           double jerk_mps3, double step_s) {
  const double push = std::max(acceleration_mps2, 0.0);
  return std::abs(acceleration_mps2 + deceleration_mps2) / jerk_mps3 +
         (speed_mps + push * push / (2 * jerk_mps3) + push * step_s) / deceleration_mps2 +
         deceleration_mps2 / jerk_mps3 + 3 * step_s;
}

}  // namespace

TakeOver::TakeOver(const Scenario& scenario)
    : section_(scenario.arbitrator.take_over),
      person_(scenario.person.drives),
      returns_(person_ && scenario.person.when_gone == WhenGone::kUntilBack),
      override_mps2_(OverrideOf(scenario.person)),
      step_s_(scenario.step_s),
      lead_steps_(StepsUntil(section_.lead_s, step_s_)),
      escalation_steps_(StepsUntil(section_.escalation_s, step_s_)),
      recovery_steps_(StepsUntil(section_.recovery_s, step_s_)),
      random_(scenario.seed, Stream::kTakeOver),
      time_(section_.time, section_.lead_s),
      manoeuvre_(LimitsOf(section_), step_s_),
      answer_step_(kNever) {
  if (section_.lead_s < kLeastLead_s) {
    throw std::invalid_argument("take-over: the lead time is below the 10 s of UN R157");
  }
  section_.comfort_deceleration_mps2 =
      std::min(section_.comfort_deceleration_mps2, section_.emergency_deceleration_mps2);
}

const TakeOverOutcome& TakeOver::Step(const header_t& header, const TakeOverInputs& inputs) {
  if (person_) HearAnswer(header.step, inputs);
  const TakeOverRow* row =
      TakeOverRowOf(out_.state, EventsOf(header.step, inputs), manoeuvre_.begun());
  if (row != nullptr) Enter(*row, header.step, inputs);
  out_.acceleration_mps2 = Acceleration(inputs);
  return out_;
}

TakeOverEvents TakeOver::EventsOf(std::int64_t step, const TakeOverInputs& inputs) const {
  TakeOverEvents events = 0;
  const auto set = [&events](TakeOverEvent event, bool holds) {
    if (holds) events = static_cast<TakeOverEvents>(events | Bit(event));
  };
  set(TakeOverEvent::kWanted, inputs.human_wanted);
  set(TakeOverEvent::kCalm, !inputs.human_wanted && (!person_ || inputs.gives_back));
  set(TakeOverEvent::kSevere, Severe(inputs.track));
  set(TakeOverEvent::kStandstill, inputs.speed_mps < kStandstill_mps && inputs.applied_mps2 <= 0);
  set(TakeOverEvent::kOverdue, in_manoeuvre() && step > overdue_step_);
  set(TakeOverEvent::kOverride, Overrides(inputs));
  set(TakeOverEvent::kGone, returns_ && inputs.readiness <= 0);
  const bool answered = step >= answer_step_;
  set(TakeOverEvent::kReady, answered && inputs.readiness >= section_.required_readiness);
  set(TakeOverEvent::kRecovered, transferred_ && step - *transferred_ >= recovery_steps_);
  if (!request_) return events;
  const std::int64_t since = step - request_->requested;
  set(TakeOverEvent::kEscalation, since >= escalation_steps_);
  set(TakeOverEvent::kAcknowledged, answered && in_time_);
  set(TakeOverEvent::kDeadline, since >= lead_steps_);
  return events;
}

bool TakeOver::Severe(const track_t* track) const {
  if (track == nullptr || !track->valid) return false;
  const double closing_mps = -track->state[1];
  return closing_mps > 0 && track->state[0] < section_.severe_ttc_s * closing_mps;
}

bool TakeOver::Overrides(const TakeOverInputs& inputs) const {
  return override_mps2_ && inputs.human_mps2 <= *override_mps2_ &&
         inputs.human_mps2 < inputs.applied_mps2 && inputs.readiness >= section_.required_readiness;
}

void TakeOver::Enter(const TakeOverRow& row, std::int64_t step, const TakeOverInputs& inputs) {
  out_.state = row.next;
  out_.authority = row.authority;
  if (row.event == TakeOverEvent::kGone) LoseAuthority();
  if (row.next == TakeOverState::kDemand) Ask(step);
  if (row.next == TakeOverState::kRecovering) TakeAuthority(row, step);
  if (row.next == TakeOverState::kAutomated) overridden_ = false;
  if (request_) request_->Enter(row.next, step);
  const bool stage =
      row.next == TakeOverState::kMrmComfort || row.next == TakeOverState::kMrmEmergency;
  if (stage) BeginStage(row.authority, step, inputs);
}

void TakeOver::TakeAuthority(const TakeOverRow& row, std::int64_t step) {
  transferred_ = step;
  overridden_ = row.event == TakeOverEvent::kOverride;
  if (row.state != TakeOverState::kAutomated) return;
  // The driver has got this authority without a request. If there was a request before, it has
  // already ended.
  request_.reset();
  awaits_answer_ = false;
}

// Prepares a new manoeuvre after a person with the authority has gone. The manoeuvre begins from
// the person's last command. An earlier manoeuvre of this run has no effect on the new manoeuvre.
void TakeOver::LoseAuthority() {
  request_.reset();
  awaits_answer_ = true;
  answer_step_ = kNever;
  manoeuvre_ = models::MinimalRisk(LimitsOf(section_), step_s_);
}

// Begins a request, and draws the time of the driver model's answer. Later events do not change
// this time.
void TakeOver::Ask(std::int64_t step) {
  request_ = TakeOverRequest{.requested = step};
  in_time_ = false;
  answer_step_ = kNever;
  awaits_answer_ = person_;
  if (person_) return;
  const double time_s = time_.Draw(random_, step);
  const bool absent = random_.Uniform2(step, kAbsenceDraw)[0] < section_.absent_probability;
  in_time_ = !absent && time_s <= section_.lead_s;
  if (!absent) answer_step_ = step + StepsUntil(time_s, step_s_);
}

// The answer of a person is valid until the next request, like the answer of the driver model.
void TakeOver::HearAnswer(std::int64_t step, const TakeOverInputs& inputs) {
  if (!awaits_answer_ || !inputs.acknowledged) return;
  awaits_answer_ = false;
  answer_step_ = step;
  in_time_ = request_ && step - request_->requested <= lead_steps_;
}

void TakeOver::BeginStage(Authority stage, std::int64_t step, const TakeOverInputs& inputs) {
  manoeuvre_.Begin(inputs.applied_mps2);
  const double deceleration_mps2 = stage == Authority::kComfort
                                       ? section_.comfort_deceleration_mps2
                                       : section_.emergency_deceleration_mps2;
  const double longest_s = LongestTimeToRest_s(inputs.speed_mps, inputs.applied_mps2,
                                               deceleration_mps2, section_.jerk_mps3, step_s_);
  overdue_step_ = step + StepsUntil(kOverdueFactor * longest_s, step_s_);
}

double TakeOver::Acceleration(const TakeOverInputs& inputs) {
  switch (out_.authority) {
    case Authority::kAutomation:
      return inputs.automation_mps2;
    case Authority::kEasing:
      return std::min(inputs.automation_mps2,
                      std::max(0.0 - section_.slow_down_mps2,
                               inputs.applied_mps2 - section_.jerk_mps3 * step_s_));
    case Authority::kHuman:
      return inputs.human_mps2;
    case Authority::kComfort:
      return manoeuvre_.Step(inputs.speed_mps,
                             std::clamp(-inputs.automation_mps2, section_.comfort_deceleration_mps2,
                                        section_.emergency_deceleration_mps2));
    case Authority::kHard:
      return manoeuvre_.Step(inputs.speed_mps, section_.emergency_deceleration_mps2);
  }
  return 0;
}

}  // namespace fogline::take_over
