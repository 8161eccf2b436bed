// The agent of `fogline host`: starts roles on this machine for a runner on another machine. The
// runner sends orders, which arrive on stdin.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fogline::hosts {

/// Returns the problems that this machine has with a network, each with its remedy if there is one.
using NetworkCheck = std::function<std::vector<std::string>(const std::string& url)>;

/// Does what the runner orders until stdin ends, the runner is silent for too long, or a signal
/// asks this process to end. Then kills all roles. If this process itself is killed, the kernel
/// kills the roles.
/// @throws NotUnderstood for a line of stdin that is not an order; std::runtime_error
void ServeRunner(const NetworkCheck& check);

}  // namespace fogline::hosts
