#include "tools/trials/desk/run_page.h"

#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"
#include "tools/processes/web_child.h"

namespace fogline::trials {
namespace {

// fogline-web listens within this time, even on a busy machine.
constexpr Duration kPageLimit = milliseconds(10'000);
// A fogline-web that dies at once is started so often: twice in a second.
constexpr Duration kRestartEvery = milliseconds(500);

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
                                       processes::PortOf(address_)};
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
    processes::EndWeb(pid_);
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
  processes::EndWeb(pid_);
  url_.clear();
}

}  // namespace fogline::trials
