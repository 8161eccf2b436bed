// Where programs are: the program of this process, and the programs of the shell.
#pragma once

#include <filesystem>
#include <string>

namespace fogline {

/// The folder of the program of this process, without links.
std::filesystem::path OwnFolder();

/// Whether this user may execute a file.
bool IsExecutable(const std::filesystem::path& file);

/// Path of a program in the folders of $PATH, the first one first; "" if none has it. An empty
/// folder is the folder of the process.
std::filesystem::path FindProgram(const std::string& name);

}  // namespace fogline
