// The process `world`: moves the cars and starts every step. It decides nothing about how they
// drive; the wiring is in services/runtime/service.h.
#include "services/runtime/service.h"
#include "services/world/failsafe_world.h"
#include "services/world/world.h"

int main(int argc, char** argv) {
  return fogline::RunService<fogline::World, fogline::FailsafeWorld>(argc, argv);
}
