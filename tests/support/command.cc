#include "tests/support/command.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace fogline::test {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Unsets LCM_DEFAULT_URL, which the shell that starts the tests may have set. Without this variable
// each run of a test has a port of its own. A test that needs the variable sets it.
[[maybe_unused]] const int kWithoutDefaultUrl = unsetenv("LCM_DEFAULT_URL");

/// Makes a new folder below Testing/tmp in the build folder. If a test is killed, its folder stays
/// there until tools/test removes it.
std::filesystem::path FreshFolder(const std::string& kind) {
  const auto scratch = std::filesystem::path(FOGLINE_BINARY_DIR) / "Testing" / "tmp";
  std::filesystem::create_directories(scratch);
  std::string name = (scratch / (kind + "-XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  return name;
}

}  // namespace

std::filesystem::path ProgramDirectory() {
  return std::filesystem::path(FOGLINE_BINARY_DIR) / "bin";
}
std::filesystem::path SourceDirectory() { return FOGLINE_SOURCE_DIR; }
std::string Program(const std::string& name) { return (ProgramDirectory() / name).string(); }

ScratchFolder::ScratchFolder() : path_(FreshFolder("test")) {}
ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Background::Background(const std::vector<std::string>& command) : directory_(FreshFolder("out")) {
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const std::string out = (directory_ / "out").string();
  const std::string err = (directory_ / "err").string();
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setpgid(0, 0);
    // A shell makes its background jobs ignore SIGINT, and a program inherits the ignored signals
    // from the process that starts it. So the default actions are restored here.
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
    if (chdir(FOGLINE_SOURCE_DIR) != 0) _exit(127);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  if (pid_ < 0) throw std::runtime_error("cannot start " + command.front());
}

Background::~Background() {
  if (!ended_) {
    kill(-pid_, SIGKILL);
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

void Background::Signal(int signal) const { kill(pid_, signal); }

int Background::Wait(std::chrono::seconds limit) {
  const auto end = SteadyClock::now() + limit;
  while (!ended_) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      ended_ = true;
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (SteadyClock::now() > end) {
      kill(-pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
      ended_ = true;
    } else {
      std::this_thread::sleep_for(kLookEvery);
    }
  }
  return status_;
}

std::string Background::Out() const { return Content(directory_ / "out"); }
std::string Background::Err() const { return Content(directory_ / "err"); }

bool Background::WaitForErr(const std::string& text, std::chrono::seconds limit) {
  return WaitFor(directory_ / "err", text, limit);
}
bool Background::WaitForOut(const std::string& text, std::chrono::seconds limit) {
  return WaitFor(directory_ / "out", text, limit);
}

bool Background::WaitFor(const std::filesystem::path& file, const std::string& text,
                         std::chrono::seconds limit) {
  const auto end = SteadyClock::now() + limit;
  while (true) {
    // Checks the process before the file. In the other order, the process could print the text and
    // end between the two checks, and the function would not find the text.
    const bool may_print_more = SteadyClock::now() <= end && IsAlive(pid_);
    if (Content(file).find(text) != std::string::npos) return true;
    if (!may_print_more) return false;
    std::this_thread::sleep_for(kLookEvery);
  }
}

Outcome RunUntilItPrints(const std::vector<std::string>& command,
                         const std::vector<std::string>& texts) {
  const auto end = SteadyClock::now() + kPatience;
  while (true) {
    Outcome outcome = RunCommand(command);
    const bool has_all = std::ranges::all_of(texts, [&outcome](const std::string& text) {
      return outcome.out.find(text) != std::string::npos;
    });
    if (has_all || SteadyClock::now() > end) return outcome;
  }
}

bool GrowsTo(std::uintmax_t bytes, const std::filesystem::path& file, std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < end) {
    std::error_code ignored;
    const std::uintmax_t size = std::filesystem::file_size(file, ignored);
    if (!ignored && size >= bytes) return true;
    std::this_thread::sleep_for(kLookEvery);
  }
  return false;
}

bool ComesToHave(const std::string& text, const std::filesystem::path& file,
                 std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < end) {
    if (Content(file).find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(kLookEvery);
  }
  return false;
}

std::string Content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Outcome RunCommand(const std::vector<std::string>& command, std::chrono::seconds limit) {
  Background process(command);
  const int code = process.Wait(limit);
  return {code, process.Out(), process.Err()};
}

bool IsAlive(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  if (!std::getline(stat, line)) return false;
  // The format is "pid (name) S ...": the state comes after the last parenthesis.
  const std::size_t end = line.rfind(')');
  return end != std::string::npos && end + 2 < line.size() && line[end + 2] != 'Z';
}

pid_t PidOf(const std::string& err, const std::string& role) {
  const std::size_t line = err.find("processes: ");
  const std::size_t at = err.find(" " + role + " ", line == std::string::npos ? 0 : line);
  return at == std::string::npos ? 0 : std::atoi(err.c_str() + at + role.size() + 2);
}

std::vector<std::string> WithoutMake(const ScratchFolder& folder) {
  const std::filesystem::path programs = folder.path() / "without-make";
  std::filesystem::create_directories(programs);
  std::ofstream(programs / "make") << "#!/bin/sh\necho 'there is no make' >&2\nexit 127\n";
  std::filesystem::permissions(programs / "make", std::filesystem::perms::owner_all);
  return {"env", "PATH=" + programs.string() + ":" + std::getenv("PATH")};
}

}  // namespace fogline::test
