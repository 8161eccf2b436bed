#include "services/arbitrator/arbitrator.h"

#include <algorithm>
#include <string>

#include "common/errors.h"
#include "services/decision/policies/policies.h"

namespace fogline::arbitrator {
namespace {

/// Checks a scenario without requests to the driver. @throws InputError if the person may override
/// or may come back: both options need requests
void RequireNoAnswers(const PersonSection& person) {
  constexpr const char* kNeeds = " needs /arbitrator/take_over/mode \"requested\"";
  if (person.override_by != OverrideBy::kNone) {
    throw InputError(std::string("/person/override_by: \"brake\"") + kNeeds);
  }
  if (person.when_gone != WhenGone::kLocked) {
    throw InputError(std::string("/person/when_gone: \"until_back\"") + kNeeds);
  }
}

}  // namespace

Arbitrator::Arbitrator(const Scenario& scenario)
    : threshold_(scenario.arbitrator.threshold),
      meter_(scenario),
      rule_(policies::RowOf(scenario.arbitrator.policy).rule),
      shares_(policies::RowOf(scenario.arbitrator.policy).shares),
      debouncer_(scenario.arbitrator.transfer, scenario.step_s, meter_.is_posterior()),
      transfer_(scenario.arbitrator.transfer, scenario.step_s),
      max_track_variance_m2_(scenario.acc.max_track_std_m * scenario.acc.max_track_std_m),
      easing_per_step_(scenario.arbitrator.take_over.jerk_mps3 * scenario.step_s) {
  out_.threshold = threshold_;
  if (rule_ == policies::Rule::kOwn)
    policy_ = policies::RowOf(scenario.arbitrator.policy).make(scenario);
  if (scenario.arbitrator.transfer.hand_back == HandBack::kFusion) recovery_.emplace(scenario);
  if (scenario.arbitrator.take_over.mode == TakeOverMode::kRequested) take_over_.emplace(scenario);
  if (scenario.aeb.enabled) aeb_.emplace(scenario.aeb);
  if (!take_over_) RequireNoAnswers(scenario.person);
}

bool Arbitrator::UsesOnDemandInput(const Scenario& scenario) {
  return policies::RowOf(scenario.arbitrator.policy).needs_surroundings;
}

void Arbitrator::SetOnDemandInput(const truth_t& truth) {
  surroundings_.visibility_m = truth.fog_visibility_m;
  surroundings_.followed = truth.num_followers > 0;
  if (!surroundings_.followed) return;
  surroundings_.follower_gap_m = truth.follower_gap_m[0];
  surroundings_.follower_speed_mps = truth.follower_speed_mps[0];
}

const arbitration_t& Arbitrator::Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar,
                                      const track_t& track, const accel_command_t& automation,
                                      const driver_command_t& driver) {
  Observe(radar, lidar, track);
  Choose(ego, track, automation, driver);
  Guard(ego, track, out_);
  return out_;
}

const arbitration_t& Arbitrator::Choose(const ego_t& ego, const track_t& track,
                                        const accel_command_t& automation,
                                        const driver_command_t& driver) {
  out_.header = ego.header;
  out_.conflict_m = meter_.conflict();
  out_.doc = meter_.DocOf(out_.conflict_m);
  const policies::EngagementRequest request =
      rule_ == policies::Rule::kThreshold ? policies::Compare(out_.doc, threshold_)
      : rule_ == policies::Rule::kNever   ? policies::StayAutomated(threshold_)
                                          : OwnRequest(ego, track, automation, driver);
  out_.threshold = request.threshold;
  const double wanted = debouncer_.Step(request, out_.doc, !recovery_ || recovery_->recovered());
  Transfer::Offers offers{automation.acceleration_mps2, driver.acceleration_mps2};
  // Without requests (no take_over_), the driver is always ready, as in the paper. So this driver
  // gets the wanted authority without an answer. With requests, Ask() sets granted_ again.
  granted_ = wanted;
  if (take_over_ && !Ask(wanted, ego, track, driver, offers)) return out_;
  const Transfer::State state = transfer_.Step(granted_, offers, ego.acceleration_mps2);
  out_.lambda_human = state.lambda_human;
  out_.lambda_automation = 1 - state.lambda_human;
  out_.acceleration_mps2 = state.acceleration_mps2;
  // The mode names the side with more authority. If both sides have half, the mode names the human.
  out_.mode =
      state.lambda_human < kMainAuthority ? arbitration_t::AUTOMATION : arbitration_t::HUMAN;
  if (take_over_) {
    out_.mode = take_over::InfoOf(take_over_->outcome().state).mode;
    sent_mps2_ = out_.acceleration_mps2;
  }
  return out_;
}

