// Take-over on request: if the policy wants the human to drive, the driver gets a request to take
// over. If the driver answers late or never, a minimal risk manoeuvre stops the car.
#pragma once

#include <cstdint>
#include <optional>

#include "common/random.h"
#include "fogline/header_t.hpp"
#include "fogline/track_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/decision/take_over/take_over_request.h"
#include "services/decision/take_over/take_over_table.h"
#include "services/models/driver/take_over_time.h"
#include "services/models/minimal_risk/minimal_risk.h"

namespace fogline::take_over {

/// Inputs of the decision of a step.
struct TakeOverInputs {
  bool human_wanted = false;       // the policy's engagement request
  double automation_mps2 = 0;      // the automation's offer
  double human_mps2 = 0;           // the driver's offer
  double readiness = 0;            // the driver's readiness, in [0, 1]
  double speed_mps = 0;            // speed of the host
  double applied_mps2 = 0;         // last command sent; before any command, the host's acceleration
  const track_t* track = nullptr;  // nullptr if no preceding car is known
  // Inputs of a person who drives; always false for the model of a driver.
  bool acknowledged = false;  // the driver answers now
  bool gives_back = false;    // the driver wants the automation to drive
};

/// Result of a step.
struct TakeOverOutcome {
  TakeOverState state = TakeOverState::kAutomated;
  Authority authority = Authority::kAutomation;
  double acceleration_mps2 = 0;  // command of the side that has authority, or of the manoeuvre
};

/// Below this speed in m/s, the host counts as standing if its command does not accelerate. Our
/// choice: 1 cm/s, which wheel sensors cannot measure.
inline constexpr double kStandstill_mps = 0.01;

/// A stage of the manoeuvre is overdue after this multiple of the time that the brake needs on a
/// level road. Our choice: with 2, a stage is not overdue if a descent of 7 % and slow brakes
/// reduce a comfortable deceleration of 1.5 m/s2 by half.
inline constexpr double kOverdueFactor = 2.0;

/// The state machine of take_over_table.h, with these conditions and decelerations. t is the time
/// in s since the request, T the time from the request to the driver's answer, a_A and a_H the
/// offers of automation and driver, a' the last command that was sent, h the length of a step, and
/// j = jerk_mps3:
///
///     acknowledgement  t >= T, if T <= lead_s. T is drawn in the step of the request
///                      (take_over_time.h). T is infinite with the probability
///                      absent_probability.
///     transfer         t >= T and readiness >= required_readiness
///     override         only if a person drives, and override_by is "brake": a_H <= a_P, a_H < a',
///                      and readiness >= required_readiness
///     escalation       t >= escalation_s
///     deadline         t >= lead_s
///     easing           a = min(a_A, max(-slow_down_mps2, a' - j h))
///     manoeuvre        services/models/minimal_risk with jerk j. The deceleration is
///                      clip(-a_A, comfort, emergency) in the first stage, and emergency in the
///                      second stage.
///
/// So the target deceleration of the manoeuvre is at least that of the automation, but at most
/// emergency_deceleration_mps2. The actual deceleration can be smaller, because the jerk is
/// limited, and because the brake is released smoothly before the car stands. A driver who is not
/// absent is late if T is above lead_s, and only then. Between acknowledgement and transfer the
/// automation drives for at least one step. Only a driver who overrides, or who answers during the
/// manoeuvre, gets authority without such a step.
///
/// If the scenario has a person who drives, no random number is drawn: T is the time from the
/// request to the first later step in which the person answers. A return to the automation has a
/// further condition: the person gives the authority back.
///
/// If when_gone is "until_back", the manoeuvre also begins when a person who has the authority is
/// gone (readiness 0). TakeOver then waits for a new answer of the person, as after a request.
///
/// A person overrides with the brake pedal under two conditions. The pedal is at override_pedal or
/// beyond, and it brakes harder than the last command a'. a_P is the acceleration that belongs to a
/// brake pedal at override_pedal and a released throttle (services/models/driver/pedal_response.h).
class TakeOver {
 public:
  /// @throw InputError if the released pedals already brake as hard as a brake at override_pedal
  /// @throw std::invalid_argument if lead_s is below kLeastLead_s, or if TakeOverTime throws it
  explicit TakeOver(const Scenario& scenario);

  /// Makes the decision for the step of `header`. Call Step() in the order of steps; some steps may
  /// be skipped. The result is valid until the next call.
  const TakeOverOutcome& Step(const header_t& header, const TakeOverInputs& inputs);

  const TakeOverOutcome& outcome() const { return out_; }
  /// The last request; empty if there has been no request. The result is also empty after an
  /// override without a request, and after a person who had the authority has left. The field
  /// `effective` is always empty.
  const std::optional<TakeOverRequest>& request() const { return request_; }
  /// Whether a manoeuvre is running, has failed, or has ended in standstill.
  bool in_manoeuvre() const { return out_.authority >= Authority::kComfort; }
  /// Whether a manoeuvre has begun in this run, even if the driver has ended this manoeuvre.
  bool manoeuvred() const { return manoeuvre_.begun(); }
  /// Whether the driver's last take-over was an override; false again after a return to the
  /// automation.
  bool overridden() const { return overridden_; }

 private:
  TakeOverEvents EventsOf(std::int64_t step, const TakeOverInputs& inputs) const;
  bool Severe(const track_t* track) const;
  bool Overrides(const TakeOverInputs& inputs) const;
  void Enter(const TakeOverRow& row, std::int64_t step, const TakeOverInputs& inputs);
  void TakeAuthority(const TakeOverRow& row, std::int64_t step);
  void LoseAuthority();
  void Ask(std::int64_t step);
  void HearAnswer(std::int64_t step, const TakeOverInputs& inputs);
  void BeginStage(Authority stage, std::int64_t step, const TakeOverInputs& inputs);
  double Acceleration(const TakeOverInputs& inputs);

  TakeOverSection section_;
  bool person_;                          // whether a person drives
  bool returns_;                         // whether a person who is gone may come back
  std::optional<double> override_mps2_;  // a_P; nullopt if no person can override
  double step_s_;
  std::int64_t lead_steps_;
  std::int64_t escalation_steps_;
  std::int64_t recovery_steps_;
  Random random_;
  models::TakeOverTime time_;
  models::MinimalRisk manoeuvre_;

  std::optional<TakeOverRequest> request_;
  bool awaits_answer_ = false;     // whether a person's answer is expected
  std::int64_t answer_step_;       // step of the answer; may lie in the future
  bool in_time_ = false;           // whether the driver answers within lead_s
  std::int64_t overdue_step_ = 0;  // last step in which this stage of the manoeuvre is not overdue
  std::optional<std::int64_t> transferred_;  // step in which the driver got the authority
  bool overridden_ = false;
  TakeOverOutcome out_;
};

}  // namespace fogline::take_over
