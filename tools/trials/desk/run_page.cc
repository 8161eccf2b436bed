#include "tools/trials/desk/run_page.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"
#include "tools/trials/desk/desk.h"
#include "tools/web/server/access.h"

namespace fogline::trials {
namespace {

// The time within which fogline-web must begin to listen. It is long enough for a busy machine.
constexpr Duration kPageLimit = milliseconds(10'000);
// The pause before fogline-web is started again. It doubles with each failed start.
constexpr Duration kFirstPause = milliseconds(500);
constexpr Duration kLongestPause = milliseconds(8000);
// After this number of failed starts in a row, the cause is assumed to be permanent. The pauses
// between these starts take 7.5 s together.
constexpr int kMostFailures = 5;

}  // namespace

RunPage::RunPage(RunPageOptions options)
    : options_(std::move(options)),
      port_(options_.port),
      view_token_(web::DrawToken()),
      seat_token_(web::DrawToken()) {}

void RunPage::Show(std::int64_t run_id, const std::string& url, Seat seat) {
  run_id_ = run_id;
  End();
  url_ = url;
  seat_ = seat;
  failed_ = 0;
  const bool may_move = port_ != options_.port;
  if (Comes() || (may_move && Comes())) return;
  if (seat_ == Seat::kOpen) {
    End();
    throw std::runtime_error("fogline-web does not listen, so no person can drive at a page");
  }
}

bool RunPage::Comes() {
  Start();
  if (state_ == State::kStarting && TakeAddresses(kPageLimit)) return true;
  ThrowIfInterrupted();
  if (state_ == State::kStarting) Fail("fogline-web does not listen");
  return false;
}

void RunPage::Start() {
  std::vector<std::string> arguments{"--lcm-url",    url_,
                                     "--run",        std::to_string(run_id_),
                                     "--no-browser", "--tokens-on-stdin",
                                     "--listen",     fmt::format("{}:{}", options_.address, port_)};
  if (seat_ == Seat::kOpen) arguments.emplace_back("--seat");
  arguments.insert(arguments.end(), options_.traffic.begin(), options_.traffic.end());
  try {
    web_.Start(arguments, view_token_ + '\n' + seat_token_ + '\n');
    state_ = State::kStarting;
    listen_by_ = Clock::now() + kPageLimit;
  } catch (const std::exception& error) {
    Fail(error.what());
  }
}

void RunPage::Fail(const std::string& how) {
  web_.Kill();  // instead of End(), so that the thread of the run does not wait
  state_ = State::kPausing;
  port_ = options_.port;  // another program may have taken the port that the system had chosen
  start_at_ = Clock::now() + std::min(kLongestPause, kFirstPause * (1 << std::min(failed_, 10)));
  if (failed_++ > 0) return;
  Complain(fmt::format("fogline experiment: warning: {}; it is started again", how));
}

bool RunPage::TakeAddresses(Duration limit) {
  if (!web_.Listens(seat_ == Seat::kOpen ? 2 : 1, limit)) return false;
  seat_address_ = seat_ == Seat::kOpen ? web_.addresses().front() : "";
  view_address_ = web_.addresses().back();
  port_ = static_cast<std::uint16_t>(std::stoi(processes::PortOf(view_address_)));
  state_ = State::kListening;
  failed_ = 0;
  return true;
}

RunPage::Change RunPage::Look() {
  switch (state_) {
    case State::kNoRun:
      break;
    case State::kStarting:
      if (TakeAddresses(Duration::zero())) return Change::kIsBack;
      if (!web_.Runs()) {
        Fail("fogline-web " + web_.how_it_ended());
      } else if (Clock::now() > listen_by_) {
        Fail("fogline-web does not listen");
      }
      break;
    case State::kListening:
      if (web_.Runs()) break;
      state_ = State::kPausing;
      start_at_ = Clock::now() + kFirstPause;
      Complain(fmt::format("fogline experiment: fogline-web {}; it is started again",
                           web_.how_it_ended()));
      return Change::kDied;
    case State::kPausing:
      if (Clock::now() >= start_at_) Start();
      break;
  }
  return Change::kNone;
}

std::string RunPage::WhyHopeless() const {
  if (failed_ < kMostFailures) return "";
  return fmt::format("fogline-web was started {} times in vain, so no person can drive at a page",
                     failed_);
}

void RunPage::End() {
  web_.End();
  state_ = State::kNoRun;
  view_address_.clear();
  seat_address_.clear();
}

}  // namespace fogline::trials
