// The process that decides who drives the host (RADAR, LIDAR, ACC_COMMAND, DRIVER_COMMAND and more
// to HOST_COMMAND). What it sends is the only way by which the world is told how the host moves.
#include "services/arbitrator/arbitrator.h"
#include "services/arbitrator/failsafe_arbitrator.h"
#include "services/runtime/service.h"

int main(int argc, char** argv) {
  return fogline::RunService<fogline::Arbitrator, fogline::FailsafeArbitrator>(argc, argv);
}
