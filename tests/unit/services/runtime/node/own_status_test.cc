// The state of a role in its run, and its STATUS.
#include "services/runtime/node/own_status.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "tests/unit/services/runtime/driver_in_run.h"
#include "tests/unit/services/runtime/node/fake_role.h"

namespace fogline {
namespace {

using test::FakeRole;
using test::Script;
using testing::ElementsAre;
using testing::IsEmpty;

class OwnStatusTest : public test::FakeRoleInRun {
 protected:
  /// All STATUS messages so far.
  const std::vector<status_t>& said() {
    script_.bus().Drain();
    return status_;
  }
  runtime::OwnStatus& own_ = parts_.own;
};

TEST_F(OwnStatusTest, SaysNothingInNoRun) {
  FakeRole role(script_.bus(), std::nullopt);
  role.node().parts().own.Publish();
  EXPECT_THAT(said(), IsEmpty());
  EXPECT_TRUE(role.node().parts().own.Waits());
}

TEST_F(OwnStatusTest, NamesTheRoleTheRunAndTheScenario) {
  Join();
  own_.Publish();
  const status_t& status = said().back();
  EXPECT_EQ(status.role, "driver");
  EXPECT_EQ(status.header.run_id, Script::kRunId);
  EXPECT_EQ(status.header.step, -1);
  EXPECT_EQ(status.scenario_hash, runtime::HashOf(script_.text()));
  EXPECT_EQ(status.state, status_t::READY);
}

TEST_F(OwnStatusTest, LetsTheWorkMakeItTrueAndTheRuleCompleteIt) {
  Join();
  role_.before_status = [this] { ++own_.message().repairs_asked; };
  own_.Publish();
  EXPECT_EQ(said().back().repairs_asked, 1);
  EXPECT_EQ(said().back().waiting_for, FakeRole::kWaitingFor);
}

TEST_F(OwnStatusTest, IsDueAfterAHeartbeatAndNumbered) {
  Join();
  const TimePoint now = Clock::now();
  own_.Publish();
  const std::size_t before = said().size();
  const TimePoint due = own_.Poll(now);
  EXPECT_GE(due, now + runtime::OwnStatus::kHeartbeat);
  EXPECT_EQ(said().size(), before);
  own_.Poll(due);
  ASSERT_EQ(said().size(), before + 1);
  EXPECT_EQ(status_[before].sequence, status_[before - 1].sequence + 1);
}

TEST_F(OwnStatusTest, CountsWhatIsRefusedByKind) {
  own_.Refuse(&status_t::foreign);
  own_.Refuse(&status_t::foreign);
  own_.Refuse(&status_t::malformed);
  EXPECT_EQ(own_.message().foreign, 2);
  EXPECT_EQ(own_.message().malformed, 1);
}

TEST_F(OwnStatusTest, FailsOnceWithTheFirstErrorAndLeaves) {
  Join();
  own_.Fail("first");
  own_.Fail("second");
  EXPECT_TRUE(own_.left());
  EXPECT_FALSE(own_.Running());
  EXPECT_EQ(role_.leaves, 1);
  EXPECT_EQ(said().back().state, status_t::FAILED);
  EXPECT_EQ(said().back().error, "first");
}

TEST_F(OwnStatusTest, FailsEvenIfTheWorkFailsWhileItMakesItTrue) {
  Join();
  role_.before_status = [this] {
    if (own_.message().state != status_t::FAILED) own_.Fail("the disk is full");
  };
  own_.Publish();
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(role_.leaves, 1);
  EXPECT_EQ(said().back().error, "the disk is full");
}

TEST_F(OwnStatusTest, LeavesOnceAndKeepsItsState) {
  Join();
  const std::size_t before = said().size();
  own_.Leave();
  own_.Leave();
  EXPECT_TRUE(own_.left());
  EXPECT_FALSE(own_.released());
  EXPECT_EQ(role_.leaves, 1);
  ASSERT_EQ(said().size(), before + 1);
  EXPECT_EQ(said().back().state, status_t::READY);
}

TEST_F(OwnStatusTest, GivesUpItsPlaceForAnotherRun) {
  Join();
  own_.Release("another process is the driver");
  EXPECT_TRUE(own_.released());
  EXPECT_FALSE(own_.left());
  EXPECT_FALSE(own_.Running());
  EXPECT_EQ(said().back().state, status_t::LEFT);
  EXPECT_EQ(said().back().error, "another process is the driver");
}

TEST_F(OwnStatusTest, CutsItsErrorWhereTheOtherFieldsAreLong) {
  Join();
  own_.message().host = std::string(600, 'h');
  own_.Fail(std::string(700, 'e'));
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(role_.leaves, 1);
  EXPECT_THAT(said().back().error, testing::StartsWith("eeee"));
}

// ---- the driver --------------------------------------------------------------------------------

using OwnStatusOfADriverTest = test::DriverInRun;

TEST_F(OwnStatusOfADriverTest, CutsAnErrorToWhatAStatusHasPlaceFor) {
  script_.SayRun(run_t::GO, -1);
  const std::string huge(10'000, 'x');
  const std::vector<std::string> parts = runtime::SplitScenario(huge);
  Script other;
  runtime::StepNode<driver::Driver> node(other.bus(), Script::kRunId);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    other.Say(
        runtime::MakeRunPart(Script::kRunId, run_t::PREPARE, 0, runtime::HashOf(huge), parts, i));
  }
  EXPECT_TRUE(node.node().parts().own.left());
  EXPECT_LE(node.node().parts().own.message().error.size(), 700U);
}

}  // namespace
}  // namespace fogline
