#include "tools/spy/spy_parts.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fmt/core.h>

#include "common/process/programs.h"
#include "common/text.h"

namespace fogline::spy {
namespace {

namespace fs = std::filesystem;

bool Readable(const fs::path& file) { return access(file.c_str(), R_OK) == 0; }

/// Connects to a socket of this machine, and closes the connection. @param name the name of a file,
/// or an abstract name after a zero byte. @return 0 if the connection succeeds, otherwise errno
int TryToConnect(std::string_view name) {
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  if (name.size() >= sizeof(address.sun_path)) return ENAMETOOLONG;
  std::ranges::copy(name, address.sun_path);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return errno;
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  const int error = connect(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0 ? 0 : errno;
  close(fd);
  return error;
}

}  // namespace

fs::path JavaProgram() {
  const char* home = std::getenv("JAVA_HOME");
  if (home == nullptr || *home == '\0') return FindProgram("java");
  const fs::path java = fs::path(home) / "bin/java";
  return IsExecutable(java) ? java : fs::path();
}

bool OpensWindows(const fs::path& java) {
  std::error_code error;
  const fs::path real = fs::canonical(java, error);
  return fs::exists(real.parent_path() / "../lib/libawt_xawt.so", error);
}

std::string WhyNoScreen(const std::string& display) {
  if (display.empty()) return "DISPLAY is not set (over ssh: ssh -X)";
  const std::size_t colon = display.find(':');
  const std::string host = display.substr(0, colon);
  if (colon == std::string::npos || !(host.empty() || host == "unix")) return "";
  // DISPLAY is HOST:SERVER.SCREEN. A server of this machine listens at the socket file `file`, and
  // at the abstract socket with the same name (X(7)).
  const std::string server = display.substr(colon + 1, display.find('.', colon) - colon - 1);
  const std::string file = "/tmp/.X11-unix/X" + server;
  if (TryToConnect(std::string(1, '\0') + file) == 0) return "";
  const int error = TryToConnect(file);
  return error == 0 ? "" : fmt::format("DISPLAY is {}: {}", Quote(display), std::strerror(error));
}

fs::path InstalledJar(const std::string& name) {
  for (const char* folder : {"/usr/share/java", "/usr/local/share/java"}) {
    if (const fs::path jar = fs::path(folder) / name; Readable(jar)) return jar;
  }
  return {};
}

fs::path TypesJar(const fs::path& programs) {
  for (const char* place : {"../lib", "../share/fogline"}) {
    const fs::path jar = (programs / place / "fogline_lcmtypes.jar").lexically_normal();
    if (Readable(jar)) return jar;
  }
  return {};
}

fs::path HearLoopback(const fs::path& programs) {
  for (const char* place : {"../lib", "../lib/fogline"}) {
    const fs::path library = (programs / place / "libfogline_hear_loopback.so").lexically_normal();
    if (Readable(library)) return library;
  }
  return {};
}

}  // namespace fogline::spy
