// The process that fuses radar and LiDAR into a track of the car ahead. The process reads RADAR,
// LIDAR and HOST_EGO, and sends TRACK. The process does not know whether there is fog.
#include "services/fusion/fusion.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::fusion::Fusion>(argc, argv);
}
