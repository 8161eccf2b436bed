// The process that decides which side drives the host. The process reads HOST_EGO, RADAR, LIDAR,
// TRACK, ACC_COMMAND and DRIVER_COMMAND, and sends HOST_COMMAND. Only HOST_COMMAND tells the world
// how the host moves.
#include "services/arbitrator/arbitrator.h"
#include "services/arbitrator/failsafe_arbitrator.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::arbitrator::Arbitrator,
                                      fogline::arbitrator::FailsafeArbitrator>(argc, argv);
}
