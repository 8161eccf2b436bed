#include "services/runtime/transport/udpm/fresh_url.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <deque>
#include <set>
#include <vector>

#include "services/runtime/transport/lcm_url.h"

namespace fogline {
namespace {

/// A socket on a UDP port; -1 if the port is taken. @param shares whether the socket shares its
/// port with other sockets, as LCM's sockets do
int SocketOn(std::uint16_t port, bool shares) {
  const int receiver = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int yes = shares ? 1 : 0;
  setsockopt(receiver, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (bind(receiver, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
    return receiver;
  }
  close(receiver);
  return -1;
}

TEST(FreshMulticastUrlTest, DrawsAPortOnWhichNoSocketReceives) {
  // GIVEN sockets on 600 of the 12,000 ports. Like LCM's sockets, they let other sockets share the
  // port.
  std::set<std::uint16_t> taken;
  std::vector<int> sockets;
  for (int i = 0; i < 600; ++i) {
    const auto port = static_cast<std::uint16_t>(20000 + 20 * i);
    const int receiver = SocketOn(port, /*shares=*/true);
    if (receiver < 0) continue;
    sockets.push_back(receiver);
    taken.insert(port);
  }
  EXPECT_GT(taken.size(), 500);
  // WHEN 1,000 URLs are made, THEN none of them has one of these 600 ports
  for (int i = 0; i < 1000; ++i) {
    const auto drawn = runtime::ParseMulticastUrl(runtime::FreshMulticastUrl());
    ASSERT_TRUE(drawn);
    EXPECT_FALSE(taken.contains(drawn->port)) << drawn->port;
  }
  for (const int receiver : sockets) close(receiver);
}

TEST(FreshMulticastUrlTest, ReservesThePortsOfItsLastUrls) {
  // WHEN a process has many URLs of its own
  std::set<std::uint16_t> ports;
  std::deque<std::uint16_t> last;
  for (int i = 0; i < 200; ++i) {
    last.push_back(runtime::ParseMulticastUrl(runtime::FreshMulticastUrl())->port);
    if (last.size() > runtime::kReservedPorts) last.pop_front();
  }
  // THEN the ports of the last kReservedPorts URLs differ, although no socket of a network uses
  // them yet
  ports.insert(last.begin(), last.end());
  EXPECT_EQ(ports.size(), runtime::kReservedPorts);
  for (const std::uint16_t port : ports) {
    // AND no other process can draw these ports, but LCM's sockets can use them
    EXPECT_EQ(SocketOn(port, /*shares=*/false), -1) << port;
    const int receiver = SocketOn(port, /*shares=*/true);
    EXPECT_GE(receiver, 0) << port;
    close(receiver);
  }
}

}  // namespace
}  // namespace fogline
