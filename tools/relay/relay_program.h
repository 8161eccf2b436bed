// The program fogline-relay.
#pragma once

namespace fogline::relay {

/// Reads the command line, and relays messages until a signal comes.
/// @return the exit code: 0 stopped, 2 bad usage, a foreign address, or a port that it cannot have;
/// 3 any other error
int RunProgram(int argc, char** argv);

}  // namespace fogline::relay
