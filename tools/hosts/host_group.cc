#include "tools/hosts/host_group.h"

#include <cstddef>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/file.h"
#include "common/text.h"

namespace fogline::hosts {
namespace {

// Longest wait for the first message of a machine. It includes five seconds of ssh's
// ConnectTimeout, and time for the login on a busy machine.
constexpr Duration kGreetLimit = milliseconds(20'000);
// Longest wait for the result of a check. A check sends messages for some milliseconds, and a
// machine without a route reports this immediately. The limit is long enough for a busy machine.
constexpr Duration kCheckLimit = milliseconds(20'000);
// The file of a key has 64 digits and a line feed.
constexpr std::size_t kMaxKeyBytes = 1024;

/// The text of the key's file; "" if there is no key. @throws InputError
std::string KeyText(const runtime::TrafficOptions& traffic) {
  if (traffic.key_file.empty()) return "";
  FileText key = ReadFile(traffic.key_file, kMaxKeyBytes);
  if (key.error.empty()) return std::move(key.text);
  throw InputError(fmt::format("{}: error: {}", PathText(traffic.key_file), key.error));
}

}  // namespace

HostGroup::HostGroup(const RunPlan& plan) : plan_(plan) {
  for (const HostPlan& host : plan_.hosts) {
    hosts_.push_back(std::make_unique<RemoteHost>(host, plan_.ssh));
  }
  const TimePoint end = Clock::now() + kGreetLimit;
  for (const auto& host : hosts_) host->Greet(end);
}

std::string HostGroup::RelayPlace() const {
  if (!plan_.relay_at.empty()) {
    const bool has_port = plan_.relay_at.find(':') != std::string::npos;
    return has_port ? plan_.relay_at : plan_.relay_at + ":0";
  }
  const std::string& address = hosts_.front()->own_address();
  for (const auto& host : hosts_) {
    if (host->own_address() == address && !address.empty()) continue;
    throw std::runtime_error(fmt::format(
        "{} sees this machine at {}, {} at {}; give an address that all can reach: --relay-at "
        "ADDRESS",
        hosts_.front()->name(), address.empty() ? "an unknown address" : address, host->name(),
        host->own_address().empty() ? "an unknown address" : host->own_address()));
  }
  if (address.find(':') != std::string::npos) {
    throw std::runtime_error(
        fmt::format("{} reaches this machine over IPv6 ({}), but a relay needs IPv4; give an IPv4 "
                    "address: --relay-at ADDRESS",
                    hosts_.front()->name(), address));
  }
  return address + ":0";
}

void HostGroup::Check(const std::string& url, const runtime::TrafficOptions& traffic,
                      Duration silence) {
  const RunOnHost run{.url = url, .key = KeyText(traffic), .silence_s = Seconds(silence)};
  for (const auto& host : hosts_) host->BeginCheck(run);
  const TimePoint end = Clock::now() + kCheckLimit;
  for (const auto& host : hosts_) host->EndCheck(end);
}

std::unique_ptr<HostGroup> Connect(const RunPlan& plan) {
  return plan.empty() ? nullptr : std::make_unique<HostGroup>(plan);
}

void HostGroup::KeepAlive() const {
  for (const auto& host : hosts_) host->Look();
}

processes::RolePlace* HostGroup::PlaceOf(Role role) const {
  const auto place = plan_.places.find(role);
  return place == plan_.places.end() ? nullptr : hosts_[place->second].get();
}

std::vector<processes::RolePlace*> HostGroup::places() const {
  std::vector<processes::RolePlace*> places;
  for (const auto& host : hosts_) places.push_back(host.get());
  return places;
}

}  // namespace fogline::hosts
