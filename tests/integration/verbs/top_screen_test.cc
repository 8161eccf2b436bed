// `fogline top` on a pseudo-terminal. The test is at the other end of the pseudo-terminal, and
// interprets the output as a terminal does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The screen of a terminal. It understands the control sequences (ECMA-48) that top uses. With any
/// other sequence the test fails.
class EmulatedScreen {
 public:
  EmulatedScreen(std::size_t columns, std::size_t rows) { Resize(columns, rows); }

  void Resize(std::size_t columns, std::size_t rows) {
    columns_ = columns;
    cells_.assign(rows, std::string(columns, ' '));
    selected_.assign(rows, false);
  }
  void Take(std::string_view bytes) {
    pending_ += bytes;
    while (!pending_.empty() && TakeOne()) {
    }
  }

  const std::vector<std::string>& rows() const { return cells_; }
  std::string Text() const {
    std::string text;
    for (const std::string& row : cells_) text += row + "\n";
    return text;
  }
  /// The row in reverse video; "" if there is none. The last row does not count.
  std::string Selected() const {
    for (std::size_t i = 0; i + 1 < cells_.size(); ++i) {
      if (selected_[i]) return cells_[i];
    }
    return "";
  }
  bool alternate() const { return alternate_; }
  bool cursor_visible() const { return cursor_visible_; }

 private:
  /// Interprets the first character or sequence of pending_. @return false if it is not complete
  bool TakeOne() {
    if (pending_[0] != '\033') {
      Put(pending_[0]);
      pending_.erase(0, 1);
      return true;
    }
    if (pending_.size() < 3) return false;
    const std::size_t end = pending_.find_first_not_of("0123456789;?", 2);
    if (end == std::string::npos) return false;
    Obey(pending_.substr(2, end - 2), pending_[end]);
    pending_.erase(0, end + 1);
    return true;
  }
  void Put(char byte) {
    if (byte == '\r') {
      column_ = 0;
    } else if (byte == '\n') {
      row_ = std::min(row_ + 1, cells_.size() - 1);
    } else if (byte >= ' ' && column_ < columns_ && row_ < cells_.size()) {
      cells_[row_][column_++] = byte;
      if (reverse_) selected_[row_] = true;
    }
  }
  void Obey(const std::string& parameters, char command) {
    if (command == 'H' && parameters.empty()) {
      row_ = column_ = 0;
      selected_.assign(cells_.size(), false);
    } else if (command == 'K' && parameters.empty()) {
      std::fill(cells_[row_].begin() + static_cast<std::ptrdiff_t>(column_), cells_[row_].end(),
                ' ');
    } else if (command == 'J' && parameters.empty()) {
      for (std::size_t i = row_ + 1; i < cells_.size(); ++i) cells_[i].assign(columns_, ' ');
    } else if (command == 'm') {
      reverse_ = parameters == "7";
    } else if (parameters == "?1049") {
      alternate_ = command == 'h';
    } else if (parameters == "?25") {
      cursor_visible_ = command == 'h';
    } else {
      ADD_FAILURE() << "ESC [ " << parameters << ' ' << command;
    }
  }

  std::size_t columns_ = 0;
  std::vector<std::string> cells_;
  std::vector<bool> selected_;
  std::string pending_;
  std::size_t row_ = 0;
  std::size_t column_ = 0;
  bool reverse_ = false;
  bool alternate_ = false;
  bool cursor_visible_ = true;
};

// The first column of each table is the name of the row.
constexpr std::size_t kNameColumns = 12;

