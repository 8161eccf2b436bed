#include "tools/processes/relay_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "tests/support/children.h"
#include "tests/support/command.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline::test {
namespace {

using processes::RelayProcess;
using testing::MatchesRegex;
using testing::StartsWith;

class RelayProcessTest : public testing::Test {
 protected:
  /// The only child of this process.
  static pid_t PidOfRelay() {
    const std::vector<pid_t> children = ChildrenOf(getpid());
    EXPECT_EQ(children.size(), 1U);
    return children.empty() ? 0 : children.front();
  }
  /// Calls Look() until it returns a text, or until kPatience has passed. @return the text
  std::string News(RelayProcess& relay) const {
    std::string news;
    const TimePoint end = Clock::now() + kPatience;
    while (news.empty() && Clock::now() < end) {
      news = relay.Look(coordinator_, Clock::now());
      std::this_thread::sleep_for(kLookEvery);
    }
    return news;
  }
  /// Whether a message gets from one client to another.
  static bool Carries(const std::string& url) {
    runtime::Bus here(url);
    runtime::Bus there(url);
    bool heard = false;
    there.Subscribe("TEST", [&heard](runtime::Bytes) { heard = true; });
    const std::vector<std::uint8_t> message{1, 2, 3};
    const TimePoint end = Clock::now() + kPatience;
    while (!heard && Clock::now() < end) {  // the relay needs a moment for the subscription
      here.Publish("TEST", message);
      if (there.Wait(milliseconds(20))) there.Drain();
    }
    return heard;
  }

  Script script_;
  runtime::RunCoordinator coordinator_{script_.bus(),
                                       {.run_id = Script::kRunId, .scenario_text = script_.text()}};
};

TEST_F(RelayProcessTest, CarriesMessagesOnAPortOfThisMachineUntilItsObjectEnds) {
  pid_t pid = 0;
  {
    RelayProcess relay(0);
    pid = PidOfRelay();
    EXPECT_THAT(relay.url(), StartsWith("tcpq://127.0.0.1:"));
    EXPECT_TRUE(Carries(relay.url()));
    EXPECT_EQ(relay.Look(coordinator_, Clock::now()), "");
    EXPECT_EQ(relay.restarts(), 0);
    EXPECT_EQ(relay.death(), "");
  }
  EXPECT_FALSE(IsAlive(pid));
}

TEST_F(RelayProcessTest, IsStartedAgainAtTheSameAddressUntilItsRestartsAreUsedUp) {
  RelayProcess relay(1);
  const std::string url = relay.url();
  const std::string first = std::to_string(PidOfRelay());
  SignalOne(PidOfRelay(), SIGKILL);
  EXPECT_THAT(News(relay), MatchesRegex("relay \\(pid " + first +
                                        "\\) was killed by signal 9 \\(Killed\\) before step 0; "
                                        "started again as pid [0-9]+ \\(1 of 1\\)"));
  EXPECT_EQ(relay.restarts(), 1);
  EXPECT_EQ(relay.death(), "was killed by signal 9 (Killed) before step 0");
  EXPECT_EQ(relay.url(), url);
  EXPECT_TRUE(Carries(url));

  const std::string second = std::to_string(PidOfRelay());
  SignalOne(PidOfRelay(), SIGKILL);
  try {
    News(relay);
    FAIL() << "it was started again";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "relay (pid " + second +
                                ") was killed by signal 9 (Killed) before step 0, after 1 "
                                "restarts (--restarts)");
  }
}

}  // namespace
}  // namespace fogline::test
