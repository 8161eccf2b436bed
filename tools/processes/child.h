// Starts other programs of Fogline as child processes.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"

namespace fogline::processes {

/// Starts a program of Fogline as a child. The kernel kills the child when the runner ends. The
/// terminal's Ctrl-C does not reach the child; the runner turns Ctrl-C into an orderly end. The
/// child's stdout is `output`. Of the runner's open files, the child inherits only stderr.
/// @param error_output the child's stderr; -1: the runner's stderr
/// @param input the child's stdin; -1: /dev/null
/// @return the child's process id @throws std::runtime_error if the system cannot start the child.
///     The reason may be temporary: the system is short of processes, or the program is being
///     replaced
pid_t StartChild(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 int output, int error_output = -1, int input = -1);

/// A pipe. A child inherits an end only if StartChild() makes this end its stdin, stdout or stderr.
/// The destructor closes the ends that are not -1.
struct Pipe {
  /// @throws std::runtime_error
  Pipe();
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int read = -1;
  int write = -1;
};

/// Reads the lines that a child prints, without their line feeds. Lines that have come are kept,
/// even if Has() returns false.
class LineReader {
 public:
  /// @param output the read end of the pipe that is the child's stdout
  explicit LineReader(int output) : output_(output) {}

  /// Waits until `count` lines have come, at most for `limit`. Reads the content of the pipe even
  /// if `limit` is 0.
  /// @return false if fewer lines have come when the limit is over, or when the child closes its
  ///     stdout
  bool Has(std::size_t count, Duration limit);
  const std::vector<std::string>& lines() const { return lines_; }
  /// Whether the child has closed its stdout. The system closes it when the child ends.
  bool ended() const { return ended_; }

 private:
  void Take(std::string_view bytes);

  int output_;
  std::vector<std::string> lines_;
  std::string begun_;  // a line without its end
  bool ended_ = false;
};

/// The first `count` lines that a child prints, without their line feeds; fewer lines if the child
/// ends or is too slow.
/// @param output the read end of the pipe that is the child's stdout
std::vector<std::string> LinesOf(int output, std::size_t count, Duration limit);

/// The first line that a child prints, without its line feed; "" if none comes in time.
/// @param output the read end of the pipe that is the child's stdout
std::string FirstLineOf(int output, Duration limit);

/// Ends a child with SIGTERM, and returns when it has ended. A child that needs longer than `limit`
/// is killed. Does nothing if `pid` is 0 or less, which means that there is no process.
void EndChild(pid_t pid, Duration limit);

/// How a process ended, from the status of waitpid().
std::string HowItEnded(int status);

/// The program of this name in the folder of the running program.
std::filesystem::path ProgramBeside(std::string_view name);
/// The build folder of the running program, as seen from the working folder and quoted for a shell;
/// "" if the program is not in a build folder.
std::string BuildFolder();
/// The command that builds a target of CMake; "" if the running program is not in a build folder.
std::string BuildCommand(std::string_view target);
/// The end of an error text about a missing program that not every build has. It names the command
/// that builds the program. It is "" if the running program is not in a build folder.
std::string HowToBuild(std::string_view name);
/// The same as ProgramBeside(), but for a program that not every build has.
/// @throws std::runtime_error if the program is missing. The error names the command that builds
///     the program.
std::filesystem::path BuiltProgramBeside(std::string_view name);
/// The program of a role in the folder of the running program.
std::filesystem::path ProgramOf(Role role);

}  // namespace fogline::processes
