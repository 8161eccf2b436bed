// The program fogline-relay.
#pragma once

namespace fogline::relay {

/// Reads the command line, and relays messages until a signal comes.
/// @return the exit code: 0 stopped, 2 bad usage or a foreign address, 3 cannot listen
int RunProgram(int argc, char** argv);

}  // namespace fogline::relay
