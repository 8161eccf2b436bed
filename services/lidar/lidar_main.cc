// The process `lidar`: measures the preceding car once a step, and in fog sometimes the fog. It
// never sees a radar; the wiring is in services/runtime/service.h.
#include "services/lidar/lidar.h"
#include "services/runtime/service.h"

int main(int argc, char** argv) { return fogline::RunService<fogline::Lidar>(argc, argv); }
