#include "services/acc/acc.h"

namespace fogline::acc {

Acc::Acc(const Scenario& scenario)
    : controller_(scenario.acc, scenario.step_s, scenario.host_vehicle.model),
      max_track_variance_m2_(scenario.acc.max_track_std_m * scenario.acc.max_track_std_m) {}

void Acc::Restart(const Scenario& scenario) {
  controller_.Restart(scenario.acc, scenario.step_s, scenario.host_vehicle.model);
  max_track_variance_m2_ = scenario.acc.max_track_std_m * scenario.acc.max_track_std_m;
}

const accel_command_t& Acc::Step(const ego_t& ego, const track_t& track) {
  const AccController::Output output = controller_.Step({
      .distance_m = track.state[0],
      .relative_speed_mps = track.state[1],
      .speed_mps = ego.speed_mps,
      .acceleration_mps2 = ego.acceleration_mps2,
      .has_target = track.valid != 0 && track.covariance[0][0] <= max_track_variance_m2_,
  });
  out_.header = ego.header;
  out_.acceleration_mps2 = output.acceleration_mps2;
  out_.control = output.control;
  out_.safe_distance_m = output.safe_distance_m;
  out_.solver = static_cast<std::int8_t>(output.solver);
  out_.iterations = output.iterations;
  return out_;
}

}  // namespace fogline::acc
