// Helpers for tests that change the log of a run.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "services/log/event_log.h"
#include "services/log/log_seal.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {

using Words = std::vector<std::string>;
using Payload = std::vector<std::uint8_t>;

inline Words With(Words command, const Words& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

/// The offset of the first event of a channel in a log, and the event's size in bytes.
struct EventPlace {
  std::size_t at = 0;
  std::size_t size = 0;
};
inline EventPlace FirstEventOf(const std::string& log, std::string_view channel) {
  log::EventLogReader reader(log);
  std::size_t at = 0;
  while (const auto event = reader.Next()) {
    if (event->channel == channel) return {.at = at, .size = log::SizeInFile(*event)};
    at = reader.good_bytes();
  }
  ADD_FAILURE() << "no " << channel << " in " << log;
  return {};
}

inline void FlipLowestBit(const std::string& file, std::size_t at) {
  const int fd = open(file.c_str(), O_RDWR);
  std::uint8_t byte = 0;
  EXPECT_EQ(pread(fd, &byte, 1, static_cast<off_t>(at)), 1);
  byte ^= 1;
  EXPECT_EQ(pwrite(fd, &byte, 1, static_cast<off_t>(at)), 1);
  close(fd);
}

/// Copies the events of a log into another file, altered by `change` and without the log's seal.
inline void Rewrite(const std::string& from, const std::string& to,
                    const std::function<void(std::string_view channel, Payload&)>& change) {
  log::EventLogReader reader(from);
  log::EventLogWriter writer(to);
  while (const auto event = reader.Next()) {
    if (event->channel == log::kLogSealChannel) continue;
    Payload bytes(event->data.begin(), event->data.end());
    change(event->channel, bytes);
    writer.Write(event->channel, event->utime, bytes);
  }
}

class LogIntegrityTest : public testing::Test {
 protected:
  /// The command of a run with an external driver. The run waits until the test starts this driver.
  Words Run(const Words& more = {}) const {
    return With({Program("fogline"), "run", "scenario/paper.json", "--json", "--external", "driver",
                 "--stall-timeout", "60", "--lcm-url", url_, "--log", log_},
                more);
  }
  Words Driver() const { return {Program("fogline-driver"), "--lcm-url", url_}; }
  std::int64_t RunIdIn(const std::string& err) const {
    return std::stoll(err.substr(err.find("run ") + 4));
  }
  static nlohmann::json Digest(const Words& arguments, int code) {
    const Outcome outcome = RunCommand(With({Program("fogline"), "digest", "--json"}, arguments));
    EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false)[0];
  }
  /// Makes a log of a run in one process. @return its path
  std::string DirectLog(const std::string& name, const Words& more = {}) const {
    const std::string log = folder_.File(name);
    const Outcome run =
        RunCommand(With({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                         "--quiet", "--set", "/steps=50", "--log", log},
                        more));
    EXPECT_EQ(run.code, 0) << run.err;
    return log;
  }

  ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string url_ = runtime::Bus(runtime::FreshMulticastUrl()).url();
};

}  // namespace fogline::test
