#include "services/runtime/transport/lcm_sockets.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace fogline {
namespace {

constexpr runtime::LcmSockets::Reach kLoopback = runtime::LcmSockets::Reach::kLoopback;
constexpr runtime::LcmSockets::Reach kRoute = runtime::LcmSockets::Reach::kRoute;

class UdpSocket {
 public:
  ~UdpSocket() { close(socket_); }
  operator int() const { return socket_; }

 private:
  int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

sockaddr_in Address(const char* text, std::uint16_t port = 0) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, text, &address.sin_addr);
  return address;
}

/// The address of the interface over which a socket sends to multicast groups. 0.0.0.0 means that
/// the route decides.
std::string SendsOver(int socket) {
  in_addr address{};
  socklen_t size = sizeof(address);
  EXPECT_EQ(getsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &address, &size), 0);
  std::array<char, INET_ADDRSTRLEN> text{};
  return inet_ntop(AF_INET, &address, text.data(), static_cast<socklen_t>(text.size()));
}

TEST(LcmSocketsTest, SendOverLoopbackOnlyWhatIsToStayOnThisMachine) {
  for (const auto& [reach, expected] :
       {std::pair(kLoopback, "127.0.0.1"), std::pair(kRoute, "0.0.0.0")}) {
    const runtime::LcmSockets sockets(reach);
    const UdpSocket socket;
    const unsigned char ttl = 0;
    EXPECT_EQ(setsockopt(socket, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl)), 0);
    EXPECT_EQ(SendsOver(socket), expected);
  }
}

TEST(LcmSocketsTest, JoinNoGroupBecauseTheyOnlySend) {
  for (const auto reach : {kLoopback, kRoute}) {
    const UdpSocket socket;
    const ip_mreq membership{.imr_multiaddr = Address("239.255.76.67").sin_addr,
                             .imr_interface = {.s_addr = htonl(INADDR_LOOPBACK)}};
    const auto join = [&] {
      return setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership));
    };
    {
      const runtime::LcmSockets sockets(reach);
      EXPECT_EQ(join(), 0);
    }
    // Without an LcmSockets, the socket joins the group. The first call succeeds, so the socket was
    // not a member of the group before.
    EXPECT_EQ(join(), 0);
    EXPECT_NE(join(), 0);
  }
}

TEST(LcmSocketsTest, ReachAsFarAsTheirUrlSays) {
  EXPECT_EQ(runtime::ReachOf("udpm://239.255.76.67:7700?ttl=0"), kLoopback);
  EXPECT_EQ(runtime::ReachOf("udpm://"), kLoopback) << "LCM's own ttl is 0";
  EXPECT_EQ(runtime::ReachOf("udpm://239.255.76.67:7700?ttl=1"), kRoute);
  EXPECT_EQ(runtime::ReachOf("mpudpm://239.255.76.67:7700?ttl=0"), kRoute);
}

}  // namespace
}  // namespace fogline
