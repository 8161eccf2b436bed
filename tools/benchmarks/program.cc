#include "tools/benchmarks/program.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/core.h>

#include "common/process/programs.h"

namespace fogline::benchmarks {
namespace {

constexpr int kCannotStart = 127;

class Scratch {
 public:
  Scratch() {
    // The folder is in Testing/tmp, because tools/test removes old folders from there.
    const std::filesystem::path build = OwnFolder().parent_path();
    std::filesystem::create_directories(build / "Testing" / "tmp");
    std::string name = (build / "Testing" / "tmp" / "bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string ReadFile(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string LastLine(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

[[noreturn]] void Become(const std::vector<std::string>& command, const std::string& out,
                         const std::string& err) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  constexpr int kMode = 0600;
  dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode), STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments.front(), arguments.data());
  _exit(kCannotStart);
}

}  // namespace

std::string ProgramPath(const std::string& name) { return (OwnFolder() / name).string(); }

const std::filesystem::path& ScratchFolder() {
  static const Scratch scratch;
  return scratch.path();
}

ProgramResult RunProgram(const std::vector<std::string>& command) {
  const std::string out = ScratchFolder() / "stdout";
  const std::string err = ScratchFolder() / "stderr";
  int status = 0;
  rusage usage{};
  const double wall_s = SecondsOf([&] {
    const pid_t pid = fork();
    if (pid < 0) throw std::runtime_error("cannot start a process");
    if (pid == 0) Become(command, out, err);
    wait4(pid, &status, 0, &usage);
  });
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const bool absent = WIFEXITED(status) && WEXITSTATUS(status) == kCannotStart;
    throw std::runtime_error(
        absent ? fmt::format("{}: not installed", command.front())
               : fmt::format("{} failed: {}", command.front(), LastLine(ReadFile(err))));
  }
  constexpr double kKiB = 1024;
  return {.out = ReadFile(out),
          .wall_s = wall_s,
          .peak_memory_mb = kKiB * static_cast<double>(usage.ru_maxrss) * 1e-6};
}

}  // namespace fogline::benchmarks
