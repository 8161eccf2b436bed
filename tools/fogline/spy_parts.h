// What LCM's lcm-spy is made of on this machine: a Java that opens windows, LCM's jars, the jar of
// our message types, and what lets Java hear loopback.
#pragma once

#include <filesystem>
#include <string>

namespace fogline {

/// A program where the shell would find it, "" if nowhere.
std::filesystem::path InPath(const std::string& program);

/// JAVA_HOME's Java, the shell's without JAVA_HOME; "" if there is none.
std::filesystem::path JavaProgram();

/// Whether a Java can open windows; the headless package has everything else.
bool OpensWindows(const std::filesystem::path& java);

/// A jar in the folders where Debian, and LCM's own installation, put jars; "" if it is in neither.
std::filesystem::path InstalledJar(const std::string& name);

/// The jar of the message types, of the build or the installation that a program belongs to; "" if
/// there is none.
/// @param programs folder of the program
std::filesystem::path TypesJar(const std::filesystem::path& programs);

/// What lets a Java program hear a run that stays on this machine (tools/spy), of the build or the
/// installation that a program belongs to; "" if there is none.
std::filesystem::path HearLoopback(const std::filesystem::path& programs);

}  // namespace fogline
