// The emergency fallback: between the policy's wish that the human should drive and the transfer of
// authority stand a request, a driver who answers late or never, and a manoeuvre that stops the
// car.
#pragma once

#include <cstdint>
#include <optional>

#include "fogline/header_t.hpp"
#include "fogline/track_t.hpp"
#include "scenario/scenario.h"
#include "services/arbitrator/take_over_request.h"
#include "services/arbitrator/take_over_table.h"
#include "services/driver_models/take_over_time.h"
#include "services/minimal_risk/minimal_risk.h"
#include "services/runtime/random.h"

namespace fogline {

/// What a step is decided with.
struct TakeOverInputs {
  bool human_wanted = false;   // the policy's wish
  double automation_mps2 = 0;  // the automation's offer
  double human_mps2 = 0;       // the driver's
  double readiness = 0;        // the driver's, in [0, 1]
  double speed_mps = 0;        // of the host
  double applied_mps2 = 0;  // command of the step before, as it went out; at first what was applied
  const track_t* track = nullptr;  // the preceding car; nullptr: none is known
};

/// What a step has come to.
struct TakeOverOutcome {
  TakeOverState state = TakeOverState::kAutomated;
  Authority authority = Authority::kAutomation;
  double acceleration_mps2 = 0;  // of whoever has authority
};

/// Below this speed in m/s the host stands, unless it is about to drive off. Chosen: 1 cm/s, below
/// what wheel sensors measure.
inline constexpr double kStandstill_mps = 0.01;

/// A stage of the manoeuvre is overdue after so many times what its brake needs on a level road.
/// Chosen: 2 leaves half of a comfortable 1.5 m/s2 to a descent of 7 % and to slow brakes.
inline constexpr double kOverdueFactor = 2.0;

/// The state machine of take_over_table.h at work, in seconds since the request, t:
///
///     acknowledgement: t >= T, T drawn in the step of the request (take_over_time.h), never with
///                      absent_probability            transfer: and readiness >= required_readiness
///     escalation:      t >= escalation_s             deadline: t >= lead_s
///     easing:          a = min(a_A, max(0, a' - j h))   a' the command of the step before
///     manoeuvre:       services/minimal_risk with jerk j and, in its stages, the deceleration
///                      clip(-a_A, comfort, emergency) and emergency
///
/// So the manoeuvre never brakes less than the automation would, up to the emergency's
/// deceleration. T > lead_s exactly if a driver who is there is late. Acknowledgement and transfer
/// are at least a step apart, in which the automation drives; only one who comes during the
/// manoeuvre gets the wheel at once.
class TakeOver {
 public:
  /// @throw std::invalid_argument if lead_s is below kLeastLead_s, and as TakeOverTime
  explicit TakeOver(const Scenario& scenario);

  /// Decides the step of `header`. In the order of steps; some may be left out. Valid until the
  /// next call.
  const TakeOverOutcome& Step(const header_t& header, const TakeOverInputs& inputs);

  const TakeOverOutcome& outcome() const { return out_; }
  /// The last request, if there has been one, without `effective`.
  const std::optional<TakeOverRequest>& request() const { return request_; }
  /// A manoeuvre runs, has failed, or has ended in standstill.
  bool in_manoeuvre() const { return out_.authority >= Authority::kComfort; }
  /// One has begun in this run, though the driver may have ended it.
  bool manoeuvred() const { return manoeuvre_.begun(); }

 private:
  TakeOverEvents EventsOf(std::int64_t step, const TakeOverInputs& inputs) const;
  bool Severe(const track_t* track) const;
  void Enter(const TakeOverRow& row, std::int64_t step, const TakeOverInputs& inputs);
  void Ask(std::int64_t step);
  void BeginStage(Authority stage, std::int64_t step, const TakeOverInputs& inputs);
  double Acceleration(const TakeOverInputs& inputs);

  TakeOverSection section_;
  double step_s_;
  std::int64_t lead_steps_;
  std::int64_t escalation_steps_;
  std::int64_t recovery_steps_;
  Random random_;
  TakeOverTime time_;
  MinimalRisk manoeuvre_;

  std::optional<TakeOverRequest> request_;
  std::int64_t answer_step_ = 0;   // of this request's acknowledgement
  bool in_time_ = false;           // he answers within lead_s
  std::int64_t overdue_step_ = 0;  // of this stage of the manoeuvre
  TakeOverOutcome out_;
};

}  // namespace fogline