policies::EngagementRequest Arbitrator::OwnRequest(const ego_t& ego, const track_t& track,
                                                   const accel_command_t& automation,
                                                   const driver_command_t& driver) {
  return policy_->Decide({.doc = out_.doc,
                          .threshold = threshold_,
                          .lambda_human = out_.lambda_human,
                          .ego = ego,
                          .track = track,
                          .automation = automation,
                          .driver = driver,
                          .surroundings = surroundings_});
}

bool Arbitrator::Ask(double wanted, const ego_t& ego, const track_t& track,
                     const driver_command_t& driver, Transfer::Offers& offers) {
  const bool manoeuvre_ran = take_over_->in_manoeuvre();
  const bool human_wanted = shares_ ? wanted > 0 : wanted >= kMainAuthority;
  const take_over::TakeOverOutcome& asked =
      take_over_->Step(ego.header, {.human_wanted = human_wanted || !automation_there_,
                                    .automation_mps2 = offers.automation_mps2,
                                    .human_mps2 = offers.human_mps2,
                                    .readiness = driver.readiness,
                                    .speed_mps = ego.speed_mps,
                                    .applied_mps2 = sent_mps2_.value_or(ego.acceleration_mps2),
                                    .track = ShowsCar(track) ? &track : nullptr,
                                    .acknowledged = driver.acknowledged != 0,
                                    .gives_back = driver.gives_back != 0});
  if (take_over_->in_manoeuvre()) {
    granted_ = 0;
    out_.lambda_automation = 0;
    out_.lambda_human = 0;
    out_.acceleration_mps2 = asked.acceleration_mps2;
    out_.mode = take_over::InfoOf(asked.state).mode;
    Overrule(out_);
    return false;
  }
  if (asked.authority == take_over::Authority::kHuman) {
    // The driver shares authority only with an available automation. After a manoeuvre, the
    // automation is off for the rest of the run. A driver who has overridden drives alone.
    const bool shared =
        shares_ && automation_there_ && !take_over_->manoeuvred() && !take_over_->overridden();
    granted_ = shared ? wanted : 1;
    // During a transfer from the automation to the driver, the upper limit of the automation's
    // acceleration falls to 0 step by step.
    eased_mps2_ = std::max(0.0, eased_mps2_ - easing_per_step_);
    if (!shared) offers.automation_mps2 = std::min(offers.automation_mps2, eased_mps2_);
  } else {
    granted_ = 0;
    offers.automation_mps2 = asked.acceleration_mps2;
    eased_mps2_ = std::max(0.0, asked.acceleration_mps2);
  }
  // A driver who overrides has the whole authority from this step on. A driver who ends a minimal
  // risk manoeuvre also has the whole authority, because the automation is then off.
  if (manoeuvre_ran || take_over_->overridden()) {
    transfer_.Overrule(
        {.lambda_human = 1, .acceleration_mps2 = sent_mps2_.value_or(ego.acceleration_mps2)});
  }
  return true;
}

bool Arbitrator::ShowsCar(const track_t& track) const {
  return track.valid && track.covariance[0][0] <= max_track_variance_m2_;
}

void Arbitrator::Guard(const ego_t& ego, const track_t& track, arbitration_t& command) {
  if (!aeb_) return;
  models::Situation seen{.speed_mps = ego.speed_mps,
                         .acceleration_mps2 = ego.acceleration_mps2,
                         .ahead = std::nullopt};
  if (ShowsCar(track)) {
    seen.ahead = models::CarAhead{.gap_m = track.state[0],
                                  .speed_mps = ego.speed_mps + track.state[1],
                                  .acceleration_mps2 = ego.acceleration_mps2 + track.state[2]};
  }
  switch (aeb_->Step(seen)) {
    case models::AebState::kReady:
      return;
    case models::AebState::kWarning:
      if (command.mode == arbitration_t::AUTOMATION || command.mode == arbitration_t::HUMAN) {
        command.mode = arbitration_t::COLLISION_WARNING;
      }
      return;
    case models::AebState::kBraking:
      command.acceleration_mps2 = aeb_->Applied(command.acceleration_mps2);
      if (!InMinimalRisk(command.mode)) command.mode = arbitration_t::EMERGENCY_BRAKING;
      if (take_over_) sent_mps2_ = command.acceleration_mps2;
      return;
  }
}

void Arbitrator::Overrule(const arbitration_t& sent) {
  out_.lambda_human = sent.lambda_human;
  transfer_.Overrule({sent.lambda_human, sent.acceleration_mps2});
  sent_mps2_ = sent.acceleration_mps2;
}

}  // namespace fogline::arbitrator
