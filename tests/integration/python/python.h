// Programs in Python that use the package fogline_lab of this build.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

/// Whether the package can run a role. For this the package needs its extension module.
inline bool PythonRunsRoles() {
  const auto package = std::filesystem::path(FOGLINE_BINARY_DIR) / "python/fogline_lab";
  if (!std::filesystem::exists(package)) return false;
  for (const auto& entry : std::filesystem::directory_iterator(package)) {
    if (entry.path().filename().string().starts_with("_runtime.")) return true;
  }
  return false;
}

/// The command line of a program in Python.
inline std::vector<std::string> Python(const std::string& script,
                                       const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"env",
                                   std::string("PYTHONPATH=") + FOGLINE_BINARY_DIR + "/python",
                                   "/usr/bin/python3",
                                   "-B",
                                   "-u",
                                   script};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

/// Writes a script into a folder. @return its path
inline std::string WriteScript(const ScratchFolder& folder, const std::string& text) {
  const std::string file = folder.File("script.py");
  std::ofstream(file) << text;
  return file;
}

}  // namespace fogline::test
