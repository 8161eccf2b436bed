#include "common/process/progress.h"

#include <unistd.h>

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"

namespace fogline {
namespace {

constexpr Duration kShowAfter = milliseconds(2000);
constexpr Duration kShowEvery = milliseconds(100);
constexpr int kBarWidth = 30;
constexpr const char* kErase = "\r\033[K";

}  // namespace

Progress::Progress(std::string what, std::int64_t total, bool shown)
    : what_(std::move(what)),
      total_(std::max<std::int64_t>(1, total)),
      terminal_(shown && isatty(STDERR_FILENO) == 1),
      began_(Clock::now()),
      next_(began_ + kShowAfter) {}

Progress::~Progress() {
  if (shown_) Draw(kErase);
}

void Progress::Show(std::int64_t done, std::string_view note) {
  if (!terminal_) return;
  const TimePoint now = Clock::now();
  if (now < next_) return;
  next_ = now + kShowEvery;
  shown_ = true;
  const double share =
      std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0);
  const double spent = std::chrono::duration<double>(now - began_).count();
  const auto filled = static_cast<int>(share * kBarWidth);
  std::string bar = fmt::format("{}[{:=<{}}{: <{}}] {:3.0f} %  {} {}/{}  {:.0f}/s", kErase, "",
                                filled, "", kBarWidth - filled, 100 * share, what_, done, total_,
                                static_cast<double>(done) / spent);
  if (share > 0) bar += fmt::format("  {:.0f} s left", spent * (1 - share) / share);
  if (!note.empty()) bar += fmt::format("  {}", note);
  Draw(bar);
}

void Progress::Say(std::string_view line) {
  if (shown_) Draw(kErase);
  Notice(line);
}

}  // namespace fogline
