// Decides in every step which side drives the host. Except in a minimal risk manoeuvre and in
// emergency braking, the command is computed only from the accelerations that automation and human
// offer. The arbitrator does not judge these offers.
//
//     radar, LiDAR -> ConflictMeter -> DoC                        conflict_meter.h
//     DoC, situation -> policy -> engagement request              services/decision/policies
//     engagement request -> RequestDebouncer -> wanted authority  request_debouncer.h
//     track, radar, LiDAR -> FusionRecovery -> RequestDebouncer   fusion_recovery.h
//     wanted -> TakeOver, if the driver must be asked -> granted  take_over.h
//     granted, offers -> Transfer -> authority, command           transfer.h
//     track, command -> emergency braking -> command that is sent services/models/aeb
#pragma once

#include <memory>
#include <optional>

#include "scenario/sections/scenario.h"
#include "services/arbitrator/conflict_meter.h"
#include "services/arbitrator/fusion_recovery.h"
#include "services/arbitrator/request_debouncer.h"
#include "services/arbitrator/transfer.h"
#include "services/decision/policies/policy.h"
#include "services/decision/take_over/take_over.h"
#include "services/graph.h"
#include "services/host_modes.h"
#include "services/models/aeb/aeb.h"

namespace fogline::arbitrator {

/// The algorithm of the role `arbitrator`. With the defaults of the scenario, the arbitrator does
/// the traded control of Sourav & Cheng 2024. Traded control weights the accelerations a_A of the
/// automation and a_H of the human:
///
///     lambda_A = 1 if 0 <= DoC < threshold, else 0        lambda_H = 1 - lambda_A
///     a = lambda_H a_H + lambda_A a_A
class Arbitrator {
 public:
  explicit Arbitrator(const Scenario& scenario);

  /// Whether the scenario's policy uses the surroundings. If the policy uses them,
  /// SetOnDemandInput() is called before every Step().
  static bool UsesOnDemandInput(const Scenario& scenario);
  /// Takes values from the truth of this step: only those that a perfect rear sensor and a
  /// visibility meter would give.
  void SetOnDemandInput(const truth_t& truth);

  /// Returns the host's command for the step of `ego`. Call Step() once per step, in the order of
  /// steps. The result is valid until the next call.
  const arbitration_t& Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar,
                            const track_t& track, const accel_command_t& automation,
                            const driver_command_t& driver);

  /// First part of a Step(): adds the sensors' values to the measure of conflict.
  void Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
    meter_.Observe(radar, lidar, track);
    if (recovery_) recovery_->Observe(radar, lidar, track);
  }
  /// Second part of a Step(): computes the command. In real time, Choose() may be called for a step
  /// without new values of the sensors.
  const arbitration_t& Choose(const ego_t& ego, const track_t& track,
                              const accel_command_t& automation, const driver_command_t& driver);

  /// Applies emergency braking, even while the human drives. Emergency braking may replace
  /// acceleration and mode of the command. It does not replace the mode of a minimal risk
  /// manoeuvre. Call Guard() once per decision, after Choose(). Step() calls Guard() itself.
  void Guard(const ego_t& ego, const track_t& track, arbitration_t& command);

  /// Whether the human should have at least half of the authority at the end of the present
  /// transfer, according to the last decision. If the driver must be asked, the result is true only
  /// after the driver has taken over.
  bool wants_human() const { return granted_ >= kMainAuthority; }
  /// Whether the driver must be asked and has not taken over.
  bool must_ask() const {
    return take_over_ && take_over_->outcome().authority != take_over::Authority::kHuman;
  }
  /// Whether a request to take over is pending, or the host is in a minimal risk manoeuvre that
  /// TakeOver has begun. In both cases the command does not depend on the driver's acceleration.
  bool asks() const {
    return must_ask() && take_over_->outcome().state != take_over::TakeOverState::kAutomated;
  }
  bool in_manoeuvre() const { return take_over_ && take_over_->in_manoeuvre(); }
  /// Whether the driver has taken over not long ago, and a manoeuvre has run before.
  bool recovers_from_manoeuvre() const {
    return take_over_ && take_over_->manoeuvred() &&
           take_over_->outcome().state == take_over::TakeOverState::kRecovering;
  }
  /// Sets whether the automation is available. Only an available automation gets authority back
  /// from a driver who was asked.
  void SetAutomationThere(bool there) { automation_there_ = there; }
  /// Tells the arbitrator which command was sent. Call Overrule() if the command of the last
  /// decision was not sent. The next command then continues from the command that was sent.
  void Overrule(const arbitration_t& sent);

 private:
  /// The request of a policy with a rule of its own (neither kThreshold nor kNever), for the DoC in
  /// out_.
  policies::EngagementRequest OwnRequest(const ego_t& ego, const track_t& track,
                                         const accel_command_t& automation,
                                         const driver_command_t& driver);
  /// Passes the engagement request to TakeOver; only for a driver who must be asked. Then sets
  /// granted_ and the automation's offer, or, in a minimal risk manoeuvre, sets the command.
  /// @return false if the host is in a minimal risk manoeuvre
  bool Ask(double wanted, const ego_t& ego, const track_t& track, const driver_command_t& driver,
           Transfer::Offers& offers);
  /// Whether the track shows where a preceding car is, and is certain enough (acc.max_track_std_m).
  bool ShowsCar(const track_t& track) const;

  double threshold_;
  ConflictMeter meter_;
  policies::Rule rule_;
  bool shares_;
  std::unique_ptr<policies::EngagementPolicy> policy_;  // null unless rule_ is kOwn
  std::optional<FusionRecovery> recovery_;              // only with hand_back fusion
  RequestDebouncer debouncer_;
  Transfer transfer_;
  policies::Surroundings surroundings_;
  std::optional<take_over::TakeOver> take_over_;  // only for a driver who must be asked
  std::optional<models::Aeb> aeb_;                // only for a host that has emergency braking
  double max_track_variance_m2_;                  // limit for a track that shows a car
  double easing_per_step_;                        // m/s2; decrease of eased_mps2_ per step
  double eased_mps2_ = 0;                         // limit of the automation's offer after a request
  bool automation_there_ = true;
  double granted_ = 0;               // lambda_H at the end of the transfer
  std::optional<double> sent_mps2_;  // command of the previous step
  arbitration_t out_{};
};

}  // namespace fogline::arbitrator
