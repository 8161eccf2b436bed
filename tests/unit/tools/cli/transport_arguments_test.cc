#include "tools/cli/transport_arguments.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/wire/message_signer.h"
#include "tests/support/command.h"
#include "tests/support/environment_url.h"
#include "tests/support/input_errors.h"

namespace fogline::test {
namespace {

using runner::RunOptions;

/// The options of a run that follow from its command line.
RunOptions Read(std::vector<std::string> words, const std::string& usual = "udpm") {
  CLI::App app;
  const cli::TransportArguments arguments(app, usual);
  app.parse(std::vector(words.rbegin(), words.rend()));
  RunOptions options;
  arguments.Apply(options);
  return options;
}

/// The error text for a command line; "" if the command line is accepted.
std::string Refusal(const std::vector<std::string>& words) {
  return ErrorOf([&words] { Read(words); });
}

const std::string kUrl = "udpm://239.255.76.67:7700?ttl=0";

TEST(TransportArgumentsTest, TakeTheTransportOfTheVerbUnlessAnotherIsNamed) {
  const EnvironmentUrl environment;
  EXPECT_EQ(Read({}).transport, "udpm");
  EXPECT_EQ(Read({}, "direct").transport, "direct");
  EXPECT_EQ(Read({"--transport", "memq"}).transport, "memq");
  EXPECT_EQ(Read({"--lcm-url", kUrl}).transport, kUrl);
  EXPECT_THROW(Read({"--lcm-url", kUrl, "--transport", "memq"}), CLI::ParseError);
}

TEST(TransportArgumentsTest, TakeTheNetworkOfTheEnvironmentForARunOfProcesses) {
  const EnvironmentUrl environment;
  environment.Set(kUrl);
  EXPECT_EQ(Read({}).transport, kUrl);
  EXPECT_EQ(Read({}, "direct").transport, "direct");
  EXPECT_EQ(Read({"--external", "driver"}, "direct").transport, kUrl);
  EXPECT_EQ(Read({"--transport", "udpm"}).transport, "udpm");
  environment.Set("pigeon");
  EXPECT_EQ(Refusal({}),
            "error: LCM_DEFAULT_URL pigeon: no LCM URL such as "
            "\"udpm://239.255.76.67:7667?ttl=0\"");
}

TEST(TransportArgumentsTest, SetWhatTheRunDoes) {
  const EnvironmentUrl environment;
  const RunOptions usual = Read({});
  EXPECT_TRUE(usual.external.empty());
  EXPECT_EQ(usual.wait, milliseconds(60'000));
  EXPECT_FALSE(usual.same_build);
  EXPECT_EQ(usual.verify, std::nullopt);
  const RunOptions options = Read({"--external", "driver", "--external", "acc", "--wait", "1.5",
                                   "--same-build", "--verify", "--faults", "loss=0.1"});
  EXPECT_EQ(options.external, (std::vector{Role::kAcc, Role::kDriver})) << "in kRoles' order";
  EXPECT_EQ(options.wait, milliseconds(1500));
  EXPECT_TRUE(options.same_build);
  EXPECT_EQ(options.verify, true);
  EXPECT_EQ(options.traffic.faults, "loss=0.1");
  EXPECT_EQ(Read({"--no-verify"}).verify, false);
}

TEST(TransportArgumentsTest, RefuseContradictions) {
  EXPECT_EQ(Refusal({"--lcm-url", "pigeon"}),
            "error: --lcm-url pigeon: no LCM URL such as \"udpm://239.255.76.67:7667?ttl=0\"");
  EXPECT_EQ(Refusal({"--on", "fusion=lab2", "--relay", "--lcm-url", "tcpq"}),
            "error: --lcm-url tcpq: no LCM URL such as \"udpm://239.255.76.67:7667?ttl=0\"");
  EXPECT_EQ(Refusal({"--lcm-url", "udpm://239.255.76.67:70000"}),
            "error: --lcm-url udpm://239.255.76.67:70000: \"70000\" is no port (1 to 65535)");
  EXPECT_EQ(Refusal({"--faults", "flip=0.1"}).rfind("error: --faults: truncate and flip need", 0),
            0U);
  EXPECT_EQ(Refusal({"--transport", "direct", "--faults", "loss=0.1"}),
            "error: --faults: a run with --transport direct has no messages");
  EXPECT_EQ(Refusal({"--transport", "direct", "--verify"}),
            "error: --verify: a run with --transport direct is one process and has no messages "
            "that could be altered");
  EXPECT_EQ(Refusal({"--transport", "memq", "--external", "acc"}),
            "error: --external acc: no other process can join a run with --transport memq, which "
            "is one process");
  EXPECT_EQ(Refusal({"--lcm-url", "memq://", "--external", "acc"}),
            "error: --external acc: no other process can join a run with --lcm-url memq://, "
            "which is one process");
  const EnvironmentUrl environment;
  environment.Set("memq://");
  EXPECT_EQ(ErrorOf([] { cli::RequireProcesses(Read({}), "a trial"); }),
            "error: LCM_DEFAULT_URL memq://: all roles are in one process; a trial needs a process "
            "for each role");
  try {
    Read({"--external", "recorder"});
    FAIL() << "a run cannot wait for a recorder";
  } catch (const CLI::ParseError& error) {
    EXPECT_STREQ(error.what(), "--external: recorder: the run's result is read from its own log");
  }
  EXPECT_THROW(Read({"--external", "pilot"}), CLI::ParseError);
  EXPECT_THROW(Read({"--wait", "-1"}), CLI::ParseError);
}

TEST(TransportArgumentsTest, OfferNoRecorderFromElsewhere) {
  CLI::App app;
  const cli::TransportArguments arguments(app, "udpm");
  const std::string help = app.help();
  EXPECT_NE(help.find("follower"), std::string::npos);
  EXPECT_EQ(help.find("recorder"), std::string::npos) << help;
}

TEST(TransportArgumentsTest, PlaceRolesOnOtherMachines) {
  const EnvironmentUrl environment;
  const RunOptions options = Read({"--on", "acc=lab2", "--on", "radar=lab3"});
  EXPECT_EQ(options.transport, "udpm");
  EXPECT_EQ(options.hosts.hosts.size(), 2U);
  EXPECT_TRUE(options.hosts.places.contains(Role::kAcc));
  EXPECT_EQ(Read({"--on", "acc=lab2"}, "direct").transport, "udpm");
  EXPECT_EQ(Read({"--on", "acc=lab2", "--relay"}).transport, "tcpq");
  EXPECT_EQ(Read({"--on", "acc=lab2", "--relay-at", "127.0.0.1"}).transport, "tcpq");
  environment.Set("udpm://239.255.76.67:7700?ttl=1");
  EXPECT_EQ(Read({"--on", "acc=lab2"}, "direct").transport, "udpm://239.255.76.67:7700?ttl=1");
}

TEST(TransportArgumentsTest, RefuseRolesOnOtherMachinesThatCannotJoin) {
  const EnvironmentUrl environment;
  EXPECT_EQ(Refusal({"--on", "acc=lab2", "--transport", "memq"}),
            "error: acc on lab2: a run with --transport memq is one process");
  EXPECT_EQ(Refusal({"--on", "acc=lab2", "--transport", "direct"}),
            "error: acc on lab2: a run with --transport direct is one process");
  EXPECT_EQ(Refusal({"--on", "acc=lab2", "--lcm-url", kUrl}),
            "error: acc on lab2: messages to " + kUrl +
                " stay on this machine; other machines need ttl=1");
  EXPECT_EQ(Refusal({"--on", "acc=lab2", "--relay", "--lcm-url", "tcpq://lab1"}),
            "error: --relay: the run has a relay of its own, and not the network tcpq://lab1");
  EXPECT_EQ(Refusal({"--on", "acc=lab2", "--external", "acc"}),
            "error: --external acc: the run itself starts the acc on lab2");
}

TEST(TransportArgumentsTest, RefuseAKeyThatIsNoneEvenWithoutMessages) {
  const ScratchFolder folder;
  const std::string key = folder.File("key");
  EXPECT_NE(Refusal({"--transport", "direct", "--key", key}), "");
  runtime::SigningKey::Create(key);
  EXPECT_EQ(Refusal({"--transport", "direct", "--key", key}), "");
}

}  // namespace
}  // namespace fogline::test
