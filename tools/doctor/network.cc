// Examines the network that LCM uses: route, multicast, buffers.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/kernel_limits.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/multicast_route.h"
#include "services/runtime/transport/tcpq_client.h"
#include "services/runtime/wire/channel_filter.h"
#include "tools/doctor/doctor_findings.h"

namespace fogline::doctor {
namespace {

using Level = Finding::Level;

bool ExamineGroup(const std::string& url, const std::string& group, Findings& findings) {
  if (runtime::IsMulticast(group)) return true;
  findings.push_back({"multicast_group", Level::kProblem,
                      fmt::format("{} is no multicast group (224.0.0.0 to 239.255.255.255)", group),
                      runtime::InPlaceOfUnicast(url)});
  return false;
}

std::string RouteRemedy() {
  return fmt::format(
      "as root: {} for this machine only; for other machines replace lo with the network's "
      "interface",
      runtime::kLoopbackRoute);
}

/// Examines traffic that stays on this machine. @return whether such traffic can be sent
bool ExamineOwnMachine(const std::string& url, const std::string& group, Findings& findings) {
  if (const std::string why = runtime::WhyNoMulticast(url); !why.empty()) {
    findings.push_back({"multicast_route", Level::kProblem, why, "as root: ip link set lo up"});
    return false;
  }
  const std::string error = runtime::RouteError(group);
  findings.push_back(
      error.empty()
          ? Finding{"multicast_route", Level::kOk,
                    fmt::format("{} goes over loopback and stays on this machine (ttl=0)", group),
                    ""}
          : Finding{"multicast_route", Level::kWarning,
                    fmt::format("{} goes over loopback and stays on this machine (ttl=0), but "
                                "LCM's own programs need a route, and there is none: {}",
                                group, error),
                    RouteRemedy(), RouteRecipes("lo")});
  return true;
}

bool ExamineRoute(const std::string& group, int ttl, Findings& findings) {
  const std::string error = runtime::RouteError(group);
  if (!error.empty()) {
    findings.push_back({"multicast_route", Level::kProblem,
                        fmt::format("no route to {}: {}", group, error), RouteRemedy(),
                        RouteRecipes(ttl > 0 ? InterfaceToOthers() : "lo")});
    return false;
  }
  const std::string interface =
      runtime::RouteInterface(runtime::KernelTable("/proc/net/route"), group);
  const std::string through = interface.empty() ? "a route that is not in the main table"
                                                : fmt::format("interface {}", interface);
  if (ttl > 0 && interface == "lo") {
    findings.push_back(
        {"multicast_route", Level::kProblem,
         fmt::format("{} goes through lo: with ttl={} no other machine hears it", group, ttl),
         fmt::format("as root: ip route replace 239.0.0.0/8 dev {}", InterfaceToOthers()),
         RouteRecipes(InterfaceToOthers())});
    return true;
  }
  findings.push_back({"multicast_route", Level::kOk,
                      fmt::format("{} goes through {}, {}", group, through,
                                  ttl > 0 ? fmt::format("to other machines (ttl={})", ttl)
                                          : "and stays on this machine (ttl=0)"),
                      ""});
  return true;
}

/// Sends a message from `here` to `there` and back.
/// @param back is set to true by a subscription of `here` when the message comes back
/// @return the time for both ways; zero if the message was lost
Duration RoundTrip(runtime::Bus& here, runtime::Bus& there, bool& back) {
  constexpr Duration kLimit = milliseconds(300);
  const std::vector<std::uint8_t> message(runtime::kHeaderEnd);
  const TimePoint began = Clock::now();
  back = false;
  here.Publish("FOGLINE_PING", message);
  do {  // looks at least once, even if this process has paused for longer than the limit
    there.Wait(milliseconds(1));
    here.Wait(milliseconds(1));
  } while (!back && Clock::now() - began < kLimit);
  return back ? Clock::now() - began : Duration::zero();
}

/// The times that messages take from one connection on this network to another one and back; empty
/// if no message comes back.
std::vector<double> RoundTripsUs(const std::string& url) {
  constexpr int kRounds = 50;
  runtime::Bus here(url);
  runtime::Bus there(url);
  bool back = false;
  there.Subscribe("FOGLINE_PING", [&there](runtime::Arrival& arrival) {
    there.Publish("FOGLINE_PONG", arrival.bytes());
  });
  here.Subscribe("FOGLINE_PONG", [&back](runtime::Arrival&) { back = true; });
  std::vector<double> times_us;
  for (int i = 0; i < kRounds; ++i) {
    const Duration time = RoundTrip(here, there, back);
    if (time > Duration::zero()) {
      times_us.push_back(std::chrono::duration<double, std::micro>(time).count());
    } else if (times_us.empty()) {
      break;
    }
  }
  std::ranges::sort(times_us);
  return times_us;
}

/// Examines whether this machine receives its own multicast messages. The function sends real LCM
/// messages to the group and port of the URL, because a firewall may pass only this port.
void ExamineLoopback(const runtime::MulticastAddress& address, Findings& findings) {
  const std::string& group = address.group;
  const std::uint16_t port = address.port;
  const int ttl = std::min(address.ttl, 1);
  std::vector<double> times_us;
  try {
    times_us = RoundTripsUs(fmt::format("udpm://{}:{}?ttl={}", group, port, ttl));
  } catch (const runtime::NetworkClosed&) {  // times_us is empty: the code below reports this
  } catch (const InputError& error) {
    std::string_view why = error.what();
    constexpr std::string_view kPrefix = "error: ";
    if (why.starts_with(kPrefix)) why.remove_prefix(kPrefix.size());
    findings.push_back({"multicast_loopback", Level::kProblem, std::string(why), ""});
    return;
  }
  if (times_us.empty()) {
    findings.push_back(
        {"multicast_loopback", Level::kProblem,
         fmt::format("a message to {}:{} does not come back to this machine", group, port),
         fmt::format("let the firewall pass UDP to {}:{} and IGMP (nft list ruleset; iptables -L)",
                     group, port),
         FirewallRecipes(group, port)});
    return;
  }
  findings.push_back({"multicast_loopback", Level::kOk,
                      fmt::format("LCM messages go to {}:{} and back in {:.0f} us (median of {})",
                                  group, port, times_us[times_us.size() / 2], times_us.size()),
                      ""});
}

void ExamineReceiveBuffer(int wanted, Findings& findings) {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  runtime::SetReceiveBuffer(probe, wanted);
  const int granted = runtime::ReceiveBuffer(probe);
  close(probe);
  if (granted >= wanted) {
    findings.push_back({"receive_buffer", Level::kOk,
                        fmt::format("the kernel grants receive buffers of {} bytes", granted), ""});
    return;
  }
  findings.push_back(
      {"receive_buffer", Level::kWarning,
       fmt::format("receive buffers have {} bytes instead of {}: bursts are lost and sent again",
                   granted, wanted),
       fmt::format("as root: sysctl -w net.core.rmem_max={0}; to keep it, "
                   "net.core.rmem_max={0} in /etc/sysctl.d/fogline.conf",
                   wanted)});
}

/// Sends a fragment and then a whole message to a socket that has the filter of a Bus. The filter
/// should refuse the fragment. @return the beginning of the first datagram that the socket
/// receives; "" if it receives none
std::string FilteredFirst() {
  constexpr std::string_view kFragment("LC03\0\0\0\1\0\0\0\0\0\0\0\0\0\0\0\1A\0", 22);
  constexpr std::string_view kMessage("LC02\0\0\0\1A\0", 10);
  const int receiver = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  auto* here = reinterpret_cast<sockaddr*>(&address);
  std::array<char, 4> magic{};
  ssize_t received = 0;
  if (bind(receiver, here, size) == 0 && getsockname(receiver, here, &size) == 0 &&
      runtime::AttachFilter(receiver, runtime::AnyChannelFilter())) {
    // The socket sends to itself, and on one machine a datagram arrives immediately.
    sendto(receiver, kFragment.data(), kFragment.size(), 0, here, size);
    sendto(receiver, kMessage.data(), kMessage.size(), 0, here, size);
    received = recv(receiver, magic.data(), magic.size(), 0);
  }
  close(receiver);
  return {magic.data(), static_cast<std::size_t>(std::max<ssize_t>(received, 0))};
}

void ExamineFilter(const std::string& url, Findings& findings) {
  if (!url.starts_with("udpm://")) {
    findings.push_back({"socket_filter", Level::kWarning,
                        "mpudpm has no filter, so fragments reach LCM's parser, which checks their "
                        "bounds wrongly; --key is refused",
                        "use udpm:// instead of mpudpm://"});
  } else if (FilteredFirst() == "LC02") {
    findings.push_back({"socket_filter", Level::kOk,
                        "the kernel keeps fragments and noise from every process", ""});
  } else {
    findings.push_back({"socket_filter", Level::kWarning,
                        "the kernel accepts no socket filter, so every message on the network "
                        "wakes every process; --key is refused",
                        "allow setsockopt(SO_ATTACH_FILTER) in the sandbox or container, or use "
                        "--transport tcpq"});
  }
}

void ExamineRelay(const std::string& url, Findings& findings) {
  try {
    const runtime::tcpq::Client client(url);
    findings.push_back(
        {"relay", Level::kOk, fmt::format("the relay {} answers", client.url()), ""});
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    findings.push_back({"relay", Level::kProblem, error.what(), "fogline-relay --help"});
  }
}

}  // namespace

void ExamineNetwork(const std::string& url, Findings& findings) {
  if (url.starts_with("tcpq://")) return ExamineRelay(url, findings);
  const runtime::MulticastAddress address = runtime::MulticastAddressOf(url);
  if (ExamineGroup(url, address.group, findings)) {
    // udpm needs no route if ttl=0. mpudpm needs a route for every value of the ttl.
    const bool here = address.ttl == 0 && url.starts_with("udpm://");
    if (here ? ExamineOwnMachine(url, address.group, findings)
             : ExamineRoute(address.group, address.ttl, findings)) {
      ExamineLoopback(address, findings);
    }
  }
  ExamineFilter(url, findings);
  ExamineReceiveBuffer(address.receive_buffer.value_or(runtime::kEnoughBuffer), findings);
}

}  // namespace fogline::doctor
