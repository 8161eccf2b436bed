#include "tools/processes/run_viewer.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/process/console.h"
#include "tools/processes/child.h"

namespace fogline::processes {
namespace {

// fogline-web reads a long log before it listens.
constexpr Duration kPageLimit = milliseconds(10'000);
// fogline-web ends within this time after SIGTERM. After that it is killed.
constexpr Duration kFarewellLimit = milliseconds(2000);

/// The port in "http://127.0.0.1:7680/".
std::string PortOf(const std::string& address) {
  const std::size_t begin = address.rfind(':') + 1;
  return address.substr(begin, address.find('/', begin) - begin);
}

}  // namespace

RunViewer::~RunViewer() { End(); }

void RunViewer::ShowNetwork(const std::string& url) {
  std::vector<std::string> arguments{"--lcm-url", url};
  arguments.insert(arguments.end(), traffic_.begin(), traffic_.end());
  Start(arguments);
}

void RunViewer::ShowLog(const std::filesystem::path& log) {
  if (address_.empty() || !Runs()) return;
  End();
  Start({log.string(), "--no-browser", "--port", PortOf(address_)});
}

void RunViewer::Start(const std::vector<std::string>& more) {
  try {
    Pipe output;
    pid_ = StartChild(ProgramBeside("fogline-web"), more, output.write);
    close(std::exchange(output.write, -1));
    const std::string line = FirstLineOf(output.read, kPageLimit);
    if (line.empty()) throw std::runtime_error("fogline-web does not listen");
    if (line != std::exchange(address_, line)) Notice("view: " + line);
  } catch (const std::exception& error) {
    Say(error.what());
    End();
  }
}

void RunViewer::Say(const std::string& trouble) {
  if (std::exchange(said_, true)) return;
  Complain(fmt::format("fogline run: warning: --view: {}; the run goes on without it", trouble));
}

bool RunViewer::Runs() {
  int status = 0;
  if (pid_ >= 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    pid_ = -1;
    Say("fogline-web " + HowItEnded(status));
  }
  return pid_ >= 0;
}

void RunViewer::End() {
  if (pid_ < 0) return;
  kill(pid_, SIGTERM);
  const TimePoint end = Clock::now() + kFarewellLimit;
  while (waitpid(pid_, nullptr, WNOHANG) == 0) {
    if (Clock::now() > end) kill(pid_, SIGKILL);
    std::this_thread::sleep_for(milliseconds(5));
  }
  pid_ = -1;
}

}  // namespace fogline::processes
