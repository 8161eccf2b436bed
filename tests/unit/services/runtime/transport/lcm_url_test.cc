#include "services/runtime/transport/lcm_url.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>

#include <array>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "services/graph.h"
#include "services/runtime/transport/tcpq_url.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/environment_url.h"

namespace fogline {
namespace {

TEST(LcmUrlTest, IsTheOneGivenThenThatOfTheEnvironmentThenLcmsOwn) {
  const test::EnvironmentUrl environment;
  environment.Set("udpm://239.1.2.3:4000");
  EXPECT_EQ(runtime::NetworkUrl("tcpq://127.0.0.1"), "tcpq://127.0.0.1");
  EXPECT_EQ(runtime::NetworkUrl(""), "udpm://239.1.2.3:4000");
  EXPECT_EQ(runtime::MeetingUrl(), "udpm://239.1.2.3:4000");
  for (const bool empty : {true, false}) {
    if (empty) environment.Set("");
    if (!empty) environment.Unset();
    EXPECT_EQ(runtime::NetworkUrl(""), "udpm://239.255.76.67:7667?ttl=0");
    EXPECT_EQ(runtime::NetworkUrl("tcpq://127.0.0.1"), "tcpq://127.0.0.1");
  }
}

TEST(LcmUrlTest, HasLcmsDefaultsWhereItSaysNothing) {
  runtime::MulticastAddress lcms{
      .group = "239.255.76.67", .port = 7667, .ttl = 0, .receive_buffer = {}};
  EXPECT_EQ(runtime::ParseMulticastUrl("udpm://"), lcms);
  lcms.receive_buffer = 100;
  EXPECT_EQ(runtime::ParseMulticastUrl("udpm://?recv_buf_size=100"), lcms);
  const runtime::MulticastAddress near{
      .group = "239.1.1.1", .port = 65535, .ttl = 1, .receive_buffer = {}};
  EXPECT_EQ(runtime::ParseMulticastUrl("udpm://239.1.1.1:65535?ttl=1"), near);
  const runtime::MulticastAddress far{
      .group = "224.1.1.1", .port = 1, .ttl = 3, .receive_buffer = 1};
  EXPECT_EQ(runtime::ParseMulticastUrl("udpm://224.1.1.1:1?recv_buf_size=1&ttl=3"), far);
}

TEST(LcmUrlTest, IsNoneOfAGroupWithAnotherProvider) {
  for (const char* url : {"", "udpm", "udpm:/", "tcpq://", "mpudpm://239.1.1.1"}) {
    EXPECT_EQ(runtime::ParseMulticastUrl(url), std::nullopt) << url;
  }
}

TEST(LcmUrlTest, NamesWhatIsWrongInIt) {
  for (const char* url : {"udpm://", "udpm://?ttl=1", "udpm://239.1.1.1:7700?recv_buf_size=1&ttl=0",
                          "udpm://?ttl=255&recv_buf_size=2147483647", "udpm://239.1.1.1:1"}) {
    EXPECT_EQ(runtime::WhyWrongUrl(url), "") << url;
    EXPECT_TRUE(runtime::ParseMulticastUrl(url)) << url;
  }
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"lab1", "\"lab1\" is no IPv4 address in numbers"},
      {"239.1.1.256", "\"239.1.1.256\" is no IPv4 address in numbers"},
      {"239.1.1.1 :1", "\"239.1.1.1 \" is no IPv4 address in numbers"},
      {"239.1.1.1", "the port after the address is missing"},
      {"239.1.1.1?ttl=0", "the port after the address is missing"},
      {":7700", "the address before the port is missing"},
      {"239.1.1.1:65536", "\"65536\" is no port (1 to 65535)"},
      {"239.1.1.1:0", "\"0\" is no port (1 to 65535)"},
      {"239.1.1.1:07700", "\"07700\" is no port (1 to 65535)"},
      {"239.1.1.1:0x1e14", "\"0x1e14\" is no port (1 to 65535)"},
      {"239.1.1.1:-1", "\"-1\" is no port (1 to 65535)"},
      {"239.1.1.1:1:2", "\"1:2\" is no port (1 to 65535)"},
      {"239.1.1.1:7x?ttl=0", "\"7x\" is no port (1 to 65535)"},
      {"239.1.1.1:", "\"\" is no port (1 to 65535)"},
      {"239.1.1.1:1?ttl=0&tll=1",
       "udpm has no option \"tll\"; its options are ttl and recv_buf_size"},
      {"?", "an option is missing at its end"},
      {"239.1.1.1:1?ttl=0&", "an option is missing at its end"},
      {"?=", "udpm has no option \"\"; its options are ttl and recv_buf_size"},
      {"?ttl=256", "ttl is \"256\", which is no number from 0 to 255"},
      {"?ttl=010", "ttl is \"010\", which is no number from 0 to 255"},
      {"?ttl=0x0", "ttl is \"0x0\", which is no number from 0 to 255"},
      {"?ttl=-0", "ttl is \"-0\", which is no number from 0 to 255"},
      {"?ttl=+1", "ttl is \"+1\", which is no number from 0 to 255"},
      {"?ttl=1;reboot", "ttl is \"1;reboot\", which is no number from 0 to 255"},
      {"?ttl", "ttl is \"\", which is no number from 0 to 255"},
      {"?ttl=0&recv_buf_size=2M",
       "recv_buf_size is \"2M\", which is no number from 0 to 2147483647"},
      {"?recv_buf_size=-1", "recv_buf_size is \"-1\", which is no number from 0 to 2147483647"}};
  for (const auto& [rest, why] : wrong) {
    EXPECT_EQ(runtime::WhyWrongUrl("udpm://" + rest), why);
    EXPECT_EQ(runtime::ParseMulticastUrl("udpm://" + rest), std::nullopt) << rest;
  }
}

