#include "tools/processes/relay_process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/clock.h"
#include "tools/processes/child.h"

namespace fogline::processes {
namespace {

constexpr Duration kListenLimit = milliseconds(5000);

}  // namespace

RelayProcess::RelayProcess(int restarts, const std::string& place)
    : policy_(restarts), url_(Start(place)) {}

RelayProcess::~RelayProcess() { End(); }

std::string RelayProcess::Start(const std::string& place) {
  const std::filesystem::path program = BuiltProgramBeside("fogline-relay");
  Pipe output;
  // The relay prints on the runner's stderr which clients it disconnects.
  pid_ = StartChild(program, {"--listen", place, "--quiet"}, output.write);
  close(std::exchange(output.write, -1));
  std::string url = FirstLineOf(output.read, kListenLimit);
  if (!url.empty()) return url;
  End();
  throw std::runtime_error(fmt::format("cannot start {}: it does not listen", program.string()));
}

void RelayProcess::End() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);  // the relay has no data to save
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

std::string RelayProcess::Look(const runtime::RunCoordinator& run, TimePoint now) {
  int status = 0;
  if (pid_ >= 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    dead_ = std::exchange(pid_, -1);
    death_ = fmt::format("{} {}", HowItEnded(status), run.Where());
    const auto wait = policy_.OnDeath(run.step());
    if (!wait) {
      throw std::runtime_error(fmt::format("relay (pid {}) {}, after {} restarts (--restarts)",
                                           dead_, death_, policy_.restarts()));
    }
    start_at_ = now + *wait;
  }
  if (!start_at_ || now < *start_at_) return "";
  try {
    Start(url_.substr(url_.find("//") + 2));  // the address at which clients look for the relay
  } catch (const std::runtime_error&) {
    start_at_ = now + policy_.OnFailedStart();
    return "";
  }
  start_at_.reset();
  return fmt::format("relay (pid {}) {}; started again as pid {} ({} of {})", dead_, death_, pid_,
                     policy_.restarts(), policy_.limit());
}

}  // namespace fogline::processes
