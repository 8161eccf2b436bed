#include "services/closed_loop/closed_loop.h"

namespace fogline::closed_loop {

ClosedLoop::ClosedLoop(const Scenario& scenario)
    : person_(scenario.person.drives),
      on_demand_(scenario),
      world_(scenario),
      radar_(scenario),
      lidar_(scenario),
      fusion_(scenario),
      acc_(scenario),
      driver_(scenario),
      arbitrator_(scenario),
      follower_(scenario) {}

void ClosedLoop::Restart(const Scenario& scenario) {
  person_ = scenario.person.drives;
  on_demand_ = OnDemandRoles(scenario);
  acc_.Restart(scenario);
  follower_.Restart(scenario);
  world_ = world::World(scenario);
  radar_ = radar::Radar(scenario);
  lidar_ = lidar::Lidar(scenario);
  fusion_ = fusion::Fusion(scenario);
  driver_ = driver::Driver(scenario);
  arbitrator_ = arbitrator::Arbitrator(scenario);
}

}  // namespace fogline::closed_loop
