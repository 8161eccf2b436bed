#include "tools/trials/desk/terminal_desk.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/text.h"

namespace fogline::trials {
namespace {

// Interval at which a wait checks for Ctrl-C.
constexpr Duration kLookEvery = milliseconds(50);

std::string Title(const Next& next) {
  return fmt::format("{} {} of {}", next.trial.practice ? "Practice run" : "Run", next.trial.number,
                     next.of);
}

std::string ScaleText(const ItemSection& item) {
  if (item.kind == ItemKind::kText) return "free text";
  const auto end = [](double value, const std::string& label) {
    return NumberText(value) + (label.empty() ? "" : " " + label);
  };
  return fmt::format("{} to {}, in steps of {}", end(item.min, item.low), end(item.max, item.high),
                     NumberText(item.step));
}

}  // namespace

std::string TerminalDesk::ReadLine() {
  std::fflush(stdout);
  try {
    return WaitForLine();
  } catch (...) {
    fmt::print("\n");  // ends the line of the prompt, so that an error has a line of its own
    std::fflush(stdout);
    throw;
  }
}

std::string TerminalDesk::WaitForLine() {
  for (;;) {
    if (const std::size_t end = unread_.find('\n'); end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      if (line.ends_with('\r')) line.pop_back();
      return line;
    }
    ThrowIfInterrupted();
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, static_cast<int>(Milliseconds(kLookEvery))) <= 0) continue;
    std::array<char, 4096> bytes{};
    const ssize_t size = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size <= 0) {
      throw std::runtime_error(
          "standard input has ended before the last answer; the logs keep the finished trials; the "
          "same command continues from here");
    }
    unread_.append(bytes.data(), static_cast<std::size_t>(size));
  }
}

void TerminalDesk::WaitForBegin(const Next& next) {
  if (next.not_before_s > 0) {
    fmt::print("\nBreak: {} begins in {} s at the earliest.\n", Title(next),
               NumberText(next.not_before_s));
    std::fflush(stdout);
    const TimePoint end =
        Clock::now() + duration_cast<Duration>(std::chrono::duration<double>(next.not_before_s));
    while (Clock::now() < end) {
      ThrowIfInterrupted();
      std::this_thread::sleep_for(std::min<Duration>(kLookEvery, end - Clock::now()));
    }
  }
  fmt::print("\n{}. Enter begins it: ", Title(next));
  ReadLine();
  fmt::print("\n");
  std::fflush(stdout);
}

std::vector<Answer> TerminalDesk::Ask(const Next& after,
                                      const QuestionnaireSection& questionnaire) {
  fmt::print("{}: questions\n", Title(after));
  std::vector<Answer> answers;
  const std::size_t count = questionnaire.items.size();
  for (std::size_t i = 0; i < count; ++i) {
    const ItemSection& item = questionnaire.items[i];
    for (;;) {
      fmt::print("{}/{}  {} ({}): ", i + 1, count, item.text, ScaleText(item));
      std::string why;
      const auto answer = ReadAnswer(item, ReadLine(), why);
      if (answer) {
        answers.push_back(*answer);
        break;
      }
      fmt::print("     Please give {}.\n", why);
    }
  }
  fmt::print("\n");
  return answers;
}

void TerminalDesk::Finish() { fmt::print("\nThat was the last run. Thank you.\n"); }

}  // namespace fogline::trials
