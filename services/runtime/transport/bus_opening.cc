// Opens the network of a bus. If the network cannot be opened, the error says why.
#include <lcm/lcm.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "common/file.h"
#include "common/process/console.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/kernel_limits.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/multicast_route.h"
#include "services/runtime/transport/tcpq_client.h"

namespace fogline::runtime {
namespace {

/// Adds ttl=0 to a udpm URL without a ttl, so that its traffic stays on this machine.
std::string WithDefaults(const std::string& url) {
  if (!url.starts_with("udpm://") || url.find("ttl=") != std::string::npos) return url;
  return fmt::format("{}{}ttl=0", url, url.find('?') == std::string::npos ? '?' : '&');
}

/// @throws NetworkAway if this machine has no route for the multicast of the URL, InputError if the
///     URL has the address of one machine
void RequireMulticast(const std::string& url) {
  const std::string why = WhyNoMulticast(url);
  if (why.empty()) return;
  const std::string error = fmt::format("error: {}", why);
  if (IsMulticast(GroupOf(url).value())) throw NetworkAway(error);
  throw InputError(error);
}

/// @throws InputError, NetworkAway, std::runtime_error that say why LCM cannot open the network
[[noreturn]] void FailToOpen(const std::string& url) {
  ThrowIfExhausted(LackOfDescriptors(), url);  // LCM does not say why it failed
  RequireMulticast(url);                       // the route may have vanished meanwhile
  throw InputError(fmt::format("error: LCM cannot open \"{}\"", url));
}

/// The channel on which LCM tests a network before it receives. A bus makes the same test.
constexpr const char* kSelfTest = "LCM_SELF_TEST";

}  // namespace

Bus::Bus(const std::string& url) : url_(WithDefaults(url)), in_memory_(IsInMemory(url)) {
  if (url_.starts_with("tcpq://")) {
    tcpq_ = std::make_unique<tcpq::Client>(url_);
    url_ = tcpq_->url();
    fd_ = tcpq_->fd();
    return;
  }
  // If the URL is empty, LCM uses its own default URL, which Fogline has not checked.
  if (url_.empty()) throw InputError("error: the LCM URL is empty");
  // For a wrong URL, LCM would print a line of its own. LCM would even open some wrong URLs.
  if (const std::string why = WhyWrongUrl(url); !why.empty()) {
    throw InputError(fmt::format("error: {}: {}", url, why));
  }
  RequireMulticast(url_);
  OpenLcm();
  static bool warned = false;
  if (!filtered_ && !std::exchange(warned, true)) {
    Notice(
        fmt::format("warning: the kernel accepts no socket filter, so every message to {} wakes "
                    "this process (`fogline doctor` says more)",
                    url_));
  }
}

Bus::~Bus() = default;

void Bus::DestroyLcm::operator()(_lcm_t* lcm) const { lcm_destroy(lcm); }

void Bus::OpenLcm() {
  const bool udpm = url_.starts_with("udpm://");
  const LcmSockets::Reach reach = ReachOf(url_);
  {
    std::optional<LcmSockets> sockets;
    if (udpm) sockets.emplace(reach);
    lcm_.reset(lcm_create(url_.c_str()));
  }
  if (lcm_ == nullptr) FailToOpen(url_);
  if (udpm) {
    OpenInbox();
    TestInbox();
    if (reach == LcmSockets::Reach::kRoute) membership_.emplace(inbox_->socket(), url_);
    return;
  }
  // LCM receives in its own thread.
  fd_ = lcm_get_fileno(lcm_.get());
  if (fd_ < 0) FailToOpen(url_);
}

void Bus::OpenInbox() {
  try {
    inbox_.emplace(url_, ChannelFilter({{kSelfTest}}));
  } catch (const std::system_error& error) {
    ThrowIfExhausted(error.code().value(), url_);
    RequireMulticast(url_);  // the route may have vanished meanwhile
    throw InputError(
        fmt::format("error: cannot listen to \"{}\": {}", url_, error.code().message()));
  }
  fd_ = inbox_->fd();
  filtered_ = inbox_->filtered();
}

/// Tests that a message of this bus comes back to this bus. After the test, the kernel's socket
/// filter accepts no messages until a handler subscribes.
/// @throws NetworkClosed if the message does not come back
void Bus::TestInbox() {
  constexpr int kTries = 10;
  constexpr Duration kWait = milliseconds(100);
  std::array<std::uint8_t, 16> own{};
  randombytes_buf(own.data(), own.size());
  bool heard = false;
  std::string why = "perhaps a firewall drops it";
  for (int i = 0; i < kTries && !heard; ++i) {
    errno = 0;
    if (lcm_publish(lcm_.get(), kSelfTest, own.data(), own.size()) != 0) why = std::strerror(errno);
    const TimePoint end = Clock::now() + kWait;
    while (!heard && Clock::now() < end && inbox_->Wait(end - Clock::now())) {
      const auto message = inbox_->Take();
      heard = message->channel == kSelfTest && std::ranges::equal(message->data, own);
    }
  }
  if (!heard) {
    RequireMulticast(url_);  // the route may have vanished meanwhile
    const MulticastAddress network = ParseMulticastUrl(url_).value();
    throw NetworkClosed(
        fmt::format("error: a message to {}:{} does not come back to this machine: {} (`fogline "
                    "doctor` says more)",
                    network.group, network.port, why));
  }
  Filter(ChannelFilter({}));
  // The buffer may contain test messages of other processes. These messages are dropped.
  for (int i = 0; i < kDrained && inbox_->Wait(Duration::zero()); ++i) inbox_->Take();
}

}  // namespace fogline::runtime
