// Datagrams that no LCM program sends.
#pragma once

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <string_view>

#include "services/runtime/transport/lcm_url.h"

namespace fogline::test {

/// Sends bytes, unchanged, to the group and port of a udpm:// URL, on this machine only.
inline void SendDatagram(const std::string& url, std::string_view bytes) {
  const auto network = runtime::ParseMulticastUrl(url);
  ASSERT_TRUE(network);
  const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_addr.s_addr = inet_addr(network->group.c_str());
  group.sin_port = htons(network->port);
  const in_addr loopback{.s_addr = htonl(INADDR_LOOPBACK)};
  setsockopt(sender, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof(loopback));
  constexpr unsigned char kThisMachine = 0;
  setsockopt(sender, IPPROTO_IP, IP_MULTICAST_TTL, &kThisMachine, sizeof(kThisMachine));
  EXPECT_EQ(sendto(sender, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&group),
                   sizeof(group)),
            static_cast<ssize_t>(bytes.size()));
  close(sender);
}

}  // namespace fogline::test
