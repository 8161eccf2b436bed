// The program fogline-relay.
#pragma once

namespace fogline::relay {

/// Reads the command line, and relays messages until a signal comes.
/// @return the exit code. 0: stopped by a signal. 2: bad usage, an address of another machine, or a
///     port on which the relay cannot listen. 3: any other error
int RunProgram(int argc, char** argv);

}  // namespace fogline::relay
