#include "tools/fogline/child.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>

#include <fmt/core.h>

namespace fogline {

void BecomeChild(pid_t parent, int output) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  setpgid(0, 0);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  // LCM's sockets and pipes are not marked to be closed. A kernel before 5.11 leaves them open.
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
}

std::filesystem::path ProgramBeside(std::string_view name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

std::filesystem::path ProgramOf(Role role) {
  return ProgramBeside(fmt::format("fogline-{}", NameOf(role)));
}

}  // namespace fogline
