// Common parts of the tests of fogline-relay.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/tcpq_client.h"
#include "tests/support/command.h"

namespace fogline::test {

using Payload = std::vector<std::uint8_t>;

/// A relay on a free port.
class Relay {
 public:
  explicit Relay(const std::vector<std::string>& more = {}) : process_(Command(more)) {
    EXPECT_TRUE(process_.WaitForOut("\n")) << process_.Err();
    url_ = process_.Out().substr(0, process_.Out().find('\n'));
  }
  const std::string& url() const { return url_; }
  std::uint16_t port() const { return runtime::tcpq::ResolveUrl(url_).port; }
  Background& process() { return process_; }
  /// Ends the relay with Ctrl-C, as a person does. @return its exit code
  int End() {
    process_.Signal(SIGINT);
    return process_.Wait();
  }

 private:
  static std::vector<std::string> Command(const std::vector<std::string>& more) {
    std::vector<std::string> command{Program("fogline-relay"), "--listen", "127.0.0.1:0"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  Background process_;
  std::string url_;
};

/// Publishes a message, and waits until this bus receives it. The relay has then also forwarded all
/// earlier messages of this bus. @return false after kPatience
[[nodiscard]] inline bool RoundTrip(runtime::Bus& bus) {
  static int trips = 0;
  const std::string channel = "ROUND_TRIP_" + std::to_string(trips++);
  bool back = false;
  bus.Subscribe(channel, [&back](runtime::Bytes) { back = true; });
  bus.Publish(channel, Payload(1));
  const TimePoint end = Clock::now() + kPatience;
  while (!back && Clock::now() < end) bus.Wait(milliseconds(100));
  return back;
}

}  // namespace fogline::test
