#include "services/runtime/transport/lcm_sockets.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/channel_filter.h"

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

int Bind(runtime::LcmSockets& sockets, int socket) {
  const sockaddr_in address = Address("127.0.0.1");
  return sockets.OnBind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
}

TEST(LcmSocketsTest, KnowWhetherEveryOneThatReceivesIsFiltered) {
  runtime::LcmSockets sockets(runtime::ChannelFilter({}), kRoute);
  EXPECT_FALSE(sockets.filtered()) << "there is none";
  const UdpSocket one;
  EXPECT_EQ(Bind(sockets, one), 0);
  EXPECT_TRUE(sockets.filtered());
  Bind(sockets, -1);
  const UdpSocket other;
  EXPECT_EQ(Bind(sockets, other), 0);
  EXPECT_FALSE(sockets.filtered());
}

TEST(LcmSocketsTest, AreFilteredBeforeTheyAreBound) {
  const std::string url = runtime::FreshMulticastUrl();
  const runtime::LcmSockets sockets(runtime::ChannelFilter({{"LCM_SELF_TEST"}}), kRoute);
  const runtime::Bus memory("memq://");
  EXPECT_TRUE(sockets.receiving().empty());
  lcm_t* network = lcm_create(url.c_str());
  ASSERT_NE(network, nullptr);
  EXPECT_GE(lcm_get_fileno(network), 0);
  ASSERT_FALSE(sockets.receiving().empty());
  for (const int socket : sockets.receiving()) {
    socklen_t instructions = 0;
    EXPECT_EQ(getsockopt(socket, SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions), 0);
    EXPECT_GT(instructions, 0U);
  }
  lcm_destroy(network);
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
    const runtime::LcmSockets sockets({}, reach);
    const UdpSocket socket;
    const unsigned char ttl = 0;
    EXPECT_EQ(setsockopt(socket, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl)), 0);
    EXPECT_EQ(SendsOver(socket), expected);
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
