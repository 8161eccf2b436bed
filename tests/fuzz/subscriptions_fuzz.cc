// The relay's subscriptions. Input: for each action a byte (add, remove or ask) and a datagram with
// the pattern or the channel.
#include <algorithm>
#include <optional>
#include <stdexcept>

#include "tests/fuzz/fuzz.h"
#include "tools/relay/subscriptions.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxSubscriptions = 8;
constexpr std::size_t kMaxActions = 16;
constexpr std::size_t kMaxPattern = 1024;  // as in runtime::tcpq::Limits
constexpr std::size_t kMaxChannel = 63;

bool IsPlain(std::string_view pattern) {
  return std::ranges::all_of(pattern, [](char c) { return (c >= 'A' && c <= 'Z') || c == '_'; });
}

/// Whether a subscription matches the channel; nullopt if the search would take too long.
std::optional<bool> Ask(relay::Subscriptions& subscriptions, std::string_view channel) {
  try {
    return subscriptions.Match(channel, TimePoint{});
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

/// The subscriptions of one client, and the patterns that the client should have.
class Client {
 public:
  void Add(std::string_view pattern) {
    const std::string error = subscriptions_.Add(pattern);
    if (patterns_.size() == kMaxSubscriptions) {
      Demand(!error.empty(), "a subscription beyond the limit is refused");
    }
    if (error.empty()) patterns_.emplace_back(pattern);
    Demand(!IsPlain(pattern) || error.empty() || patterns_.size() == kMaxSubscriptions,
           "a channel's name can be subscribed to");
  }

  void Remove(std::string_view pattern) {
    subscriptions_.Remove(pattern);
    if (const auto found = std::ranges::find(patterns_, pattern); found != patterns_.end()) {
      patterns_.erase(found);
    }
  }

  void AskFor(std::string_view channel) {
    const std::optional<bool> answer = Ask(subscriptions_, channel);
    if (!answer) return;
    relay::Subscriptions fresh(kMaxSubscriptions);
    for (const std::string& pattern : patterns_) fresh.Add(pattern);
    Demand(Ask(fresh, channel) == answer, "an answer depends on the subscriptions in force only");
    Demand(Ask(subscriptions_, channel) == answer, "asked again, the same");
    if (std::ranges::all_of(patterns_, IsPlain)) {
      Demand((std::ranges::find(patterns_, channel) != patterns_.end()) == *answer,
             "a channel's name stands for itself");
    }
    if (*answer) Took();
  }

 private:
  relay::Subscriptions subscriptions_{kMaxSubscriptions};
  std::vector<std::string> patterns_;
};

void Act(std::uint8_t action, runtime::Bytes bytes, Client& client) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  text = text.substr(0, std::min(text.find('\0'), kMaxPattern));  // names in frames have no zeros
  switch (action % 4) {
    case 0:
      return client.Add(text);
    case 1:
      return client.Remove(text);
    default:
      return client.AskFor(text.substr(0, kMaxChannel));
  }
}

}  // namespace

std::vector<Input> Seeds() {
  const auto script = [](std::initializer_list<std::pair<std::uint8_t, std::string_view>> actions) {
    Input input;
    for (const auto& [action, text] : actions) {
      input.push_back(action);
      AddDatagram({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, input);
    }
    return input;
  };
  return {
      script({{0, "TRUTH"}, {0, "HOST_.*"}, {2, "TRUTH"}, {2, "HOST_EGO"}, {2, "RUN"}}),
      script({{0, ".*"}, {2, "RUN"}, {1, ".*"}, {2, "RUN"}}),
      script({{0, "(RUN|STATUS|RESEND)"}, {0, "[A-Z]+[^0-9]{2,5}$"}, {2, "STATUS"}, {2, "LIDAR"}}),
      script({{0, "(A+)+B"}, {0, "(?=R)\\w*(?:N)\\1?"}, {2, "AAAAAAAAAAAA"}, {2, "RUN"}})};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline::fuzz;
  Client client;
  Cutter cutter({data, size});
  for (std::size_t i = 0; i < kMaxActions && !cutter.empty(); ++i) {
    const std::uint8_t action = cutter.Byte();
    Act(action, cutter.Datagram(), client);
  }
  return 0;
}
