// The part of `fogline host`: starts roles on this machine for a runner on another machine, which
// sends orders on stdin.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fogline::hosts {

/// What is wrong with the way from this machine to a network, and what to do about it.
using NetworkCheck = std::function<std::vector<std::string>(const std::string& url)>;

/// Does what the runner orders until stdin ends, the runner is silent for too long, or a signal
/// asks this process to end. Kills all roles then. The kernel kills them if this process is killed.
/// @throws NotUnderstood if stdin has something that is no order; std::runtime_error
void ServeRunner(const NetworkCheck& check);

}  // namespace fogline::hosts
