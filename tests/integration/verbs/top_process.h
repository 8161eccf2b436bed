// A process of `fogline top` in tests.
#pragma once

#include <nlohmann/json.hpp>

#include <chrono>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "tests/support/command.h"

namespace fogline::test {

// The duration of top, which is longer than any test with top.
inline constexpr auto kTopFor = std::chrono::duration_cast<std::chrono::seconds>(2 * kPatience);

/// `fogline top --json`, which prints a document for each interval until the test ends.
class Top {
 public:
  explicit Top(runtime::Bus& bus)
      : bus_(bus),
        process_({Program("fogline"), "top", "--json", "--interval", "0.2", "--for",
                  std::to_string(kTopFor.count()), "--lcm-url", bus.url()}) {}

  pid_t pid() const { return process_.pid(); }

  /// Waits until top shows everything that was sent so far.
  [[nodiscard]] bool CatchUp(const std::string& mark) {
    const TimePoint end = Clock::now() + kPatience;
    while (Complete().find("\"" + mark + "\"") == std::string::npos) {
      if (Clock::now() > end) return false;
      bus_.Publish(mark, std::vector<std::uint8_t>{0});
      bus_.Wait(milliseconds(10));
    }
    return true;
  }
  /// The last document that is complete.
  nlohmann::json Last() const {
    const std::string out = Complete();
    const std::size_t begin = out.rfind('\n');
    return nlohmann::json::parse(begin == std::string::npos ? out : out.substr(begin + 1));
  }

 private:
  /// The documents that are complete, without the last end of line.
  std::string Complete() const {
    std::string out = process_.Out();
    const std::size_t end = out.rfind('\n');
    out.erase(end == std::string::npos ? 0 : end);
    return out;
  }

  runtime::Bus& bus_;
  Background process_;
};

}  // namespace fogline::test
