// Finds the parts of LCM's lcm-spy on this machine: a Java that can open windows, a screen for the
// windows, LCM's jars, the jar of Fogline's message types, and the library that lets Java receive
// traffic over loopback.
#pragma once

#include <filesystem>
#include <string>

namespace fogline::spy {

/// The Java of JAVA_HOME, or the shell's Java if JAVA_HOME is not set; "" if there is no Java.
std::filesystem::path JavaProgram();

/// Whether a Java can open windows. The Java of Debian's headless packages cannot open windows.
bool OpensWindows(const std::filesystem::path& java);

/// The reason why a window cannot be opened on a screen; "" if no reason was found. The screen of
/// another machine is not tested, because the test can take long.
/// @param display the value of DISPLAY, such as ":0"
std::string WhyNoScreen(const std::string& display);

/// The path of a jar in the folders of Debian or of LCM's own installation; "" if it is not there.
std::filesystem::path InstalledJar(const std::string& name);

/// The jar of the message types in the build or installation of a program; "" if there is none.
/// @param programs folder of the program
std::filesystem::path TypesJar(const std::filesystem::path& programs);

/// The library (hear_loopback.c) that lets a Java program receive traffic that stays on this
/// machine; "" if the build or installation of a program has none.
/// @param programs folder of the program
std::filesystem::path HearLoopback(const std::filesystem::path& programs);

}  // namespace fogline::spy
