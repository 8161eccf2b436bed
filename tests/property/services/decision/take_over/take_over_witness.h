// Random events for the state machine of take-overs, and an independent computation of its events
// and commands. The computation does not call services/decision/take_over/take_over.cc. It shares
// with take_over.cc only the code for the drawn take-over time and for the course of a manoeuvre.
// This shared code has tests of its own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "common/random.h"
#include "services/decision/take_over/take_over.h"

namespace fogline::test {

/// Tolerance for the rounding of sums of seconds and of accelerations.
inline constexpr double kTolerance = 1e-9;

/// The random numbers of one sequence. No other object draws from them.
class Dice {
 public:
  explicit Dice(std::int64_t sequence) : random_(sequence, Stream::kFaults) {}
  double Between(double low, double high) {
    return low + (high - low) * random_.Uniform2(draw_++, 0)[0];
  }
  bool Chance(double probability) { return Between(0, 1) < probability; }

 private:
  Random random_;
  std::int64_t draw_ = 0;
};

inline Scenario AnyScenario(Dice& dice) {
  Scenario scenario;
  constexpr std::array kSteps_s{0.1, 0.2, 0.5};
  scenario.step_s = kSteps_s[static_cast<std::size_t>(dice.Between(0, 3))];
  scenario.seed = static_cast<std::int64_t>(dice.Between(1, 1e6));
  scenario.arbitrator.take_over = {
      .mode = TakeOverMode::kRequested,
      .lead_s = dice.Between(10, 14),
      .escalation_s = dice.Between(0.1, 14),
      .time = {.mean_s = dice.Between(0.3, 14), .std_s = dice.Between(0.1, 5)},
      .absent_probability = dice.Chance(0.3) ? 1.0 : 0.0,
      .required_readiness = dice.Between(0, 1),
      .recovery_s = dice.Between(0, 3),
      .severe_ttc_s = dice.Between(0.5, 3),
      .comfort_deceleration_mps2 = dice.Between(0.5, 3),
      .emergency_deceleration_mps2 = dice.Between(3.2, 4),
      .jerk_mps3 = dice.Between(0.5, 20)};
  if (dice.Chance(0.4)) {
    scenario.person = {.drives = true,
                       .coasting_mps2 = 0.5,
                       .when_gone = dice.Chance(0.5) ? WhenGone::kUntilBack : WhenGone::kLocked,
                       .override_by = dice.Chance(0.8) ? OverrideBy::kBrake : OverrideBy::kNone,
                       .override_pedal = dice.Between(0.01, 0.9)};
  }
  return scenario;
}

/// Random inputs of the state machine: offers, engagement requests, cars ahead, and the motion of
/// the host. At first the host may keep its speed whatever the command is, as if its brakes had
/// failed.
class Events {
 public:
  Events(Dice& dice, const Scenario& scenario)
      : dice_(dice),
        step_s_(scenario.step_s),
        person_(scenario.person.drives),
        brakes_(!dice.Chance(0.15)) {
    track_.valid = true;
    inputs_.speed_mps = dice.Chance(0.5) ? dice.Between(0, 5) : dice.Between(5, 40);
    inputs_.applied_mps2 = dice.Between(-6, 2);
    danger_ = dice.Chance(0.3) ? 0.05 : 0.002;
    liveliness_ = dice.Chance(0.5) ? 0.05 : 0.002;
  }

  const take_over::TakeOverInputs& Next() {
    if (dice_.Chance(0.03)) inputs_.human_wanted = !inputs_.human_wanted;
    inputs_.automation_mps2 = dice_.Between(-6, 2);
    inputs_.human_mps2 = dice_.Between(-8, 3);
    if (person_) Act();
    inputs_.readiness = dice_.Between(0, 1);
    if (person_ && dice_.Chance(liveliness_ / 2)) inputs_.readiness = 0;
    track_.state[0] = dice_.Chance(danger_) ? dice_.Between(-1, 20) : dice_.Between(80, 200);
    track_.state[1] = dice_.Between(-20, 20);
    track_.valid = dice_.Chance(0.95);
    inputs_.track = dice_.Chance(0.95) ? &track_ : nullptr;
    return inputs_;
  }

  /// Draws new offers of the automation and of a simulated driver. These offers do not influence
  /// the events. The offer of a person is not drawn again, because it may be an override, which is
  /// an event.
  void OtherOffers() {
    const bool eager = dice_.Chance(0.5);
    inputs_.automation_mps2 =
        eager ? std::max(0.0, inputs_.applied_mps2) + dice_.Between(0.1, 1) : dice_.Between(-6, 2);
    if (!person_) inputs_.human_mps2 = dice_.Between(-8, 3);
  }
  const take_over::TakeOverInputs& inputs() const { return inputs_; }

  void Apply(double acceleration_mps2) {
    inputs_.applied_mps2 = acceleration_mps2;
    if (dice_.Chance(0.005)) brakes_ = true;
    if (brakes_) {
      inputs_.speed_mps = std::clamp(inputs_.speed_mps + step_s_ * acceleration_mps2, 0.0, 60.0);
    }
  }

