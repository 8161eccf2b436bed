#include "tools/trials/desk/run_page.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"
namespace fogline::trials {
namespace {

// fogline-web listens within this time, even on a busy machine.
constexpr Duration kPageLimit = milliseconds(10'000);
// fogline-web ends within this time after SIGTERM. After that it is killed.
constexpr Duration kFarewellLimit = milliseconds(2000);
// A fogline-web that dies at once is started so often: twice in a second.
constexpr Duration kRestartEvery = milliseconds(500);

/// The port in "http://127.0.0.1:7680/"; "0" without an address.
std::string PortOf(const std::string& address) {
  if (address.empty()) return "0";
  const std::size_t begin = address.rfind(':') + 1;
  return address.substr(begin, address.find('/', begin) - begin);
}

}  // namespace

RunPage::~RunPage() { End(); }

const std::string& RunPage::Show(const std::string& url) {
  End();
  url_ = url;
  Start(true);
  return address_;
}

/// @param wait whether to wait until it listens. A run that is under way must not wait
void RunPage::Start(bool wait) {
  start_at_ = Clock::now() + kRestartEvery;
  try {
    std::vector<std::string> arguments{"--lcm-url", url_, "--no-browser", "--port",
                                       PortOf(address_)};
    arguments.insert(arguments.end(), traffic_.begin(), traffic_.end());
    output_.emplace();
    pid_ =
        processes::StartChild(processes::ProgramBeside("fogline-web"), arguments, output_->write);
    close(std::exchange(output_->write, -1));
    if (!wait) return;
    const std::string line = processes::FirstLineOf(output_->read, kPageLimit);
    if (line.empty()) throw std::runtime_error("fogline-web does not listen");
    address_ = line;
  } catch (const std::exception& error) {
    Complain(fmt::format("fogline experiment: warning: {}; the run goes on without its view",
                         error.what()));
    Stop();
  }
}

bool RunPage::Look() {
  int status = 0;
  const bool died = pid_ >= 0 && waitpid(pid_, &status, WNOHANG) == pid_;
  if (died) {
    Complain(fmt::format("fogline experiment: fogline-web {}; it is started again",
                         processes::HowItEnded(status)));
    pid_ = -1;
  }
  if (pid_ < 0 && !url_.empty() && Clock::now() >= start_at_) Start(false);
  return died;
}

void RunPage::End() {
  Stop();
  url_.clear();
}

void RunPage::Stop() {
  if (pid_ < 0) return;
  kill(pid_, SIGTERM);
  const TimePoint end = Clock::now() + kFarewellLimit;
  while (waitpid(pid_, nullptr, WNOHANG) == 0) {
    if (Clock::now() > end) kill(pid_, SIGKILL);
    std::this_thread::sleep_for(milliseconds(5));
  }
  pid_ = -1;
}

}  // namespace fogline::trials
