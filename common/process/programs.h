// Where programs are: the program of this process, and the programs of the shell.
#pragma once

#include <filesystem>
#include <string>

namespace fogline {

/// The folder of the program of this process, without links.
std::filesystem::path OwnFolder();

/// Whether this user may execute a file.
bool IsExecutable(const std::filesystem::path& file);

/// Path of a program as the shell finds it; "" if it is not in $PATH.
std::filesystem::path FindProgram(const std::string& name);

}  // namespace fogline
