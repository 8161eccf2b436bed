// The process `radar`: measures the preceding car once per step. It does not receive the LiDAR's
// values, and uses the truth only to add errors to it. services/runtime/process/service.h connects
// the process to its channels.
#include "services/radar/radar.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::radar::Radar>(argc, argv);
}
