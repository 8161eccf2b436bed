#include "tools/spy/spy_parts.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>

namespace fogline::spy {
namespace {

namespace fs = std::filesystem;

bool Readable(const fs::path& file) { return access(file.c_str(), R_OK) == 0; }

}  // namespace

bool IsExecutable(const fs::path& file) { return access(file.c_str(), X_OK) == 0; }

fs::path InPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (const fs::path file = fs::path(folder) / program; IsExecutable(file)) return file;
  }
  return {};
}

fs::path JavaProgram() {
  const char* home = std::getenv("JAVA_HOME");
  if (home == nullptr || *home == '\0') return InPath("java");
  const fs::path java = fs::path(home) / "bin/java";
  return IsExecutable(java) ? java : fs::path();
}

bool OpensWindows(const fs::path& java) {
  std::error_code error;
  const fs::path real = fs::canonical(java, error);
  return fs::exists(real.parent_path() / "../lib/libawt_xawt.so", error);
}

fs::path InstalledJar(const std::string& name) {
  for (const char* folder : {"/usr/share/java", "/usr/local/share/java"}) {
    if (const fs::path jar = fs::path(folder) / name; Readable(jar)) return jar;
  }
  return {};
}

fs::path TypesJar(const fs::path& programs) {
  for (const char* place : {"../lib", "../share/java"}) {
    const fs::path jar = (programs / place / "fogline_lcmtypes.jar").lexically_normal();
    if (Readable(jar)) return jar;
  }
  return {};
}

fs::path HearLoopback(const fs::path& programs) {
  const fs::path library = (programs / "../lib/libfogline_hear_loopback.so").lexically_normal();
  return Readable(library) ? library : fs::path();
}

}  // namespace fogline::spy
