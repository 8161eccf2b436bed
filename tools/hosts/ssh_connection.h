// A connection by ssh to `fogline host` on another machine. The program ssh is a child process of
// this program. The destructor ends ssh. When the connection ends, `fogline host` ends its
// processes.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "tools/hosts/json_lines.h"
#include "tools/hosts/run_plan.h"
#include "tools/processes/child.h"
#include "tools/processes/last_lines.h"

namespace fogline::hosts {

class SshConnection {
 public:
  /// Starts ssh. Does not wait for the other machine.
  /// @param ssh the command that starts ssh, with its options; a shell executes this text
  /// @throws std::runtime_error
  SshConnection(const HostPlan& host, const std::string& ssh);
  ~SshConnection();
  SshConnection(const SshConnection&) = delete;
  SshConnection& operator=(const SshConnection&) = delete;

  JsonLines& lines() { return *lines_; }
  /// Reads the output of ssh and `fogline host` on stderr, and checks whether ssh has ended.
  void Look();
  /// Whether ssh runs.
  bool open() const { return pid_ >= 0; }
  /// Keeps a line of stdout that is not a message, such as a line that the shell of the other
  /// machine prints at its start.
  void Keep(const std::string& line) { printed_.Append(line + "\n"); }

  /// The last lines that ssh and `fogline host` have printed on stderr, and the lines of Keep().
  std::vector<std::string> TakeLines() { return printed_.Take(); }
  /// One line that says how the connection ended, with a remedy for the user if one is known.
  /// @pre not open()
  /// @param lines the last lines that were printed
  std::string HowItEnded(const std::vector<std::string>& lines) const;
  /// Closes the connection, and kills ssh if it does not end within `limit`.
  void End(Duration limit);

 private:
  HostPlan host_;
  std::string ssh_;
  processes::Pipe errors_;
  int socket_ = -1;  // the runner's end of the socket pair for ssh's stdin and stdout
  std::optional<JsonLines> lines_;
  processes::LastLines printed_;
  pid_t pid_ = -1;
  int status_ = 0;
};

}  // namespace fogline::hosts
