// Other programs of Fogline, started as processes that belong to this one.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "services/graph.h"

namespace fogline {

/// Starts a program of Fogline. It dies with the runner, however that dies; it is out of reach of
/// the terminal's Ctrl-C, which the runner turns into an orderly end; it reads nothing, prints to
/// `output`, and has no other file of the runner but stderr.
/// @param error_output where its stderr goes; -1: to that of the runner
/// @return its process id @throws std::runtime_error if the system will not start it: for now, if
///     it is short of processes or the program is being replaced
pid_t StartChild(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 int output, int error_output = -1);

/// A pipe whose ends no child inherits. It closes those that are not -1.
struct Pipe {
  /// @throws std::runtime_error
  Pipe();
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int read = -1;
  int write = -1;
};

/// How a process has ended, by the status that waitpid() gives.
std::string HowItEnded(int status);

/// The program of this name in the folder of the running one.
std::filesystem::path ProgramBeside(std::string_view name);
/// The program of a role there.
std::filesystem::path ProgramOf(Role role);

}  // namespace fogline
