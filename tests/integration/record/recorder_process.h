// A process of `fogline record` in tests.
#pragma once

#include <csignal>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/event_log.h"
#include "services/runtime/transport/bus.h"
#include "tests/support/command.h"

namespace fogline::test {

struct Recorded {
  std::string channel;
  std::vector<std::uint8_t> data;

  bool operator==(const Recorded&) const = default;
};

/// The messages of a log, without the marks of CatchUp().
inline std::vector<Recorded> MessagesIn(const std::string& log) {
  std::vector<Recorded> messages;
  log::EventLogReader reader(log);
  std::int64_t number = 0;
  while (const auto event = reader.Next()) {
    EXPECT_EQ(event->number, number++);
    if (event->channel.starts_with("MARK_")) continue;
    messages.push_back({std::string(event->channel), {event->data.begin(), event->data.end()}});
  }
  EXPECT_EQ(reader.torn(), "");
  return messages;
}

class RecordProcess {
 public:
  /// Starts `fogline record`, and waits until it listens.
  RecordProcess(runtime::Bus& bus, std::string log, const std::vector<std::string>& more = {})
      : bus_(bus), log_(std::move(log)), process_(Command(more)) {
    EXPECT_TRUE(process_.WaitForErr("records ")) << process_.Err();
  }

  /// Waits until everything that was sent so far is in `file`.
  [[nodiscard]] bool CatchUp(const std::string& mark, const std::string& file) {
    const TimePoint end = Clock::now() + kPatience;
    while (Content(file).find("MARK_" + mark) == std::string::npos) {
      if (Clock::now() > end) return false;
      bus_.Publish("MARK_" + mark, std::vector<std::uint8_t>{0});
      bus_.Wait(milliseconds(10));
    }
    return true;
  }
  [[nodiscard]] bool CatchUp(const std::string& mark) { return CatchUp(mark, log_); }

  /// Ends `fogline record` with Ctrl-C. @return the summary
  nlohmann::json End() {
    process_.Signal(SIGINT);
    EXPECT_EQ(process_.Wait(), 0) << process_.Err();
    return nlohmann::json::parse(process_.Out(), nullptr, false);
  }
  Background& process() { return process_; }

 private:
  std::vector<std::string> Command(const std::vector<std::string>& more) const {
    std::vector<std::string> command{Program("fogline"), "record", log_,         "--lcm-url",
                                     bus_.url(),         "--json", "--flush-ms", "10"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }

  runtime::Bus& bus_;
  const std::string log_;
  Background process_;
};

}  // namespace fogline::test
