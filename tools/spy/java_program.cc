#include "tools/spy/java_program.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/process/programs.h"
#include "common/text.h"
#include "tools/spy/spy_parts.h"

namespace fogline::spy {
namespace {

namespace fs = std::filesystem;

/// Lets the Java program receive traffic that stays on this machine.
void PreloadHearLoopback() {
  const fs::path library = HearLoopback(OwnFolder());
  if (library.empty()) return;  // the program still receives traffic over other interfaces
  std::string preload = library.string();
  if (const char* others = std::getenv("LD_PRELOAD")) preload += fmt::format(":{}", others);
  setenv("LD_PRELOAD", preload.c_str(), 1);
}

}  // namespace

const fs::path& Named(const fs::path& file, std::string_view option) {
  if (access(file.c_str(), R_OK) == 0) return file;
  throw InputError(fmt::format("{}: error: {}: cannot be read: {}", PathText(file), option,
                               std::strerror(errno)));
}

fs::path RequireJava() {
  fs::path java = JavaProgram();
  if (java.empty()) throw std::runtime_error("there is no java: apt-get install default-jre");
  if (!OpensWindows(java)) {
    throw std::runtime_error(
        fmt::format("{} cannot open windows (default-jre-headless?): apt-get install default-jre",
                    PathText(java)));
  }
  return java;
}

void RequireScreen() {
  const char* display = std::getenv("DISPLAY");
  if (const std::string why = WhyNoScreen(display == nullptr ? "" : display); !why.empty()) {
    throw std::runtime_error("no screen: " + why);
  }
}

fs::path FindJar(const fs::path& jars, const std::string& name, const char* package) {
  if (!jars.empty()) return Named(jars / name, "--jars");
  fs::path jar = InstalledJar(name);
  if (!jar.empty()) return jar;
  throw std::runtime_error(
      fmt::format("there is no /usr/share/java/{}: apt-get install {}", name, package));
}

void BecomeJava(std::vector<std::string> command) {
  std::vector<char*> argv;
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  PreloadHearLoopback();
  execv(argv.front(), argv.data());
  throw std::runtime_error(
      fmt::format("{} cannot be started: {}", command.front(), std::strerror(errno)));
}

}  // namespace fogline::spy
