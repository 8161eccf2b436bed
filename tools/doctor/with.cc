// Examines whether two machines hear each other. `fogline doctor --with` (a doctor) runs on each
// machine, and tells the other doctor which doctor it hears.
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/this_process.h"
#include "common/text.h"
#include "services/runtime/process/version.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/wire/refusals.h"
#include "tools/doctor/doctor_findings.h"

namespace fogline::doctor {
namespace {

using Level = Finding::Level;

constexpr std::string_view kChannel = "FOGLINE_DOCTOR";
constexpr Duration kSayEvery = milliseconds(100);
// After the first message of the other doctor, this doctor waits this long for a message in which
// the other doctor says that it hears this doctor. If no such message comes, the other doctor does
// not hear this doctor. In this time this doctor sends 30 messages, so at least one arrives even on
// a network that loses most messages.
constexpr Duration kAnswers = milliseconds(3000);
// A doctor that knows the result continues to send for this time. So the other doctor learns the
// result, too.
constexpr Duration kLinger = milliseconds(1500);

/// The IPv4 addresses of a name; empty if the name cannot be resolved.
std::vector<in_addr_t> AddressesOf(const std::string& name) {
  std::vector<in_addr_t> addresses;
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(name.c_str(), nullptr, &hints, &found) != 0) return addresses;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    addresses.push_back(reinterpret_cast<const sockaddr_in*>(one->ai_addr)->sin_addr.s_addr);
  }
  freeaddrinfo(found);
  return addresses;
}

/// Whether a name or an address means this machine.
bool IsThisMachine(const std::string& name) {
  if (name == HostName()) return true;
  const std::vector<in_addr_t> meant = AddressesOf(name);
  ifaddrs* interfaces = nullptr;
  if (meant.empty() || getifaddrs(&interfaces) != 0) return false;
  bool found = false;
  for (const ifaddrs* one = interfaces; one != nullptr && !found; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    const in_addr_t own = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr;
    found = std::ranges::find(meant, own) != meant.end();
  }
  freeifaddrs(interfaces);
  return found;
}

/// Exchanges messages with the doctor on the other machine. A message is a STATUS. Its waiting_for
/// is the name of the other machine, as the user gave it. Its input is the instance of the other
/// doctor, if the other doctor was heard.
class Conversation {
 public:
  Conversation(const std::string& url, std::string host) : bus_(url), host_(std::move(host)) {
    own_.role = "doctor";
    own_.host = HostName();
    own_.pid = getpid();
    own_.version = runtime::VersionText();
    own_.type_fingerprint = TypeFingerprint();
    own_.waiting_for = host_;
    // The instance is random, so that no other doctor has the same instance, even on a machine of
    // the same name.
    std::random_device random;
    own_.instance = static_cast<std::int64_t>(random()) << 31 | random() >> 1;
    bus_.Subscribe(kChannel, [this](runtime::Bytes bytes) { Hear(bytes); });
  }

  /// Sends and receives messages until the result is known, or the time is over.
  void Run(Duration limit) {
    const TimePoint began = Clock::now();
    std::optional<TimePoint> known;
    for (TimePoint now = began; now - began < limit; now = Clock::now()) {
      Say(now);
      bus_.Wait(kSayEvery);
      if (WasInterrupted()) throw Interrupted("interrupted while the other machine was awaited");
      const bool is_known = hears_us_ || (heard_ && now - *heard_ > kAnswers);
      if (is_known && !known) known = now;
      if (known && now - *known > kLinger) return;
    }
  }

  /// The other doctor's last message; nullopt if none has come.
  const std::optional<status_t>& other() const { return other_; }
  bool hears_us() const { return hears_us_; }

