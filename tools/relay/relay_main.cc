// fogline-relay: carries LCM's messages over TCP where multicast is blocked. It does not know
// Fogline's messages or runs.
#include "tools/relay/relay_program.h"

int main(int argc, char** argv) { return fogline::relay::RunProgram(argc, argv); }