TEST(LcmUrlTest, NamesWhatIsWrongWithOtherProviders) {
  for (const char* url : {"mpudpm://", "mpudpm://239.1.1.1:7700?ttl=1&nports=3&recv_buf_size=0",
                          "mpudpm://239.1.1.1:65000?nports=536", "tcpq://", "tcpq://lab1",
                          "tcpq://lab1:7700", "tcpq://:1", "memq://"}) {
    EXPECT_EQ(runtime::WhyWrongUrl(url), "") << url;
  }
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"mpudpm://239.1.1.1", "the port after the address is missing"},
      {"mpudpm://?ttl=x", "ttl is \"x\", which is no number from 0 to 255"},
      {"mpudpm://?nports=0", "nports is \"0\", which is no number from 1 to 65535"},
      {"mpudpm://239.1.1.1:65000?nports=1000",
       "the last of 1000 ports from 65000 on is above 65535"},
      {"mpudpm://?port=1",
       "mpudpm has no option \"port\"; its options are ttl, recv_buf_size and nports"},
      {"udpm://?nports=3", "udpm has no option \"nports\"; its options are ttl and recv_buf_size"},
      {"tcpq://lab1:99999", "\"99999\" is no port (1 to 65535)"},
      {"tcpq://lab1:0", "\"0\" is no port (1 to 65535)"},
      {"tcpq://:", "\"\" is no port (1 to 65535)"},
      {"tcpq://lab1:7700?ttl=1", "\"7700?ttl=1\" is no port (1 to 65535)"},
      {"", "no LCM URL such as \"udpm://239.255.76.67:7667?ttl=0\""},
      {"udpm:/", "no LCM URL such as \"udpm://239.255.76.67:7667?ttl=0\""}};
  for (const auto& [url, why] : wrong) EXPECT_EQ(runtime::WhyWrongUrl(url), why);
}

TEST(LcmUrlTest, HasTheContentsOfBothProvidersOfMulticast) {
  EXPECT_EQ(runtime::MulticastAddressOf("udpm://").ttl, 0);
  EXPECT_EQ(runtime::MulticastAddressOf("udpm://239.1.1.1:7700?recv_buf_size=1&ttl=3").ttl, 3);
  const runtime::MulticastAddress many{
      .group = "239.1.1.1", .port = 7700, .ports = 2, .ttl = 1, .receive_buffer = 5};
  EXPECT_EQ(runtime::MulticastAddressOf("mpudpm://239.1.1.1:7700?nports=2&ttl=1&recv_buf_size=5"),
            many);
}

