#include "tools/trials/desk/run_page.h"

#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"
#include "tools/processes/web_child.h"
#include "tools/web/server/access.h"

namespace fogline::trials {
namespace {

// fogline-web listens within this time, even on a busy machine.
constexpr Duration kPageLimit = milliseconds(10'000);
// A fogline-web that dies at once is started so often: twice in a second.
constexpr Duration kRestartEvery = milliseconds(500);
// A run that is under way waits so long for the addresses of a fogline-web that was started again.
constexpr Duration kShortLook = milliseconds(1);

/// A pipe that has a text to read, and then ends. @pre the text is short enough for a pipe
void Fill(processes::Pipe& pipe, const std::string& text) {
  [[maybe_unused]] const ssize_t written = write(pipe.write, text.data(), text.size());
  close(std::exchange(pipe.write, -1));
}

}  // namespace

RunPage::RunPage(RunPageOptions options)
    : options_(std::move(options)), view_token_(web::DrawToken()), seat_token_(web::DrawToken()) {}

RunPage::~RunPage() { End(); }

void RunPage::Show(const std::string& url, Seat seat) {
  End();
  url_ = url;
  seat_ = seat;
  Start();
  if (pid_ >= 0) listens_ = ReadAddresses(kPageLimit);
  if (listens_) return;
  processes::EndWeb(pid_);
  if (seat_ == Seat::kOpen) {
    throw std::runtime_error("fogline-web does not listen, so no person can drive at a page");
  }
  Complain(
      "fogline experiment: warning: fogline-web does not listen; the run goes on without its view");
}

void RunPage::Start() {
  start_at_ = Clock::now() + kRestartEvery;
  // Other users of this machine can read the arguments of a process, but not its input.
  std::vector<std::string> arguments{
      "--lcm-url",         url_,       "--no-browser",
      "--tokens-on-stdin", "--listen", fmt::format("{}:{}", options_.address, options_.port)};
  if (seat_ == Seat::kOpen) arguments.emplace_back("--seat");
  arguments.insert(arguments.end(), options_.traffic.begin(), options_.traffic.end());
  try {
    processes::Pipe tokens;
    Fill(tokens, view_token_ + '\n' + seat_token_ + '\n');
    output_.emplace();
    pid_ = processes::StartChild(processes::ProgramBeside("fogline-web"), arguments, output_->write,
                                 STDERR_FILENO, tokens.read);
    close(std::exchange(output_->write, -1));
  } catch (const std::exception& error) {
    Complain(fmt::format("fogline experiment: warning: {}; the run goes on without its page",
                         error.what()));
  }
}

bool RunPage::ReadAddresses(Duration limit) {
  const std::size_t count = seat_ == Seat::kOpen ? 2 : 1;
  const std::vector<std::string> lines = processes::LinesOf(output_->read, count, limit);
  if (lines.size() < count) return false;
  seat_address_ = seat_ == Seat::kOpen ? lines.front() : "";
  view_address_ = lines.back();
  options_.port = static_cast<std::uint16_t>(std::stoi(processes::PortOf(view_address_)));
  return true;
}

RunPage::Change RunPage::Look() {
  int status = 0;
  if (pid_ >= 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    Complain(fmt::format("fogline experiment: fogline-web {}; it is started again",
                         processes::HowItEnded(status)));
    pid_ = -1;
    return std::exchange(listens_, false) ? Change::kDied : Change::kNone;
  }
  if (url_.empty() || listens_) return Change::kNone;
  if (pid_ < 0) {
    if (Clock::now() >= start_at_) Start();
    return Change::kNone;
  }
  listens_ = ReadAddresses(kShortLook);
  return listens_ ? Change::kIsBack : Change::kNone;
}

void RunPage::End() {
  processes::EndWeb(pid_);
  url_.clear();
  listens_ = false;
}

}  // namespace fogline::trials
