// A person at the page /drive: a client of the WebSocket that sends what the page would send.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/clock.h"
#include "common/process/priority.h"
#include "tests/support/command.h"
#include "tests/support/web_client.h"

namespace fogline::test {

/// A person who takes over, and brakes a little until the destructor is called. The object connects
/// again if fogline-web ends.
class PagePerson {
 public:
  /// @param target of the WebSocket, with the driver's token if there is one
  explicit PagePerson(std::uint16_t port, std::string target = "/ws")
      : port_(port), target_(std::move(target)), thread_([this] { Drive(); }) {}
  ~PagePerson() {
    ends_ = true;
    thread_.join();
  }
  PagePerson(const PagePerson&) = delete;
  PagePerson& operator=(const PagePerson&) = delete;

 private:
  void Drive() {
    // This thread gets a higher priority. Without this priority, on a busy machine, the person may
    // be silent for longer than /person/deadman_s. If the process has no right to this priority,
    // the tests need a machine that is not busy.
    RunThreadBeforeOthers(/*priority=*/1);
    while (!ends_) {
      try {
        WebClient client(port_, {.target = target_, .protocol = "fogline.drive.v1"});
        DriveWith(client);
      } catch (const std::exception&) {
        // fogline-web has ended, or is being started again.
        std::this_thread::sleep_for(kLookEvery);
      }
    }
  }

  void DriveWith(WebClient& client) {
    using nlohmann::json;
    constexpr milliseconds kEvery(30);  // the rule of a page: a frame at least every 50 ms
    while (!ends_) {
      client.Send(json{
          {"op", "input"},
          {"sequence", sequence_++},
          {"age_ms", 0},
          {"present", true},
          {"throttle", 0},
          {"brake", 0.25},
          {"axes", json::array()},
          {"buttons", json::array({"take_over"})},
          {"device", {{"kind", "keyboard"}, {"name", "Keyboard"}}},
          {"latency_ms",
           12}}.dump());
      // This client does not read. While it waited for a message of the run, it would send no
      // inputs, and the person could count as absent. The server keeps up to 8 MiB for a page that
      // does not read.
      std::this_thread::sleep_for(kEvery);
    }
  }

  const std::uint16_t port_;
  const std::string target_;
  std::int64_t sequence_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace fogline::test
