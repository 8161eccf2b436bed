#include "services/driver/driver.h"

namespace fogline {

Driver::Driver(const Scenario& scenario) : idm_(scenario.driver) {
  out_.readiness = scenario.driver.readiness;
}

const driver_command_t& Driver::Step(const truth_t& truth) {
  out_.header = truth.header;
  out_.acceleration_mps2 =
      idm_.Acceleration(truth.host_speed_mps, truth.preceding_speed_mps, truth.host_gap_m);
  return out_;
}

}  // namespace fogline
