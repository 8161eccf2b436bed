// The process `radar`: measures the preceding car once per step. The process does not receive the
// LiDAR's values. It adds errors to the true distance and to the rate of this distance.
// services/runtime/process/service.h connects the process to its channels.
#include "services/radar/radar.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::radar::Radar>(argc, argv);
}
