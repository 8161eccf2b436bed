// The program fogline-web as a child.
#pragma once

#include <sys/types.h>

#include <string>

namespace fogline::processes {

/// The port in the address of a page, such as "7680" in "http://127.0.0.1:7680/". "0", which means
/// any free port, without an address.
std::string PortOf(const std::string& address);

/// Ends fogline-web with SIGTERM, and returns when it has ended. After 2 s it is killed.
/// @param pid is then -1; if it is -1 before, nothing happens
void EndWeb(pid_t& pid);

}  // namespace fogline::processes
