// Decides who drives the host, in every step anew. What it sends is made of the two offers and of
// nothing else; it judges neither.
//
//     radar, LiDAR -> ConflictMeter -> DoC                        conflict_meter.h
//     DoC, situation -> policy -> wish                            services/policies
//     wish -> SteadyWish -> authority that is wanted              steady_wish.h
//     wanted -> TakeOver, if the driver must be asked -> granted  take_over.h
//     granted, offers -> Transfer -> authority, command           transfer.h
#pragma once

#include <memory>
#include <optional>

#include "scenario/scenario.h"
#include "services/arbitrator/conflict_meter.h"
#include "services/arbitrator/steady_wish.h"
#include "services/arbitrator/take_over.h"
#include "services/arbitrator/transfer.h"
#include "services/graph.h"
#include "services/policies/policy.h"

namespace fogline {

/// With the defaults the traded control of Sourav & Cheng 2024:
///
///     lambda_A = 1 if 0 <= DoC < threshold, else 0        lambda_H = 1 - lambda_A
///     a = lambda_H a_H + lambda_A a_A
class Arbitrator {
 public:
  explicit Arbitrator(const Scenario& scenario);

  /// Whether the scenario's policy looks around: Hear() is then called before every Step().
  static bool Demands(const Scenario& scenario);
  /// What a perfect rear sensor and a visibility meter would tell of this step. Nothing else of the
  /// truth is looked at.
  void Hear(const truth_t& truth);

  /// The host's command for the step that begins here. Once per step, in order. The result is valid
  /// until the next call.
  const arbitration_t& Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar,
                            const track_t& track, const accel_command_t& automation,
                            const driver_command_t& driver);

  /// The two halves of a Step: the sensors' values are added to the conflict, ...
  void Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
    meter_.Observe(radar, lidar, track);
  }
  /// ... and a decision on it is taken. In real time a step may be decided without new values of
  /// the sensors.
  const arbitration_t& Choose(const ego_t& ego, const track_t& track,
                              const accel_command_t& automation, const driver_command_t& driver);

  /// Whether the last decision wants the human to drive, also where the transfer is still under
  /// way. Of a driver who must be asked: whether he has come, and has half of the wheel at least.
  bool wants_human() const { return granted_ >= kMainAuthority; }
  /// The driver must be asked, and has not taken over.
  bool must_ask() const {
    return take_over_ && take_over_->outcome().authority != Authority::kHuman;
  }
  /// A request stands, or the host is in the manoeuvre of a driver who did not come. The manoeuvre
  /// needs no input but the odometry.
  bool asks() const {
    return must_ask() && take_over_->outcome().state != TakeOverState::kAutomated;
  }
  bool in_manoeuvre() const { return take_over_ && take_over_->in_manoeuvre(); }
  /// An automation that is not there does not get the wheel back from a driver who was asked.
  void SetAutomationThere(bool there) { automation_there_ = there; }
  /// Another command was sent than the last decision's: the next one goes on from it.
  void Overrule(const arbitration_t& sent);

 private:
  /// What a policy with a rule of its own makes of the conflict in out_.
  Wish OwnWish(const ego_t& ego, const track_t& track, const accel_command_t& automation,
               const driver_command_t& driver);
  /// What becomes of the wish for the human if he must be asked. @return whether anybody drives
  bool Ask(double wanted, const ego_t& ego, const track_t& track, const driver_command_t& driver,
           Transfer::Offers& offers);

  double threshold_;
  ConflictMeter meter_;
  Rule rule_;
  bool shares_;
  std::unique_ptr<EngagementPolicy> policy_;  // none for a simple rule
  SteadyWish steady_;
  Transfer transfer_;
  Surroundings surroundings_;
  std::optional<TakeOver> take_over_;  // only of a driver who must be asked
  double easing_per_step_;             // m/s2; how fast an acceleration is let go after a request
  double eased_mps2_ = 0;              // more than this the automation does not accelerate then
  bool automation_there_ = true;
  double granted_ = 0;               // lambda_H, where the transfer ends
  std::optional<double> sent_mps2_;  // command of the step before
  arbitration_t out_{};
};

}  // namespace fogline
