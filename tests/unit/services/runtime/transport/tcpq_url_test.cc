#include "services/runtime/transport/tcpq_url.h"

#include <gtest/gtest.h>

#include "tests/support/input_errors.h"
#include "tests/unit/tools/trials/desk/taken_port.h"

namespace fogline::runtime::tcpq {
namespace {

std::string ErrorOf(const std::string& url) {
  return test::ErrorOf([&url] { runtime::tcpq::ResolveUrl(url); });
}

TEST(TcpqUrlTest, HasLcmsDefaults) {
  EXPECT_EQ(runtime::tcpq::ResolveUrl("tcpq://").Url(), "tcpq://127.0.0.1:7700");
  EXPECT_EQ(runtime::tcpq::ResolveUrl("tcpq://10.1.2.3").Url(), "tcpq://10.1.2.3:7700");
  EXPECT_EQ(runtime::tcpq::ResolveUrl("tcpq://:7701").Url(), "tcpq://127.0.0.1:7701");
}

TEST(TcpqUrlTest, ResolvesHostNamesWhichLcmTakesForThisMachine) {
  EXPECT_EQ(runtime::tcpq::ResolveUrl("tcpq://localhost:7701").Url(), "tcpq://127.0.0.1:7701");
  // RFC 6761: no name below "invalid" exists.
  EXPECT_EQ(ErrorOf("tcpq://no-such-host.invalid:7701")
                .find("error: tcpq://no-such-host.invalid:7701: no IPv4 address for "
                      "\"no-such-host.invalid\": "),
            0U);
}

TEST(TcpqUrlTest, RefusesWhatIsNoPort) {
  EXPECT_EQ(ErrorOf("tcpq://127.0.0.1:http"),
            "error: tcpq://127.0.0.1:http: \"http\" is no port (0 to 65535)");
  EXPECT_EQ(ErrorOf("tcpq://127.0.0.1:65536"),
            "error: tcpq://127.0.0.1:65536: \"65536\" is no port (0 to 65535)");
  EXPECT_EQ(ErrorOf("tcpq://127.0.0.1:"), "error: tcpq://127.0.0.1:: \"\" is no port (0 to 65535)");
  EXPECT_EQ(ErrorOf("tcpq://127.0.0.1:0"),
            "error: tcpq://127.0.0.1:0: no process can listen on port 0");
  EXPECT_EQ(ErrorOf("tcpq://127.0.0.1:7700?ttl=1"),
            "error: tcpq://127.0.0.1:7700?ttl=1: \"7700?ttl=1\" is no port (0 to 65535)");
}

TEST(TcpqUrlTest, ListensOnlyOnAddressesOfThisMachine) {
  for (const std::string own : {"", "127.0.0.1:0", "127.1.2.3:7701", "0.0.0.0"}) {
    EXPECT_EQ(ResolveOwn(own, "--listen").ToString(), Resolve(own, "--listen").ToString());
  }
  // RFC 5737: no machine has an address of 203.0.113.0/24.
  EXPECT_EQ(test::ErrorOf([] { ResolveOwn("203.0.113.7:7701", "--listen"); }),
            "error: --listen: 203.0.113.7 is no address of this machine (`ip address` lists them)");
  for (const std::string group : {"239.255.76.67", "255.255.255.255", "127.255.255.255"}) {
    EXPECT_EQ(
        test::ErrorOf([&group] { ResolveOwn(group + ":7701", "--listen"); }),
        "error: --listen: " + group + " is no address of this machine (`ip address` lists them)");
  }
  // If the host is not written as a full address, the error names the host and its address.
  // getaddrinfo() accepts the short form 203.28935 of the address 203.0.113.7.
  EXPECT_EQ(test::ErrorOf([] { ResolveOwn("203.28935", "--listen"); }),
            "error: --listen: \"203.28935\" (203.0.113.7) is no address of this machine (`ip "
            "address` lists them)");
}

TEST(TcpqUrlTest, APortThatAnotherProgramHasIsNotFree) {
  test::TakenPort taken(0);
  ASSERT_TRUE(taken.Take());
  const Endpoint place{.address = "127.0.0.1", .port = taken.port()};
  EXPECT_EQ(test::ErrorOf([&place] { RequireFree(place, "--listen"); }),
            "error: --listen: cannot listen on " + place.ToString() + ": Address already in use");
  EXPECT_NO_THROW(RequireFree({.address = "127.0.0.1", .port = 0}, "--listen"));
  EXPECT_EQ(test::ErrorOf<std::runtime_error>([] {
              ThrowCannotListen({.address = "127.0.0.1", .port = 0}, "--listen",
                                std::make_error_code(std::errc::address_in_use));
            }),
            "cannot listen on 127.0.0.1:0: Address already in use");
  EXPECT_EQ(test::ErrorOf<std::runtime_error>([&place] {
              ThrowCannotListen(place, "--listen",
                                std::make_error_code(std::errc::too_many_files_open));
            }),
            "cannot listen on " + place.ToString() + ": Too many open files");
}

}  // namespace
}  // namespace fogline::runtime::tcpq
