#include "tools/trials/desk/run_page.h"

#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"
#include "tools/trials/desk/desk.h"
#include "tools/web/server/access.h"

namespace fogline::trials {
namespace {

// fogline-web listens within this time, even on a busy machine.
constexpr Duration kPageLimit = milliseconds(10'000);
// A fogline-web that dies at once is started so often: twice in a second.
constexpr Duration kRestartEvery = milliseconds(500);

}  // namespace

RunPage::RunPage(RunPageOptions options)
    : options_(std::move(options)), view_token_(web::DrawToken()), seat_token_(web::DrawToken()) {}

void RunPage::Show(const std::string& url, Seat seat) {
  End();
  url_ = url;
  seat_ = seat;
  Start();
  listens_ = TakeAddresses(kPageLimit);
  if (listens_) return;
  ThrowIfInterrupted();
  web_.End();
  if (seat_ == Seat::kOpen) {
    throw std::runtime_error("fogline-web does not listen, so no person can drive at a page");
  }
  Complain(
      "fogline experiment: warning: fogline-web does not listen; the run goes on without its view");
}

void RunPage::Start() {
  start_at_ = Clock::now() + kRestartEvery;
  std::vector<std::string> arguments{
      "--lcm-url",         url_,       "--no-browser",
      "--tokens-on-stdin", "--listen", fmt::format("{}:{}", options_.address, options_.port)};
  if (seat_ == Seat::kOpen) arguments.emplace_back("--seat");
  arguments.insert(arguments.end(), options_.traffic.begin(), options_.traffic.end());
  try {
    web_.Start(arguments, view_token_ + '\n' + seat_token_ + '\n');
  } catch (const std::exception& error) {
    Complain(fmt::format("fogline experiment: warning: {}; the run goes on without its page",
                         error.what()));
  }
}

bool RunPage::TakeAddresses(Duration limit) {
  if (!web_.Listens(seat_ == Seat::kOpen ? 2 : 1, limit)) return false;
  seat_address_ = seat_ == Seat::kOpen ? web_.addresses().front() : "";
  view_address_ = web_.addresses().back();
  options_.port = static_cast<std::uint16_t>(std::stoi(processes::PortOf(view_address_)));
  return true;
}

RunPage::Change RunPage::Look() {
  if (url_.empty()) return Change::kNone;
  if (web_.Runs()) {
    if (listens_ || !TakeAddresses(Duration::zero())) return Change::kNone;
    listens_ = true;
    return Change::kIsBack;
  }
  if (std::exchange(listens_, false)) {
    Complain(fmt::format("fogline experiment: fogline-web {}; it is started again",
                         web_.how_it_ended()));
    return Change::kDied;
  }
  if (Clock::now() >= start_at_) Start();
  return Change::kNone;
}

void RunPage::End() {
  web_.End();
  url_.clear();
  listens_ = false;
}

}  // namespace fogline::trials
