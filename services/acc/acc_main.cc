// The automation agent as a process: answers HOST_EGO and TRACK with ACC_COMMAND. The arbitrator
// decides whether to use this command.
#include "services/acc/acc.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::acc::Acc>(argc, argv);
}
