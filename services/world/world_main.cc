// The process `world`: moves the cars and starts every step. Other processes decide how the host
// and the following cars drive. services/runtime/service.h connects it to its channels.
#include "services/runtime/service.h"
#include "services/world/failsafe_world.h"
#include "services/world/world.h"

int main(int argc, char** argv) {
  return fogline::RunService<fogline::World, fogline::FailsafeWorld>(argc, argv);
}
