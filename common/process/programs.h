// Where programs are: the program of this process, and the programs of the shell.
#pragma once

#include <filesystem>
#include <string>

namespace fogline {

/// The folder of the program of this process, without links.
std::filesystem::path OwnFolder();

/// Whether this user may execute a file.
bool IsExecutable(const std::filesystem::path& file);

/// Searches the folders of $PATH in their order for a program of this name. Returns the path of the
/// first program found; "" if there is none. An empty entry of $PATH means the working folder of
/// the process.
std::filesystem::path FindProgram(const std::string& name);

}  // namespace fogline
