// Finds the parts of LCM's lcm-spy on this machine: a Java that can open windows, a screen for
// them, LCM's jars, the jar of Fogline's message types, and the library that lets Java hear
// loopback.
#pragma once

#include <filesystem>
#include <string>

namespace fogline::spy {

/// Whether this user may execute a file.
bool IsExecutable(const std::filesystem::path& file);

/// Path of a program as the shell finds it; "" if it is not in PATH.
std::filesystem::path InPath(const std::string& program);

/// The Java of JAVA_HOME, or the shell's Java if JAVA_HOME is not set; "" if there is none.
std::filesystem::path JavaProgram();

/// Whether a Java can open windows. The headless package cannot.
bool OpensWindows(const std::filesystem::path& java);

/// Why no window can be opened on a screen; "" if nothing speaks against it. A screen of another
/// machine is not tried, because that can take long.
/// @param display the value of DISPLAY, such as ":0"
std::string WhyNoScreen(const std::string& display);

/// A jar in the folders of Debian or of LCM's own installation; "" if there is none.
std::filesystem::path InstalledJar(const std::string& name);

/// The jar of the message types that belongs to a program, in its build or installation; "" if
/// there is none.
/// @param programs folder of the program
std::filesystem::path TypesJar(const std::filesystem::path& programs);

/// The library that lets a Java program hear a run that stays on this machine (tools/spy), from the
/// program's build or installation; "" if there is none.
std::filesystem::path HearLoopback(const std::filesystem::path& programs);

}  // namespace fogline::spy
