#include "tools/web/browser.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include "common/process/programs.h"

namespace fogline::web {
namespace {

constexpr const char* kOpener = "xdg-open";

bool IsSet(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// Replaces this process by the program that opens the browser. This process is a child of the
/// child of fogline-web. This function makes only async-signal-safe calls.
[[noreturn]] void Become(const char* program, char* const* arguments) {
  setsid();  // Ctrl-C in the terminal does not reach the browser
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, standard);
  close_range(STDERR_FILENO + 1, ~0U, 0);
  execv(program, arguments);
  _exit(127);
}

}  // namespace

bool HasBrowser() {
  return (IsSet("DISPLAY") || IsSet("WAYLAND_DISPLAY")) && !FindProgram(kOpener).empty();
}

void OpenBrowser(const std::string& url) {
  std::string program = FindProgram(kOpener).string();
  std::string address = url;
  const std::array<char*, 3> arguments{program.data(), address.data(), nullptr};
  const pid_t child = fork();
  if (child == 0) {
    // The browser becomes a child of init, so this program does not wait for the browser's end.
    if (fork() == 0) Become(program.c_str(), arguments.data());
    _exit(0);
  }
  if (child > 0) waitpid(child, nullptr, 0);
}

}  // namespace fogline::web
