// Debian's lcm-logger and lcm-spy as processes of a test.
#pragma once

#include <csignal>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "services/runtime/transport/bus.h"
#include "tests/support/command.h"

namespace fogline::test {

/// Publishes a message again and again, as a mark on a channel that no role uses, until `seen`
/// returns true. A program that has received the mark listens to the network, and has received all
/// earlier messages. @return false after the time limit
inline bool Mark(runtime::Bus& bus, const std::string& channel, const std::function<bool()>& seen,
                 std::chrono::seconds limit = kPatience) {
  const auto end = Clock::now() + limit;
  while (!seen()) {
    if (Clock::now() > end) return false;
    bus.Publish(channel, std::vector<std::uint8_t>(runtime::kHeaderEnd));
    bus.Wait(milliseconds(10));
  }
  return true;
}

/// The command, with real-time priority if the system permits this. lcm-logger queues 30 messages
/// and loses further messages. Without the priority, lcm-logger may get no processor time for some
/// milliseconds on a busy machine, and lose messages.
inline std::vector<std::string> BeforeOtherWork(std::vector<std::string> command) {
  const std::vector<std::string> first{"chrt", "--rr", "1"};
  std::vector<std::string> probe = first;
  probe.emplace_back("true");
  if (RunCommand(probe).code == 0) command.insert(command.begin(), first.begin(), first.end());
  return command;
}

/// Debian's lcm-logger.
class Logger {
 public:
  Logger(runtime::Bus& bus, std::string file)
      : bus_(bus),
        file_(std::move(file)),
        process_(BeforeOtherWork(
            {"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + bus.url(), file_})) {}

  /// Waits until lcm-logger has logged everything that was sent so far.
  [[nodiscard]] bool CatchUp(const std::string& mark) {
    return Mark(bus_, mark, [&] { return Content(file_).find(mark) != std::string::npos; });
  }
  /// Ends lcm-logger with Ctrl-C, as a person does. @return its exit code
  int End() {
    process_.Signal(SIGINT);
    return process_.Wait();
  }

 private:
  runtime::Bus& bus_;
  const std::string file_;
  Background process_;
};

/// A virtual screen (Xvfb) for programs with windows.
class OwnScreen {
 public:
  OwnScreen()
      : server_({"Xvfb", "-displayfd", "1", "-nolisten", "tcp", "-screen", "0", "1000x700x24"}) {
    EXPECT_TRUE(server_.WaitForOut("\n", kPatience)) << "no X server: " << server_.Err();
  }
  /// The value of the environment variable DISPLAY, such as "DISPLAY=:7".
  std::string Setting() {
    const std::string out = server_.Out();
    return "DISPLAY=:" + out.substr(0, out.find('\n'));
  }

 private:
  Background server_;
};

/// Debian's lcm-spy on a virtual screen. `fogline spy` starts lcm-spy. SpyProbe reads lcm-spy's
/// window.
class Spy {
 public:
  explicit Spy(runtime::Bus& bus) : bus_(bus) {
    process_.emplace(std::vector<std::string>{"env", screen_.Setting(),
                                              "JAVA_TOOL_OPTIONS=-javaagent:" + BuildProbe(),
                                              Program("fogline"), "spy", "--lcm-url", bus.url()});
  }

  /// Waits until lcm-spy shows everything that was sent so far.
  /// lcm-spy adds a row on its LCM thread while another thread shows the table. If both happen at
  /// the same time, lcm-spy shows the row only when it adds the next row. So CatchUp() sends
  /// further marks if the first mark does not appear.
  [[nodiscard]] bool CatchUp(const std::string& mark) {
    const auto shows_mark = [&] {
      const std::string out = process_->Out();
      const std::size_t row = out.find("row\t" + mark + "\t");
      return row != std::string::npos && out.find("end of table", row) != std::string::npos;
    };
    constexpr std::chrono::seconds kLimit(20);
    if (Mark(bus_, mark, shows_mark, kLimit)) return true;
    constexpr int kMarks = 10;
    for (int i = 1; i <= kMarks; ++i) {
      if (Mark(bus_, mark + "_" + std::to_string(i), shows_mark, kLimit)) return true;
    }
    return false;
  }

  struct Row {
    std::string type;
    std::int64_t messages = 0;
    std::int64_t undecodable = 0;
  };
  /// The table in lcm-spy's window, by channel.
  std::map<std::string, Row> Rows() const {
    std::map<std::string, Row> rows;
    std::istringstream lines(process_->Out());
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("row\t")) continue;
      std::vector<std::string> cells;
      std::istringstream words(line);
      for (std::string cell; std::getline(words, cell, '\t');) cells.push_back(cell);
      // "row", Channel, Type, Num Msgs, Hz, 1/Hz, Jitter, Bandwidth, Undecodable
      if (cells.size() != 9) continue;
      rows[cells[1]] = {cells[2], std::stoll(cells[3]), std::stoll(cells[8])};
    }
    return rows;
  }
  std::string Err() const { return process_->Err(); }

 private:
  /// Compiles SpyProbe. @return the path of its jar
  std::string BuildProbe() const {
    const std::string source = (SourceDirectory() / "tests/integration/lcm/SpyProbe.java").string();
    const std::string classes = folder_.File("classes");
    const std::string jar = folder_.File("probe.jar");
    std::ofstream(folder_.File("manifest")) << "Premain-Class: SpyProbe\n";
    Outcome step = RunCommand({"javac", "-d", classes, source});
    EXPECT_EQ(step.code, 0) << "is a JDK there? " << step.err;
    step = RunCommand({"jar", "cfm", jar, folder_.File("manifest"), "-C", classes, "."});
    EXPECT_EQ(step.code, 0) << step.err;
    return jar;
  }

  runtime::Bus& bus_;
  ScratchFolder folder_;
  OwnScreen screen_;
  std::optional<Background> process_;
};

}  // namespace fogline::test
