// What a process does before it becomes another program of Fogline.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string_view>

#include "services/graph.h"

namespace fogline {

/// To be called in the child, between fork and exec: only async-signal-safe calls. The child dies
/// with the runner, however that dies; it is out of reach of the terminal's Ctrl-C, which the
/// runner turns into an orderly end; it reads nothing, prints to `output`, and has no other file of
/// the runner but stderr.
/// @param parent process id of the runner before the fork
void BecomeChild(pid_t parent, int output);

/// The program of this name in the folder of the running one.
std::filesystem::path ProgramBeside(std::string_view name);
/// The program of a role there.
std::filesystem::path ProgramOf(Role role);

}  // namespace fogline
