#include "services/arbitrator/arbitrator.h"

#include "services/policies/policies.h"

namespace fogline {

Arbitrator::Arbitrator(const Scenario& scenario)
    : threshold_(scenario.arbitrator.threshold),
      meter_(scenario),
      policy_(RowOf(scenario.arbitrator.policy).make(scenario)),
      steady_(scenario.arbitrator.transfer, scenario.step_s),
      transfer_(scenario.arbitrator.transfer, scenario.step_s) {
  out_.threshold = threshold_;
}

bool Arbitrator::Demands(const Scenario& scenario) {
  return RowOf(scenario.arbitrator.policy).needs_surroundings;
}

void Arbitrator::Hear(const truth_t& truth) {
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
  return Choose(ego, track, automation, driver);
}

const arbitration_t& Arbitrator::Choose(const ego_t& ego, const track_t& track,
                                        const accel_command_t& automation,
                                        const driver_command_t& driver) {
  out_.header = ego.header;
  out_.conflict_m = meter_.conflict();
  out_.doc = meter_.DocOf(out_.conflict_m);
  const Wish wish = policy_->Decide({.doc = out_.doc,
                                     .threshold = threshold_,
                                     .lambda_human = out_.lambda_human,
                                     .ego = ego,
                                     .track = track,
                                     .automation = automation,
                                     .driver = driver,
                                     .surroundings = surroundings_});
  out_.threshold = wish.threshold;
  wanted_ = steady_.Step(wish, out_.doc);
  // What is wanted is granted at once: the paper's driver is always at it. One who must be asked
  // stands here, between the two.
  const double granted = wanted_;
  const Transfer::State state = transfer_.Step(
      granted, {automation.acceleration_mps2, driver.acceleration_mps2}, ego.acceleration_mps2);
  out_.lambda_human = state.lambda_human;
  out_.lambda_automation = 1 - state.lambda_human;
  out_.acceleration_mps2 = state.acceleration_mps2;
  // Who has more authority; the human where both have half.
  out_.mode = state.lambda_human < 0.5 ? arbitration_t::AUTOMATION : arbitration_t::HUMAN;
  return out_;
}

void Arbitrator::Overrule(const arbitration_t& sent) {
  out_.lambda_human = sent.lambda_human;
  transfer_.Overrule({sent.lambda_human, sent.acceleration_mps2});
}

}  // namespace fogline