 private:
  /// Draws what the person does. A person usually does not press the brake hard.
  void Act() {
    inputs_.human_mps2 = dice_.Chance(liveliness_) ? dice_.Between(-8, 0) : dice_.Between(-0.5, 3);
    inputs_.acknowledged = dice_.Chance(liveliness_);
    inputs_.gives_back = dice_.Chance(0.1);
  }

  Dice& dice_;
  double step_s_;
  bool person_;
  double liveliness_ = 0;  // probability of each action of a person in a step
  bool brakes_;
  double danger_;
  track_t track_{};
  take_over::TakeOverInputs inputs_;
};

/// The independent computation. It finds the events of a step, and the command of each source, from
/// the inputs and from the state machine's earlier states.
class Witness {
 public:
  explicit Witness(const Scenario& scenario)
      : section_(scenario.arbitrator.take_over),
        person_(scenario.person),
        step_s_(scenario.step_s),
        random_(scenario.seed, Stream::kTakeOver),
        time_(section_.time, section_.lead_s),
        manoeuvre_(Fresh()) {}

  take_over::TakeOverEvents EventsOf(std::int64_t step,
                                     const take_over::TakeOverInputs& inputs) const {
    take_over::TakeOverEvents events = 0;
    const auto set = [&events](take_over::TakeOverEvent event, bool holds) {
      if (holds) events = static_cast<take_over::TakeOverEvents>(events | take_over::Bit(event));
    };
    const bool may_return = !person_.drives || inputs.gives_back;
    set(take_over::TakeOverEvent::kWanted, inputs.human_wanted);
    set(take_over::TakeOverEvent::kCalm, !inputs.human_wanted && may_return);
    set(take_over::TakeOverEvent::kOverride, Overrides(inputs));
    set(take_over::TakeOverEvent::kGone,
        person_.drives && person_.when_gone == WhenGone::kUntilBack && inputs.readiness == 0);
    const bool answers_now = awaits_ && inputs.acknowledged;
    const bool answered = person_.drives
                              ? answered_ || answers_now
                              : requested_ && Since(step, *requested_) + kTolerance >= time_s_;
    set(take_over::TakeOverEvent::kReady,
        answered && inputs.readiness >= section_.required_readiness);
    set(take_over::TakeOverEvent::kRecovered,
        transferred_ && Since(step, *transferred_) + kTolerance >= section_.recovery_s);
    set(take_over::TakeOverEvent::kSevere, Ttc_s(inputs) < section_.severe_ttc_s);
    set(take_over::TakeOverEvent::kStandstill, inputs.speed_mps < 0.01 && inputs.applied_mps2 <= 0);
    set(take_over::TakeOverEvent::kOverdue,
        stage_ && Since(step, *stage_ + 1) + kTolerance >= overdue_s_);
    if (!requested_) return events;
    const double t = Since(step, *requested_);
    // The time of a person's answer is a whole number of steps. An answer in the step of the
    // deadline is still in time. The drawn take-over time of the driver model need not be a whole
    // number of steps. So this time is compared with lead_s itself.
    const double answer_s = answers_now ? t : time_s_;
    const bool in_time = person_.drives ? answer_s < section_.lead_s + step_s_ - kTolerance
                                        : answer_s <= section_.lead_s;
    set(take_over::TakeOverEvent::kEscalation, t + kTolerance >= section_.escalation_s);
    set(take_over::TakeOverEvent::kAcknowledged, answered && in_time);
    set(take_over::TakeOverEvent::kDeadline, t + kTolerance >= section_.lead_s);
    return events;
  }

