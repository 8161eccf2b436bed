// `fogline doctor` behind firewalls and on two machines, and the recipes that it prints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "services/runtime/transport/multicast_route.h"
#include "tests/support/command.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class DoctorNetworkTest : public NetworkTest {
 protected:
  static std::vector<std::string> DoctorWith(const std::string& other) {
    return {Program("fogline"), "doctor", "--json", "--lcm-url", kUrl,
            "--with",           other,    "--wait", "20"};
  }
  /// Calls doctor until its output has all texts in `finds`, because on a busy machine doctor may
  /// miss messages. @return the output as JSON
  static json Doctor(const Machine& machine, const std::string& url = kUrl,
                     const std::vector<std::string>& finds = {}) {
    const Outcome doctor = RunUntilItPrints(
        machine.On({Program("fogline"), "doctor", "--json", "--lcm-url", url}), finds);
    return json::parse(doctor.out, nullptr, false);
  }
  static json Document(Background& doctor) {
    doctor.Wait();
    return json::parse(doctor.Out(), nullptr, false);
  }
  /// The first finding of a check; null if there is none.
  static json Found(const json& document, const std::string& check) {
    for (const json& finding : document["findings"]) {
      if (finding["check"] == check) return finding;
    }
    return {};
  }
  /// The script of the recipe whose title begins with `title`.
  static std::string Script(const json& finding, const std::string& title) {
    for (const json& recipe : finding["recipes"]) {
      if (recipe["title"].get<std::string>().starts_with(title)) return recipe["script"];
    }
    ADD_FAILURE() << "no recipe " << title << " in " << finding;
    return "false";
  }
};

// Commands for a firewall that accepts only packets of connections that the machine itself has
// begun.
constexpr const char* kClosed =
    "nft 'table inet filter { chain input { type filter hook input priority filter; policy drop; "
    "ct state established,related accept; }; }'";

TEST_F(DoctorNetworkTest, TriesThePortOfTheUrlBehindAFirewallThatPassesNoOther) {
  const Lab lab(1);
  lab[0].Do(
      "nft 'table inet filter { chain input { type filter hook input priority filter; policy drop; "
      "ip daddr 239.255.76.67 udp dport 7700 accept; }; }'");
  const json document = Doctor(lab[0]);
  EXPECT_EQ(Found(document, "multicast_loopback")["level"], "ok") << document;
}

TEST_F(DoctorNetworkTest, GivesFindingsBehindAFirewallThatPassesNothingAndItsRecipeHelps) {
  const Lab lab(1);
  lab[0].Do(kClosed);
  const json closed = Doctor(lab[0]);
  const json finding = Found(closed, "multicast_loopback");
  EXPECT_EQ(finding["level"], "problem") << closed;
  EXPECT_EQ(finding["what"], "a message to 239.255.76.67:7700 does not come back to this machine");
  EXPECT_FALSE(Found(closed, "clock").is_null()) << "the other examinations are made, too";
  // WHEN the script of the recipe is executed
  lab[0].Do(Script(finding, "nftables, until the next start"));
  EXPECT_EQ(Found(Doctor(lab[0]), "multicast_loopback")["level"], "ok");
}

TEST_F(DoctorNetworkTest, SaysThatOtherMachinesHearNothingWithTtlZero) {
  const Lab lab(2);
  Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run")) << driver.Err();
  const json alone =
      Doctor(lab[0], "udpm://239.255.76.67:7700?ttl=0", {"messages of lab2 come here"});
  EXPECT_EQ(Found(alone, "ttl")["level"], "problem") << alone;
  EXPECT_EQ(Found(alone, "ttl")["what"],
            "messages of lab2 come here, but with ttl=0 lab2 never hears this machine");
  const json wide = Doctor(lab[0], kUrl, {": pid " + std::to_string(driver.pid()) + " on lab2"});
  EXPECT_TRUE(Found(wide, "ttl").is_null());
  EXPECT_THAT(Found(wide, "waiting_roles")["what"].get<std::string>(),
              HasSubstr(": pid " + std::to_string(driver.pid()) + " on lab2, version "));
}

