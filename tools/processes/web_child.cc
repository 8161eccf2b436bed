#include "tools/processes/web_child.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "common/interrupt.h"

namespace fogline::processes {
namespace {

// Limit for the time that fogline-web needs to end after SIGTERM. After this time it is killed.
constexpr Duration kFarewellLimit = milliseconds(2000);
// Interval at which a wait checks whether it must end.
constexpr Duration kSlice = milliseconds(50);

}  // namespace

std::string PortOf(const std::string& address) {
  if (address.empty()) return "0";
  const std::size_t begin = address.rfind(':') + 1;
  return address.substr(begin, address.find('/', begin) - begin);
}

void WebChild::Start(const std::vector<std::string>& arguments, const std::string& input) {
  End();
  how_it_ended_.clear();
  lines_.reset();
  output_.emplace();
  Pipe in;
  [[maybe_unused]] const ssize_t written = write(in.write, input.data(), input.size());
  close(std::exchange(in.write, -1));
  pid_ = StartChild(BuiltProgramBeside("fogline-web"), arguments, output_->write, -1, in.read);
  close(std::exchange(output_->write, -1));
  lines_.emplace(output_->read);
}

bool WebChild::Listens(std::size_t addresses, Duration limit) {
  if (!lines_) return false;
  const TimePoint end = Clock::now() + limit;
  do {
    if (WasInterrupted()) return false;
    if (lines_->Has(addresses, std::min(kSlice, end - Clock::now()))) return true;
  } while (!lines_->ended() && Clock::now() < end);
  return false;
}

std::vector<std::string> WebChild::addresses() const {
  return lines_ ? lines_->lines() : std::vector<std::string>();
}

bool WebChild::Runs() {
  int status = 0;
  if (pid_ >= 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    pid_ = -1;
    how_it_ended_ = HowItEnded(status);
  }
  return pid_ >= 0;
}

void WebChild::End() { EndChild(std::exchange(pid_, -1), kFarewellLimit); }

void WebChild::Kill() const {
  if (pid_ > 0) kill(pid_, SIGKILL);
}

}  // namespace fogline::processes
