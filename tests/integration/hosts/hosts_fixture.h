// Common parts of the tests of runs that start roles on other machines.
#pragma once

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/integration/hosts/machine_processes.h"
#include "tests/support/children.h"
#include "tests/support/network_test.h"

namespace fogline::test {

class HostsTest : public NetworkTest {
 protected:
  /// The value of --on, "ROLE=HOST:FOLDER", that starts a role on a machine of the laboratory.
  /// FOLDER has the programs of this build.
  static std::string On(const std::string& role, const std::string& host) {
    return role + "=" + host + ":" + ProgramDirectory().string();
  }
  /// The options that start these roles on machine lab2.
  static std::vector<std::string> OnLab2(const std::vector<std::string>& roles) {
    std::vector<std::string> options;
    for (const std::string& role : roles) options.insert(options.end(), {"--on", On(role, "lab2")});
    return options;
  }
  /// The command of a run whose runner is on `machine`. `ssh` is the command that the run calls in
  /// place of ssh. `places` are the options --on of the roles.
  std::vector<std::string> RunFrom(const Machine& machine, const std::string& ssh,
                                   const std::vector<std::string>& places,
                                   const std::vector<std::string>& more = {}) {
    std::vector<std::string> options{"--ssh", ssh};
    options.insert(options.end(), places.begin(), places.end());
    options.insert(options.end(), more.begin(), more.end());
    return machine.On(Run(options));
  }
  /// Blocks all UDP datagrams between the machines.
  static void BlockUdpBetween(const Lab& lab) {
    for (std::size_t i = 0; i < lab.machines().size(); ++i) {
      lab[i].Do(
          "nft 'table inet block { chain input { type filter hook input priority 0; "
          "ip saddr 10.76.67.0/24 ip saddr != 10.76.67." +
          std::to_string(i + 1) + " meta l4proto udp drop; }; }'");
    }
  }
  /// Waits until the log of a run has a dozen steps. The run must have a pace, because a run
  /// without a pace would already have ended.
  [[nodiscard]] bool IsUnderWay() const { return GrowsTo(20'000, Log()); }

  /// Makes a copy of the program `fogline`. The copy differs from the program only in its version.
  /// @return what the copy prints for --version
  static std::string MakeOtherVersion(const std::string& copy) {
    const std::string own = RunCommand({Program("fogline"), "--version"}).out;
    const std::string version = own.substr(0, own.find(','));
    std::string other = version;
    other.front() = '9';
    std::string program = Content(Program("fogline"));
    for (std::size_t at = 0; (at = program.find(version + '\0', at)) != std::string::npos; ++at) {
      program.replace(at, version.size(), other);
    }
    std::ofstream(copy, std::ios::binary) << program;
    std::filesystem::permissions(copy, std::filesystem::perms::owner_all);
    const std::string printed = RunCommand({copy, "--version"}).out;
    EXPECT_EQ(printed, other + own.substr(version.size()));
    return printed.substr(0, printed.find('\n'));
  }

  // Tests for every kind of connection to other machines. -------------------------------------

  void ExpectTheDigestOfDirect(const Lab& lab, const std::string& ssh) {
    const auto result =
        Result(RunCommand(RunFrom(lab[0], ssh, OnLab2({"radar", "fusion", "driver"}))));
    EXPECT_EQ(result["digest"], Undisturbed());
    EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
    EXPECT_THAT(LeftOn(lab[1]), testing::IsEmpty());
  }

  void ExpectAKilledRoleIsStartedThereAgain(const Lab& lab, const std::string& ssh) {
    Background run(RunFrom(lab[0], ssh, OnLab2({"fusion"}), {"--pace", "5"}));
    ASSERT_TRUE(IsUnderWay()) << run.Err();
    const pid_t fusion = PidOf(run.Err(), "fusion");
    EXPECT_THAT(FoglineOn(lab[1]), testing::ElementsAre("fogline", "fogline-fusion"));
    SignalOne(fusion, SIGKILL);
    const auto result = ResultOf(run);
    EXPECT_EQ(result["digest"], Undisturbed());
    ASSERT_EQ(result["restarts"].size(), 1U) << run.Err();
    EXPECT_EQ(result["restarts"][0]["role"], "fusion");
    EXPECT_THAT(run.Err(),
                testing::HasSubstr("fusion (pid " + std::to_string(fusion) +
                                   " on lab2) was killed by signal 9 (Killed) at step "));
    EXPECT_THAT(LeftOn(lab[1]), testing::IsEmpty());
  }

  void ExpectCtrlCEndsEverything(const Lab& lab, const std::string& ssh,
                                 std::chrono::seconds limit) {
    Background run(RunFrom(lab[0], ssh, OnLab2({"fusion", "acc"}), {"--pace", "1"}));
    ASSERT_TRUE(IsUnderWay()) << run.Err();
    const auto began = std::chrono::steady_clock::now();
    run.Signal(SIGINT);
    EXPECT_EQ(run.Wait(), 130) << run.Err();
    EXPECT_THAT(LeftOn(lab[1]), testing::IsEmpty());
    EXPECT_LT(std::chrono::steady_clock::now() - began, limit);
  }

  void ExpectNothingIsLeftOfARunnerThatWasKilled(const Lab& lab, const std::string& ssh) {
    Background run(RunFrom(lab[0], ssh, OnLab2({"fusion", "acc"}), {"--pace", "1"}));
    ASSERT_TRUE(IsUnderWay()) << run.Err();
    run.Signal(SIGKILL);
    run.Wait();
    EXPECT_THAT(LeftOn(lab[1]), testing::IsEmpty());
  }

  void ExpectTheRelayCarriesARunWithoutMulticast(const Lab& lab, const std::string& ssh) {
    BlockUdpBetween(lab);
    const auto result =
        Result(RunCommand(RunFrom(lab[0], ssh, OnLab2({"fusion", "acc"}), {"--relay"})));
    EXPECT_EQ(result["digest"], Undisturbed());
    EXPECT_EQ(result["transport"], "tcpq");
    EXPECT_THAT(LeftOn(lab[1]), testing::IsEmpty());
  }
};

}  // namespace fogline::test