 private:
  void Hear(runtime::Bytes bytes) {
    status_t heard{};
    if (runtime::Examine(bytes, heard) != nullptr || heard.instance == own_.instance) return;
    const bool is_known = other_ && other_->instance == heard.instance;
    if (!is_known && heard.host != host_ && !MeansUs(heard.waiting_for)) return;
    const std::string us = std::to_string(own_.instance);
    hears_us_ = hears_us_ || std::ranges::find(heard.input, us) != heard.input.end();
    if (!heard_) heard_ = Clock::now();
    other_ = std::move(heard);
    own_.input = {std::to_string(other_->instance)};
    own_.input_state = {status_t::INPUT_OK};
    own_.input_age_us = {0};
    own_.input_rate_hz = {0};
    own_.input_late = {0};
    own_.num_inputs = 1;
  }

  /// Whether `name`, the machine for which another doctor waits, is this machine. The name comes
  /// from the network, and resolving a name takes time, so only few names are resolved.
  bool MeansUs(const std::string& name) {
    constexpr std::size_t kMostNames = 8;
    const auto known = is_us_.find(name);
    if (known != is_us_.end()) return known->second;
    return is_us_.size() < kMostNames && (is_us_[name] = IsThisMachine(name));
  }

  void Say(TimePoint now) {
    if (now < say_at_) return;
    say_at_ = now + kSayEvery;
    ++own_.sequence;
    runtime::Encode(own_, buffer_);
    bus_.Publish(kChannel, buffer_);
  }

  runtime::Bus bus_;
  std::string host_;
  status_t own_{};
  std::optional<status_t> other_;
  std::optional<TimePoint> heard_;  // when the other doctor was first heard
  bool hears_us_ = false;
  std::map<std::string, bool> is_us_;  // for each resolved name, whether it means this machine
  TimePoint say_at_{};
  std::vector<std::uint8_t> buffer_;
};

/// The finding about whether each of the two machines hears the other one.
Finding Judge(const Conversation& talk, const std::string& url, const std::string& host,
              Duration limit) {
  const std::string here = HostName();
  const auto address = runtime::ParseMulticastUrl(url);
  const auto recipes =
      address ? FirewallRecipes(address->group, address->port) : std::vector<Recipe>();
  if (!talk.other()) {
    return {
        "with", Level::kProblem,
        fmt::format("{0} -> {1} fails: in {2:g} s no message of a doctor on {0} has come", host,
                    here, Seconds(limit)),
        fmt::format("start `fogline doctor --with {} --lcm-url '{}'` on {}; if it runs, its "
                    "output says whether {} -> {} fails, too. Then examine the route of {}, and "
                    "the firewall of this machine",
                    here, url, host, here, host, host),
        recipes};
  }
  const std::string other = Printable(talk.other()->host);
  if (!talk.hears_us()) {
    return {
        "with", Level::kProblem,
        fmt::format("{0} -> {1} fails: messages of {1} come here, but {1} hears nothing from "
                    "this machine",
                    here, other),
        fmt::format("examine the route of this machine (ip route get {}), and the firewall of {}",
                    address ? address->group : "GROUP", other),
        recipes};
  }
  return {"with", Level::kOk, fmt::format("{} and {} hear each other on {}", here, other, url), ""};
}

}  // namespace

void ExamineWith(const std::string& url, const std::string& host, Duration limit,
                 Findings& findings) {
  const auto address = runtime::ParseMulticastUrl(url);
  if (address && address->ttl == 0) {
    findings.push_back(
        {"with", Level::kProblem,
         fmt::format("with ttl=0 no message of this machine reaches {}", host),
         fmt::format("use udpm://{}:{}?ttl=1 on both machines", address->group, address->port)});
    return;
  }
  Conversation talk(url, host);
  talk.Run(limit);
  findings.push_back(Judge(talk, url, host, limit));
  if (!talk.other()) return;
  const std::string version = Printable(talk.other()->version);
  const bool same = version == runtime::VersionText();
  findings.push_back({"with_version", same ? Level::kOk : Level::kProblem,
                      fmt::format("{} has version {}", Printable(talk.other()->host), version),
                      same ? "" : "use the same build on every machine"});
}

}  // namespace fogline::doctor
