#include "common/process/programs.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <system_error>

namespace fogline {

std::filesystem::path OwnFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

bool IsExecutable(const std::filesystem::path& file) { return access(file.c_str(), X_OK) == 0; }

std::filesystem::path FindProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::filesystem::path program = std::filesystem::path(folder.empty() ? "." : folder) / name;
    std::error_code no_access;  // as a shell, skip a folder that this user may not search
    if (std::filesystem::is_regular_file(program, no_access) && IsExecutable(program)) {
      return program;
    }
  }
  return {};
}

}  // namespace fogline
