// The process `lidar`: measures the preceding car once per step, and in fog sometimes the fog. It
// does not receive the radar's values. services/runtime/process/service.h connects it to its
// channels.
#include "services/lidar/lidar.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::lidar::Lidar>(argc, argv);
}
