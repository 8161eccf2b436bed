#include "services/closed_loop/closed_loop.h"

namespace fogline {

ClosedLoop::ClosedLoop(const Scenario& scenario)
    : world_(scenario),
      radar_(scenario),
      lidar_(scenario),
      fusion_(scenario),
      acc_(scenario),
      driver_(scenario),
      arbitrator_(scenario),
      follower_(scenario) {}

}  // namespace fogline
