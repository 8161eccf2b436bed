// Tests the parts of a node together.
#include "services/runtime/node/node.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/services/runtime/driver_in_run.h"
#include "tests/unit/services/runtime/node/fake_role.h"

namespace fogline {
namespace {

using test::FakeRole;
using test::Script;

class NodeTest : public test::FakeRoleInRun {};

TEST_F(NodeTest, CallsTheWorkAndTheRuleOnlyWhileTheRoleRuns) {
  script_.Poll(role_);
  EXPECT_EQ(role_.polls, 0);
  Join();
  script_.Poll(role_);
  EXPECT_EQ(role_.polls, 1);
  EXPECT_EQ(role_.rule->polls, 1);
  parts_.own.Leave();
  script_.Poll(role_);
  EXPECT_EQ(role_.polls, 1);
  EXPECT_EQ(role_.rule->polls, 1);
}

TEST_F(NodeTest, WantsTheNextCallWhenTheFirstOfItsPartsHasSomethingToDo) {
  Join();
  const TimePoint now = Clock::now();
  parts_.own.Publish();  // so the next STATUS is due a heartbeat after `now` or later
  const Duration heartbeat = runtime::OwnStatus::kHeartbeat;
  EXPECT_EQ(role_.node().Poll(now), now + heartbeat);
  role_.rule->wait = milliseconds(3);
  EXPECT_EQ(role_.node().Poll(now), now + milliseconds(3));
  role_.wait = milliseconds(2);
  EXPECT_EQ(role_.node().Poll(now), now + milliseconds(2));
  parts_.own.Leave();
  EXPECT_EQ(role_.node().Poll(now), now + heartbeat);
}

// ---- the driver --------------------------------------------------------------------------------

using NodeOfADriverTest = test::DriverInRun;

TEST_F(NodeOfADriverTest, CountsWhatItRefusesOfRunAndResend) {
  script_.SayRun(run_t::GO, -1);
  run_t run = runtime::MakeRunPart(Script::kRunId, run_t::STOP, 0, "", {"x"}, 0);
  run.pace = std::numeric_limits<double>::quiet_NaN();
  script_.Say(run);
  EXPECT_EQ(Status().not_finite, 1);
  run.pace = 0;
  run.progress = std::numeric_limits<std::int64_t>::max();
  script_.Say(run);
  EXPECT_EQ(Status().out_of_window, 1);
  run.header.run_id = Script::kRunId + 1;
  script_.Say(run);
  EXPECT_EQ(Status().foreign, 1);
  SayBytes("RUN", std::vector<std::uint8_t>(100));
  EXPECT_EQ(Status().wrong_type, 1);
  script_.AskFor("DRIVER_COMMAND", -1, 1);
  script_.AskFor("DRIVER_COMMAND", std::numeric_limits<std::int64_t>::max(), 1);
  EXPECT_EQ(Status().out_of_window, 3);
  SayBytes("RESEND", std::vector<std::uint8_t>(3));
  EXPECT_EQ(Status().malformed, 1);
  EXPECT_FALSE(own_.left());
}

}  // namespace
}  // namespace fogline
