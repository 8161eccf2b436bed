// The following cars as a process: answers TRUTH with FOLLOWER_COMMAND. The following cars are
// traffic, not a part of the host's automation.
#include "services/follower/follower.h"
#include "services/runtime/process/service.h"

int main(int argc, char** argv) {
  return fogline::runtime::RunService<fogline::follower::Follower>(argc, argv);
}
