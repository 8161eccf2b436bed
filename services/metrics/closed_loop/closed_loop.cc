#include "services/metrics/closed_loop/closed_loop.h"

namespace fogline {

ClosedLoop::ClosedLoop(const Scenario& scenario)
    : demands_(scenario),
      world_(scenario),
      radar_(scenario),
      lidar_(scenario),
      fusion_(scenario),
      acc_(scenario),
      driver_(scenario),
      arbitrator_(scenario),
      follower_(scenario) {}

void ClosedLoop::Restart(const Scenario& scenario) {
  demands_ = UsesOptionalInput(scenario);
  acc_.Restart(scenario);
  follower_.Restart(scenario);
  world_ = World(scenario);
  radar_ = Radar(scenario);
  lidar_ = Lidar(scenario);
  fusion_ = Fusion(scenario);
  driver_ = Driver(scenario);
  arbitrator_ = Arbitrator(scenario);
}

}  // namespace fogline
