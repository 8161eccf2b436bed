// A seat of fogline-web, and the network of its run. The test replaces the run: it sends TRUTH like
// the world, and receives DRIVER_INPUT like the driver.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/driver_input.h"
#include "services/runtime/wire/message_signer.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tests/integration/web/viewed.h"

namespace fogline::test {

inline constexpr std::int64_t kSeatRun = 4711;

inline WebClient Page(std::uint16_t port, const std::string& target = "/ws") {
  return WebClient(port, {.target = target, .protocol = "fogline.drive.v1"});
}

inline std::string Braking(std::int64_t sequence, double brake = 0.5) {
  return nlohmann::json{{"op", "input"},
                        {"sequence", sequence},
                        {"age_ms", 3},
                        {"present", true},
                        {"throttle", 0},
                        {"brake", brake},
                        {"axes", {0.25, -1}},
                        {"buttons", {"take_over"}},
                        {"device", {{"kind", "wheel"}, {"name", "G29"}}},
                        {"latency_ms", 21}}
      .dump();
}

/// The network of a run. This class sends TRUTH to the network, and stores each DRIVER_INPUT that
/// arrives from the network.
class SeatNetwork {
 public:
  explicit SeatNetwork(const std::optional<runtime::SigningKey>& key = std::nullopt) : bus_(url_) {
    if (key) bus_.Secure(runtime::MessageSigner(*key, std::nullopt));
    bus_.Subscribe(ChannelOf<driver_input_t>().name, [this](runtime::Arrival& arrival) {
      const auto* input = arrival.As<driver_input_t>();
      ASSERT_NE(input, nullptr);
      EXPECT_EQ(runtime::WrongIn(*input), nullptr);
      heard_.push_back(*input);
    });
  }

  const std::string& url() const { return url_; }
  runtime::Bus& bus() { return bus_; }
  std::vector<driver_input_t>& heard() { return heard_; }

  void SendTruth(std::int64_t step, std::int64_t run_id = kSeatRun) {
    truth_t truth{};
    truth.header = {.run_id = run_id, .step = step, .utime = step * 20'000};
    Send(truth);
  }
  /// Sends RUN with the phase GO, as a runner does.
  void SendRun(std::int64_t run_id) {
    const std::string text = R"({"title": "any"})";
    const auto parts = runtime::SplitScenario(text);
    Send(runtime::MakeRunPart(run_id, run_t::GO, 1.0, runtime::HashOf(text), parts, 0));
  }
  template <class Message>
  void Send(const Message& message) {
    runtime::Encode(message, bytes_);
    bus_.Publish(ChannelOf<Message>().name, bytes_);
  }
  /// Waits for the first new DRIVER_INPUT for which `fits` returns true. @throws std::runtime_error
  /// after kPatience
  template <class Fits>
  driver_input_t Hear(const Fits& fits) {
    const TimePoint end = Clock::now() + kPatience;
    heard_.clear();
    while (Clock::now() < end) {
      bus_.Wait(milliseconds(20));
      for (const driver_input_t& input : heard_) {
        if (fits(input)) return input;
      }
    }
    throw std::runtime_error("no such DRIVER_INPUT comes");
  }

 private:
  std::string url_ = runtime::FreshMulticastUrl();
  runtime::Bus bus_;
  std::vector<driver_input_t> heard_;
  std::vector<std::uint8_t> bytes_;
};

inline bool IsThere(const driver_input_t& input) { return input.present; }
inline bool IsAway(const driver_input_t& input) { return !input.present; }

class SeatPageTest : public testing::Test {
 protected:
  explicit SeatPageTest(const std::vector<std::string>& more = {})
      : viewed_([&] {
          std::vector<std::string> all{"--seat", "--lcm-url", network_.url()};
          all.insert(all.end(), more.begin(), more.end());
          return all;
        }()) {}
  void SetUp() override { ASSERT_NE(viewed_.port(), 0) << viewed_.process().Err(); }
  std::uint16_t port() const { return viewed_.port(); }

  SeatNetwork network_;
  Viewed viewed_;
};

}  // namespace fogline::test