TEST_F(DoctorNetworkTest, OfTwoMachinesSaysThatTheyHearEachOther) {
  const Lab lab(2);
  Background one(lab[0].On(DoctorWith("lab2")));
  Background two(lab[1].On(DoctorWith("10.76.67.1")));
  const json first = Document(one);
  const json second = Document(two);
  EXPECT_EQ(Found(first, "with")["what"], "lab1 and lab2 hear each other on " + std::string(kUrl))
      << first;
  EXPECT_EQ(Found(second, "with")["level"], "ok") << second;
  EXPECT_EQ(Found(first, "with_version")["level"], "ok");
}

TEST_F(DoctorNetworkTest, OfTwoMachinesNamesTheDirectionThatFails) {
  const Lab lab(2);
  // GIVEN a firewall of lab2 that drops the messages of lab1
  lab[1].Do(
      "nft 'table inet filter { chain input { type filter hook input priority filter; "
      "ip saddr 10.76.67.1 drop; }; }'");
  Background one(lab[0].On(DoctorWith("lab2")));
  Background two(lab[1].On(DoctorWith("lab1")));
  const json first = Document(one);
  const json second = Document(two);
  EXPECT_EQ(Found(first, "with")["level"], "problem");
  EXPECT_EQ(Found(first, "with")["what"],
            "lab1 -> lab2 fails: messages of lab2 come here, but lab2 hears nothing from this "
            "machine");
  EXPECT_EQ(Found(second, "with")["level"], "problem");
  EXPECT_EQ(Found(second, "with")["what"],
            "lab1 -> lab2 fails: in 20 s no message of a doctor on lab1 has come");
}

TEST_F(DoctorNetworkTest, OfTwoMachinesRefusesTtlZeroAtOnce) {
  const Lab lab(1);
  const Outcome doctor =
      RunCommand(lab[0].On({Program("fogline"), "doctor", "--json", "--with", "lab2"}));
  EXPECT_EQ(doctor.code, 1);
  EXPECT_EQ(Found(json::parse(doctor.out), "with")["what"],
            "with ttl=0 no message of this machine reaches lab2");
}

TEST_F(DoctorNetworkTest, ItsRecipesForARouteHelp) {
  const Lab lab(1);
  lab[0].Do("ip route del 239.0.0.0/8 dev eth0");
  const json finding = Found(Doctor(lab[0]), "multicast_route");
  ASSERT_EQ(finding["level"], "problem") << finding;
  lab[0].Do(Script(finding, "until the next start"));
  EXPECT_EQ(Found(Doctor(lab[0]), "multicast_route")["level"], "ok");
  // AND ifupdown's script adds the route when the interface comes up. The test uses a folder in
  // place of /etc
  lab[0].Do("ip route del 239.0.0.0/8 dev eth0");
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "network/if-up.d");
  std::string script = Script(finding, "ifupdown");
  for (std::size_t at = 0; (at = script.find("/etc/", at)) != std::string::npos;) {
    script.replace(at, 4, folder.path().string());
  }
  lab[0].Do(script);
  const std::string hook = folder.File("network/if-up.d/fogline");
  lab[0].Do("IFACE=eth1 " + hook);
  EXPECT_NE(Found(Doctor(lab[0]), "multicast_route")["level"], "ok");
  lab[0].Do("IFACE=eth0 " + hook);
  EXPECT_EQ(Found(Doctor(lab[0]), "multicast_route")["level"], "ok");
  // AND systemd-networkd's drop-in has the route
  EXPECT_THAT(Script(finding, "systemd-networkd"),
              HasSubstr("[Route]\nDestination=239.0.0.0/8\nScope=link\n"));
}

}  // namespace
}  // namespace fogline::test
