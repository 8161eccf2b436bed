// The process `lidar`: measures the distance of the preceding car once per step. In fog, the LiDAR
// may measure a distance that is too short, or the distance of the fog. The process does not
// receive the radar's values. services/runtime/process/service.h connects the process to its
// channels.
#include "services/lidar/lidar.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::lidar::Lidar>(argc, argv);
}