TEST(LcmUrlTest, NamesTheSameNetworkByGroupAndPort) {
  EXPECT_TRUE(
      runtime::SameNetwork("udpm://239.255.76.67:7667?ttl=0", "udpm://?recv_buf_size=2097152"));
  EXPECT_FALSE(runtime::SameNetwork("udpm://239.255.76.67:7667", "udpm://239.255.76.67:7668"));
  EXPECT_FALSE(runtime::SameNetwork("udpm://239.255.76.67:7667", "udpm://239.255.76.68:7667"));
  EXPECT_TRUE(runtime::SameNetwork("tcpq://127.0.0.1:7700", "tcpq://127.0.0.1:7700"));
  EXPECT_TRUE(runtime::SameNetwork("tcpq://127.0.0.1", "tcpq://127.0.0.1:7700"));
  EXPECT_TRUE(runtime::SameNetwork("tcpq://", "tcpq://127.0.0.1:7700"));
  EXPECT_FALSE(runtime::SameNetwork("tcpq://127.0.0.1", "tcpq://127.0.0.1:7701"));
  EXPECT_FALSE(runtime::SameNetwork("tcpq://127.0.0.1:x", "tcpq://127.0.0.1:y"));
  EXPECT_FALSE(runtime::SameNetwork("tcpq://127.0.0.1:7700", "udpm://"));
}

TEST(LcmUrlTest, MayBeAnnouncedIfItIsAGroupOrARelayOfThisMachine) {
  for (const char* url : {"udpm://239.255.76.67:7700?ttl=0&recv_buf_size=2097152", "udpm://?ttl=1",
                          "tcpq://127.0.0.1:7700", "tcpq://127.1.2.3"}) {
    EXPECT_TRUE(runtime::MayBeAnnounced(url)) << url;
  }
  for (const std::string url :
       {"", "memq://", "file://x", "mpudpm://239.255.76.67:7700", "udpm://10.0.0.1:7700",
        "udpm://239.255.76.67:0", "udpm://239.255.76.67:7700?ttl=2", "tcpq://localhost:7700",
        "udpm://?recv_buf_size=99999", "udpm://?recv_buf_size=2147483647", "tcpq://192.0.2.1:7700",
        "tcpq://0.0.0.0:7700", "tcpq://127.0.0.1:0", "tcpq://", "tcpq://127.0.0.1:7700?x",
        "tcpq://127.0.0.1:7700 -x"}) {
    EXPECT_FALSE(runtime::MayBeAnnounced(url)) << url;
  }
  EXPECT_FALSE(runtime::MayBeAnnounced("udpm://?recv_buf_size=" + std::string(200, '0')));
}

TEST(LcmUrlTest, AProgramListensAndARelayIsAnnouncedAtEachAddressOfAnInterface) {
  ifaddrs* interfaces = nullptr;
  ASSERT_EQ(getifaddrs(&interfaces), 0);
  int tried = 0;
  for (const ifaddrs* one = interfaces; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    const auto& address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr;
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &address, text.data(), text.size());
    const std::string own = std::string(text.data()) + ":7700";
    EXPECT_EQ(runtime::tcpq::ResolveOwn(own, "--listen").ToString(), own);
    EXPECT_TRUE(runtime::MayBeAnnounced("tcpq://" + own)) << own;
    ++tried;
  }
  freeifaddrs(interfaces);
  EXPECT_GT(tried, 0);
}

// The fingerprint does not include the types that no role sends, such as beacon_t. So a program
// that was built without these types can take part in a run.
TEST(TypeFingerprintTest, IsOfTheHeaderAndTheTypesOfAllChannelsInTheOrderOfTheirNames) {
  std::map<std::string, std::int64_t> hashes{{header_t::getTypeName(), header_t::getHash()}};
  std::apply(
      [&hashes]<class... M>(const Channel<M>&... /*channels*/) {
        (hashes.emplace(M::getTypeName(), M::getHash()), ...);
      },
      kGraph);
  std::uint64_t fingerprint = 0;
  for (const auto& [name, hash] : hashes) {
    fingerprint = ((fingerprint << 5) | (fingerprint >> 59)) ^ static_cast<std::uint64_t>(hash);
  }
  EXPECT_EQ(static_cast<std::uint64_t>(TypeFingerprint()), fingerprint);
}

}  // namespace
}  // namespace fogline
