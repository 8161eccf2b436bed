// The process `radar`: measures the preceding car once a step. It never sees a LiDAR, and knows
// the truth only to spoil it; the wiring is in services/runtime/service.h.
#include "services/radar/radar.h"
#include "services/runtime/service.h"

int main(int argc, char** argv) { return fogline::RunService<fogline::Radar>(argc, argv); }
