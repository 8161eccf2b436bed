#include "services/runtime/transport/multicast_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr const char* kGroup = "239.255.76.67";

// Lines of a routing table in the kernel's format (/proc/net/route). Addresses are hexadecimal
// numbers in memory order.
constexpr const char* kHeading =
    "Iface\tDestination\tGateway\tFlags\tRefCnt\tUse\tMetric\tMask\tMTU\tWindow\tIRTT\n";
constexpr const char* kDefault = "eth0\t00000000\t010200C0\t0003\t0\t0\t0\t00000000\t0\t0\t0\n";
constexpr const char* kNetwork = "eth0\t000200C0\t00000000\t0001\t0\t0\t0\t00FFFFFF\t0\t0\t0\n";
constexpr const char* kMulticast = "lo\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0\n";
constexpr const char* kSlowDefault =
    "wlan0\t00000000\t010200C0\t0003\t0\t0\t600\t00000000\t0\t0\t0\n";

TEST(MulticastRouteTest, FindsTheGroupOfAUrl) {
  EXPECT_EQ(runtime::GroupOf("udpm://239.255.1.2:7700?ttl=1"), "239.255.1.2");
  EXPECT_EQ(runtime::GroupOf("udpm://?ttl=1"), kGroup);
  EXPECT_EQ(runtime::GroupOf("mpudpm://239.1.1.1"), "239.1.1.1");
  EXPECT_EQ(runtime::GroupOf("tcpq://127.0.0.1"), std::nullopt);
}

TEST(MulticastRouteTest, PrefersTheLongestPrefixAndThenTheLowestMetric) {
  const std::string table = std::string(kHeading) + kSlowDefault + kDefault + kNetwork;
  EXPECT_EQ(runtime::RouteInterface(table, kGroup), "eth0");
  EXPECT_EQ(runtime::RouteInterface(table + kMulticast, kGroup), "lo");
  EXPECT_EQ(runtime::RouteInterface(std::string(kHeading) + kMulticast + kDefault, kGroup), "lo");
  EXPECT_EQ(runtime::RouteInterface(table + kMulticast, "192.0.2.9"), "eth0");
}

TEST(MulticastRouteTest, HasNoInterfaceWithoutARoute) {
  EXPECT_EQ(runtime::RouteInterface("", kGroup), "");
  EXPECT_EQ(runtime::RouteInterface(std::string(kHeading) + kNetwork, kGroup), "");
  EXPECT_EQ(runtime::RouteInterface(std::string(kHeading) + kDefault, "no address"), "");
  EXPECT_EQ(runtime::RouteInterface(std::string(kHeading) + "eth0\ttorn", kGroup), "");
}

TEST(MulticastRouteTest, FindsWhichInterfaceHasAGroup) {
  // A table in the format of the kernel's /proc/net/igmp.
  constexpr const char* kTable =
      "Idx\tDevice    : Count Querier\tGroup    Users Timer\tReporter\n"
      "1\tlo        :     2      V3\n"
      "\t\t\t\t434CFFEF     1 0:00000000\t\t0\n"
      "\t\t\t\t010000E0     1 0:00000000\t\t0\n"
      "4\teth0      :     1      V3\n"
      "\t\t\t\t010000E0     1 0:00000000\t\t0\n"
      "5\twlp0s20f3u:     1      V3\n"
      "\t\t\t\t434CFFEF     1 0:00000000\t\t0\n"
      "6\tenx00e04c680:     1      V3\n"
      "\t\t\t\t434CFFEF     1 0:00000000\t\t0\n";
  EXPECT_TRUE(runtime::HasGroup(kTable, "lo", kGroup));
  EXPECT_FALSE(runtime::HasGroup(kTable, "eth0", kGroup));
  EXPECT_TRUE(runtime::HasGroup(kTable, "eth0", "224.0.0.1"));
  EXPECT_TRUE(runtime::HasGroup(kTable, "wlp0s20f3u", kGroup)) << "ten characters";
  EXPECT_TRUE(runtime::HasGroup(kTable, "enx00e04c680", kGroup));
  EXPECT_FALSE(runtime::HasGroup(kTable, "eth", "224.0.0.1"));
  EXPECT_FALSE(runtime::HasGroup(kTable, "lo", "no address"));
  EXPECT_FALSE(runtime::HasGroup("", "lo", kGroup));
}

TEST(MulticastRouteTest, TellsAnAddressOfOneMachineFromAGroup) {
  EXPECT_TRUE(runtime::IsMulticast("224.0.0.1"));
  EXPECT_TRUE(runtime::IsMulticast("239.255.255.255"));
  for (const char* address : {"223.255.255.255", "240.0.0.1", "10.0.0.1", "239.1.1", ""}) {
    EXPECT_FALSE(runtime::IsMulticast(address)) << address;
  }
  EXPECT_EQ(runtime::WhyNoMulticast("udpm://10.0.0.1:7700?ttl=1"),
            "10.0.0.1 is no multicast group (224.0.0.0 to 239.255.255.255): write "
            "udpm://239.255.76.67:7700, the same on every machine; or tcpq://10.0.0.1:7700 with "
            "`fogline-relay --listen 10.0.0.1:7700` on that machine");
}

TEST(MulticastRouteTest, KnowsNothingAgainstAnAddressThatIsAlwaysThere) {
  EXPECT_EQ(runtime::RouteError("127.0.0.1"), "");
  EXPECT_EQ(runtime::WhyNoMulticast("tcpq://127.0.0.1"), "");
}

}  // namespace
}  // namespace fogline
