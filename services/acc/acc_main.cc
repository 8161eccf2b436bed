// The automation agent as a process: answers HOST_EGO and TRACK with ACC_COMMAND. It does not know
// whether its command is used. The arbitrator decides this.
#include "services/acc/acc.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::acc::Acc>(argc, argv);
}