  /// The command of the controller of `authority` in this step. For kComfort and kHard the function
  /// advances the manoeuvre, so call it only once in a step.
  double Source(take_over::Authority authority, const take_over::TakeOverInputs& inputs) {
    const double least =
        std::min(section_.comfort_deceleration_mps2, section_.emergency_deceleration_mps2);
    switch (authority) {
      case take_over::Authority::kAutomation:
        return inputs.automation_mps2;
      case take_over::Authority::kEasing:
        return std::min(inputs.automation_mps2,
                        std::max(0.0, inputs.applied_mps2 - section_.jerk_mps3 * step_s_));
      case take_over::Authority::kHuman:
        return inputs.human_mps2;
      case take_over::Authority::kComfort:
        return manoeuvre_.Step(inputs.speed_mps, std::clamp(-inputs.automation_mps2, least,
                                                            section_.emergency_deceleration_mps2));
      case take_over::Authority::kHard:
        return manoeuvre_.Step(inputs.speed_mps);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  void Note(const take_over::TakeOverOutcome& out, take_over::TakeOverState before,
            std::int64_t step, const take_over::TakeOverInputs& inputs) {
    using enum take_over::TakeOverState;
    if (awaits_ && inputs.acknowledged) {
      awaits_ = false;
      answered_ = true;
      if (requested_) time_s_ = Since(step, *requested_);
    }
    if (out.state == kDemand && before == kAutomated) {
      requested_ = step;
      Await();
      const bool absent = person_.drives || section_.absent_probability >= 1;
      time_s_ = absent ? kNever_s : time_.Draw(random_, step);
    }
    if (out.state == kRecovering && before == kAutomated) {
      requested_.reset();
      awaits_ = false;
    }
    if (out.state == kMrmComfort && human_) {
      requested_.reset();
      Await();
      manoeuvre_ = Fresh();
    }
    human_ = out.authority == take_over::Authority::kHuman;
    if (out.state == kRecovering && before != kRecovering) transferred_ = step;
    if (out.authority >= take_over::Authority::kComfort) manoeuvre_.Begin(inputs.applied_mps2);
    if (out.state == before) return;
    stage_.reset();
    if (out.state != kMrmComfort && out.state != kMrmEmergency) return;
    stage_ = step;
    overdue_s_ =
        2 * LongestStop_s(inputs, out.state == kMrmComfort ? section_.comfort_deceleration_mps2
                                                           : section_.emergency_deceleration_mps2);
  }

  /// The command that `authority` would give in this step if it had control.
  double Would(take_over::Authority authority, const take_over::TakeOverInputs& inputs) const {
    Witness other = *this;
    if (human_) other.manoeuvre_ = Fresh();
    if (authority >= take_over::Authority::kComfort) other.manoeuvre_.Begin(inputs.applied_mps2);
    return other.Source(authority, inputs);
  }
  /// The command of a manoeuvre without a limit of deceleration. The limit of the jerk, and the
  /// limit shortly before standstill, still apply.
  double WouldAtMost(const take_over::TakeOverInputs& inputs) const {
    Witness other = *this;
    other.manoeuvre_.Begin(inputs.applied_mps2);
    return other.manoeuvre_.Step(inputs.speed_mps, std::numeric_limits<double>::infinity());
  }

  double SinceRequest(std::int64_t step) const { return Since(step, *requested_); }
  static double Ttc_s(const take_over::TakeOverInputs& inputs) {
    const bool closing =
        inputs.track != nullptr && inputs.track->valid && inputs.track->state[1] < 0;
    return closing ? inputs.track->state[0] / -inputs.track->state[1]
                   : std::numeric_limits<double>::infinity();
  }
  bool manoeuvred() const { return manoeuvre_.begun(); }

 private:
  static constexpr double kNever_s = std::numeric_limits<double>::infinity();

  /// Whether a person is ready, brakes harder than the car, and brakes at least as hard as the
  /// override threshold. A brake pedal at the position p in [0, 1] gives 0.5 m/s2 + 8 m/s2 p^1.5,
  /// at most 8 m/s2.
  bool Overrides(const take_over::TakeOverInputs& inputs) const {
    if (!person_.drives || person_.override_by == OverrideBy::kNone) return false;
    const double threshold_mps2 = std::max(-0.5 - 8 * std::pow(person_.override_pedal, 1.5), -8.0);
    return inputs.readiness >= section_.required_readiness && inputs.human_mps2 <= threshold_mps2 &&
           inputs.human_mps2 < inputs.applied_mps2;
  }

  /// A manoeuvre that has not begun.
  models::MinimalRisk Fresh() const {
    return {{.deceleration_mps2 = section_.emergency_deceleration_mps2,
             .jerk_mps3 = section_.jerk_mps3},
            step_s_};
  }

  /// Makes the answers of a person count from the next step on.
  void Await() {
    awaits_ = person_.drives;
    answered_ = false;
  }

  /// The longest time until the car stands, on a level road
  /// (services/models/minimal_risk/README.md). It is the sum of the times to apply the brake, to
  /// slow down and to release the brake, and of three steps.
  double LongestStop_s(const take_over::TakeOverInputs& inputs, double deceleration_mps2) const {
    const double push = std::max(inputs.applied_mps2, 0.0);
    const double jerk = section_.jerk_mps3;
    return std::abs(inputs.applied_mps2 + deceleration_mps2) / jerk +
           (inputs.speed_mps + push * push / (2 * jerk) + push * step_s_) / deceleration_mps2 +
           deceleration_mps2 / jerk + 3 * step_s_;
  }
  double Since(std::int64_t step, std::int64_t begin) const {
    return static_cast<double>(step - begin) * step_s_;
  }

  TakeOverSection section_;
  PersonSection person_;
  double step_s_;
  Random random_;
  models::TakeOverTime time_;
  models::MinimalRisk manoeuvre_;
  std::optional<std::int64_t> requested_;
  std::optional<std::int64_t> transferred_;
  double time_s_ = 0;  // from the request to the answer
  bool awaits_ = false;
  bool answered_ = false;
  bool human_ = false;                 // whether the human has the authority
  std::optional<std::int64_t> stage_;  // first step of the current stage of the manoeuvre
  double overdue_s_ = 0;               // the stage is overdue after this time
};

}  // namespace fogline::test
