// LCM's own viewers, lcm-spy and lcm-logplayer-gui. Both are Java programs of lcm.jar. Debian's
// scripts in /usr/bin cannot start these programs, because the scripts pass an option that Java
// removed in version 14.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fogline::spy {

/// Returns `file`, which the command line names with `option`.
/// @throws InputError if the file cannot be read
const std::filesystem::path& Named(const std::filesystem::path& file, std::string_view option);

/// A Java that can open windows. @throws std::runtime_error that names the missing package
std::filesystem::path RequireJava();

/// @throws std::runtime_error if there is no screen
void RequireScreen();

/// A jar in the folder of --jars, or in the system's folders if `jars` is "".
/// @param package the Debian package that has the jar
/// @throws InputError, std::runtime_error that names the missing package
std::filesystem::path FindJar(const std::filesystem::path& jars, const std::string& name,
                              const char* package);

/// Replaces this process by the Java program. A preloaded library lets the program also receive
/// traffic that stays on this machine.
/// @throws std::runtime_error if the program cannot be started
[[noreturn]] void BecomeJava(std::vector<std::string> command);

}  // namespace fogline::spy
