#include "tools/processes/run_viewer.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/poll.h"
#include "tools/processes/web_child.h"

namespace fogline::processes {
namespace {

// fogline-web listens after about 50 ms. A run waits so long for it, and no longer if it hangs.
constexpr Duration kPageLimit = milliseconds(1000);
// fogline-web reads a long log before it listens. The run is over then.
constexpr Duration kLogLimit = milliseconds(10'000);
constexpr Duration kLookEvery = milliseconds(50);  // whether to go on waiting

}  // namespace

RunViewer::~RunViewer() {
  late_ = {};
  End();
}

void RunViewer::ShowNetwork(const std::string& url) {
  std::vector<std::string> arguments{"--lcm-url", url};
  arguments.insert(arguments.end(), traffic_.begin(), traffic_.end());
  if (!Start(arguments) || TakeAddress(kPageLimit) || !Runs()) return;
  Complain(
      fmt::format("fogline run: warning: --view: fogline-web does not listen after {} s; the "
                  "run does not wait for it",
                  Seconds(kPageLimit)));
  TakeAddressLater();
}

void RunViewer::ShowLog(const std::filesystem::path& log) {
  if (late_.joinable()) {
    late_.request_stop();
    late_.join();
    if (address_.empty()) TakeAddress(kPageLimit);
  }
  if (!Runs()) return;
  const bool shown = !address_.empty();
  End();
  if (!shown) return Say("fogline-web does not listen");
  if (!Start({log.string(), "--no-browser", "--port", PortOf(address_)})) return;
  if (TakeAddress(kLogLimit) || WasInterrupted() || !Runs()) return;
  Say("fogline-web does not listen");
  End();
}

bool RunViewer::Start(const std::vector<std::string>& more) {
  try {
    output_.emplace();
    pid_ = StartChild(ProgramBeside("fogline-web"), more, output_->write);
    close(std::exchange(output_->write, -1));
    return true;
  } catch (const std::exception& error) {
    Say(error.what());
    return false;
  }
}

bool RunViewer::TakeAddress(Duration limit) {
  const TimePoint end = Clock::now() + limit;
  while (Clock::now() < end && !WasInterrupted()) {
    if (PollFor(output_->read, POLLIN, std::min(kLookEvery, end - Clock::now())) <= 0) continue;
    const std::string line = FirstLineOf(output_->read, end - Clock::now());
    if (!line.empty() && line != std::exchange(address_, line)) Notice("view: " + line);
    return !line.empty();
  }
  return false;
}

/// Another thread waits for the address, because the thread of the run must not wait for it.
void RunViewer::TakeAddressLater() {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // signals are for the thread of the run
  late_ = std::jthread([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (PollFor(output_->read, POLLIN, kLookEvery) <= 0) continue;
      TakeAddress(kPageLimit);
      return;
    }
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
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

void RunViewer::End() { EndWeb(pid_); }

}  // namespace fogline::processes
