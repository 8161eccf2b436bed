// A sender of LCM packets. The test chooses the number of each packet, so it can leave out numbers.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "services/runtime/transport/lcm_url.h"

namespace fogline::test {

/// Sends packets over loopback, with ttl=0, to the multicast group of a udpm:// URL.
class NumberedSender {
 public:
  explicit NumberedSender(const std::string& url) : fd_(socket(AF_INET, SOCK_DGRAM, 0)) {
    const auto network = runtime::ParseMulticastUrl(url);
    const in_addr loopback{.s_addr = htonl(INADDR_LOOPBACK)};
    const int ttl = 0;
    setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof(loopback));
    setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl));
    sockaddr_in group{};
    group.sin_family = AF_INET;
    group.sin_port = htons(network->port);
    inet_pton(AF_INET, network->group.c_str(), &group.sin_addr);
    EXPECT_EQ(connect(fd_, reinterpret_cast<const sockaddr*>(&group), sizeof(group)), 0);
  }
  ~NumberedSender() { close(fd_); }
  NumberedSender(const NumberedSender&) = delete;
  NumberedSender& operator=(const NumberedSender&) = delete;

  /// Sends a message of one byte.
  void Send(std::uint32_t number, std::string_view channel) const {
    std::string packet = "LC02";
    for (const int shift : {24, 16, 8, 0}) packet += static_cast<char>(number >> shift & 0xff);
    packet += channel;
    packet += std::string("\0x", 2);
    EXPECT_EQ(send(fd_, packet.data(), packet.size(), 0), static_cast<ssize_t>(packet.size()));
  }

  /// The address of this sender, as `fogline top` writes it.
  std::string Address() const {
    sockaddr_in own{};
    socklen_t size = sizeof(own);
    getsockname(fd_, reinterpret_cast<sockaddr*>(&own), &size);
    return std::string(inet_ntoa(own.sin_addr)) + ":" + std::to_string(ntohs(own.sin_port));
  }

 private:
  int fd_;
};

}  // namespace fogline::test