/// `fogline top` on a terminal.
class TopOnTerminal {
 public:
  explicit TopOnTerminal(const std::string& url) {
    winsize size{.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
    pid_ = forkpty(&terminal_, nullptr, nullptr, &size);
    if (pid_ != 0) return;
    const std::string program = Program("fogline");
    execl(program.c_str(), program.c_str(), "top", "--interval", "0.2", "--lcm-url", url.c_str(),
          nullptr);
    _exit(127);
  }
  ~TopOnTerminal() {
    close(terminal_);
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  TopOnTerminal(const TopOnTerminal&) = delete;
  TopOnTerminal& operator=(const TopOnTerminal&) = delete;

  const EmulatedScreen& screen() const { return screen_; }
  void Press(std::string_view keys) {
    ASSERT_EQ(write(terminal_, keys.data(), keys.size()), std::ssize(keys));
  }
  void Resize(unsigned short columns, unsigned short rows) {
    const winsize size{.ws_row = rows, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
    screen_.Resize(columns, rows);
    ASSERT_EQ(ioctl(terminal_, TIOCSWINSZ, &size), 0);
  }
  /// Reads until the screen is as expected. @return false if this does not happen
  bool WaitUntil(const std::function<bool()>& expected) {
    for (const TimePoint end = Clock::now() + kPatience; Clock::now() < end;) {
      if (expected()) return true;
      if (!Read()) return expected();
    }
    return false;
  }
  bool Shows(const std::string& text) {
    const bool shown = WaitUntil([&] { return screen_.Text().find(text) != std::string::npos; });
    EXPECT_TRUE(shown) << "no \"" << text << "\" in\n" << screen_.Text();
    return shown;
  }
  /// Moves the cursor down to the row with this name. @return false if it finds no such row
  bool MoveDownTo(const std::string& name) {
    const auto selected = [this] { return screen_.Selected().substr(0, kNameColumns); };
    constexpr int kMost = 50;
    for (int i = 0; i < kMost && selected().find(name) == std::string::npos; ++i) {
      const std::string before = selected();
      Press("\033[B");
      if (!WaitUntil([&] { return !selected().empty() && selected() != before; })) break;
    }
    EXPECT_THAT(selected(), HasSubstr(name)) << screen_.Text();
    return selected().find(name) != std::string::npos;
  }
  /// Waits for the end. @return the exit code, or 128 + signal
  int Wait() {
    while (Read()) {
    }
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// Whether the terminal reads whole lines and shows what is typed, as a shell expects.
  bool IsUsual() const {
    termios now{};
    return tcgetattr(terminal_, &now) == 0 && (now.c_lflag & (ECHO | ICANON)) == (ECHO | ICANON);
  }

 private:
  /// Reads what comes within a second. @return false if the program has closed the terminal
  bool Read() {
    pollfd waited{.fd = terminal_, .events = POLLIN, .revents = 0};
    if (poll(&waited, 1, 1000) == 0) return true;
    std::array<char, 4096> bytes{};
    const ssize_t size = read(terminal_, bytes.data(), bytes.size());
    if (size <= 0) return false;
    screen_.Take({bytes.data(), static_cast<std::size_t>(size)});
    return true;
  }

  int terminal_ = -1;
  pid_t pid_ = -1;
  EmulatedScreen screen_{80, 24};
};

constexpr const char* kEnd = "\033[F";
constexpr const char* kHome = "\033[H";

/// Whether the screen shows the row of each role with its state and its diagnosis.
bool ShowsEveryRole(const EmulatedScreen& screen) {
  return std::ranges::all_of(kRoles, [&](const RoleInfo& info) {
    return std::ranges::any_of(screen.rows(), [&](const std::string& row) {
      constexpr std::size_t kDiagnosis = 40;
      return row.find(" " + std::string(info.name) + " ") < 2 &&
             row.find("RUNNING") != std::string::npos && row[kDiagnosis] != ' ';
    });
  });
}

std::vector<std::string> RunOn(const std::string& url, const ScratchFolder& folder,
                               const std::vector<std::string>& more) {
  std::vector<std::string> command{
      Program("fogline"),    "run", "scenario/paper.json", "--quiet", "--lcm-url", url, "--log",
      folder.File("run.lcm")};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

TEST(TopScreenTest, ShowsScrollsSortsAndOpensARunOn80By24AndFollowsTheWindow) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  const Background run(RunOn(url, folder, {"--pace", "1"}));
  TopOnTerminal top(url);
  // THEN all roles with their diagnosis are visible at the same time
  ASSERT_TRUE(top.WaitUntil([&] { return ShowsEveryRole(top.screen()); })) << top.screen().Text();
  EXPECT_THAT(top.screen().rows()[23], HasSubstr("q quit"));
  EXPECT_TRUE(top.Shows("the automation drives"));
  // AND the table of senders has no room on the screen after a message of each channel has come
  EXPECT_TRUE(top.WaitUntil([&] {
    return top.screen().Text().find("senders, by") == std::string::npos;
  })) << top.screen().Text();
  // AND the window can be scrolled to the last row
  top.Press(kEnd);
  EXPECT_TRUE(top.Shows("senders, by LCM's own numbers"));
  top.Press(kHome);
  ASSERT_TRUE(top.WaitUntil([&] { return ShowsEveryRole(top.screen()); })) << top.screen().Text();
  EXPECT_THAT(top.screen().Selected(), HasSubstr("world"));
  // AND the channels can be sorted
  top.Press("\ts");
  EXPECT_TRUE(top.Shows("s sort: rate"));
  top.Press("sssss");
  EXPECT_TRUE(top.Shows("s sort: channel"));
  // AND top shows a channel's fields, the values of which change
  ASSERT_TRUE(top.MoveDownTo("TRACK"));
  top.Press("\r");
  ASSERT_TRUE(top.Shows("TRACK of run "));
  ASSERT_TRUE(top.Shows("header.step"));
  const auto step = [&] {
    const std::string text = top.screen().Text();
    const std::size_t at = text.find("header.step");
    return at == std::string::npos ? -1 : std::atoi(text.c_str() + at + 11);
  };
  const int first = step();
  EXPECT_TRUE(top.WaitUntil([&] { return step() > first; })) << top.screen().Text();
  // AND the screen follows the size of the window
  top.Resize(120, 40);
  EXPECT_TRUE(top.WaitUntil([&] {
    return top.screen().rows()[39].find("Esc close") != std::string::npos;
  })) << top.screen().Text();
  top.Press("\033");
  EXPECT_TRUE(top.WaitUntil([&] { return ShowsEveryRole(top.screen()); })) << top.screen().Text();
  // AND after Ctrl-C the terminal has its former settings
  EXPECT_FALSE(top.IsUsual());
  top.Press("\003");
  EXPECT_EQ(top.Wait(), 130);
  EXPECT_FALSE(top.screen().alternate());
  EXPECT_TRUE(top.screen().cursor_visible());
  EXPECT_TRUE(top.IsUsual());
}

TEST(TopScreenTest, SaysInRealtimeWhoDrivesAndWhichInputIsLost) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  Background driver({Program("fogline-driver"), "--lcm-url", url});
  Background run(RunOn(url, folder, {"--realtime", "--external", "driver"}));
  TopOnTerminal top(url);
  ASSERT_TRUE(top.WaitUntil([&] { return ShowsEveryRole(top.screen()); })) << top.screen().Text();
  ASSERT_TRUE(top.Shows("real time x1  the automation drives"));
  // WHEN the driver hangs
  driver.Signal(SIGSTOP);
  EXPECT_TRUE(top.WaitUntil([&] {
    return std::ranges::any_of(top.screen().rows(), [](const std::string& row) {
      return row.find(" arbitrator ") < 2 && row.find("the automation drives") != std::string::npos;
    });
  })) << top.screen().Text();
  // THEN the arbitrator does not wait, and STATUS names the missing input
  EXPECT_THAT(top.screen().Text(), Not(HasSubstr("waits for DRIVER_COMMAND")));
  ASSERT_TRUE(top.MoveDownTo("arbitrator"));
  top.Press("\r");
  EXPECT_TRUE(top.Shows("LOST DRIVER_COMMAND"));
  driver.Signal(SIGCONT);
  top.Press("q");
  EXPECT_EQ(top.Wait(), 0);
  EXPECT_TRUE(top.IsUsual());
}

}  // namespace
}  // namespace fogline::test
