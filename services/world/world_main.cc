// The process `world`: moves the cars and starts every step. Other processes decide how the host
// and the following cars drive. services/runtime/process/service.h connects the process to its
// channels.
#include "services/runtime/process/service.h"
#include "services/world/failsafe_world.h"
#include "services/world/world.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::world::World, fogline::world::FailsafeWorld>(argc,
                                                                                            argv);
}
