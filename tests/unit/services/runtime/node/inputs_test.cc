// The messages that a role's inputs refuse, and the messages that they keep.
#include "services/runtime/node/inputs.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/services/runtime/driver_in_run.h"
#include "tests/unit/services/runtime/node/fake_role.h"

namespace fogline {
namespace {

using test::FakeRole;
using test::Script;
using testing::ElementsAre;
using testing::IsEmpty;
using Verdict = runtime::StepRing::Verdict;

class InputsTest : public test::FakeRoleInRun {
 protected:
  void SayTruth(std::int64_t step, double gap_m = 0) {
    auto truth = Script::Of<truth_t>(step);
    truth.host_gap_m = gap_m;
    script_.Say(truth);
  }
  /// Passes a step to the inputs, as if it came from the log of an earlier process.
  void Remember(std::int64_t step) {
    std::vector<std::uint8_t> bytes;
    runtime::Encode(Script::Of<truth_t>(step), bytes);
    parts_.inputs.Remember(0, step, bytes);
  }
  runtime::Input& truth() { return parts_.inputs.Of(IndexOf<truth_t>()); }
  const status_t& counted() const { return parts_.own.message(); }
};

TEST_F(InputsTest, AreThoseOfTheGraphInItsOrder) {
  ASSERT_EQ(parts_.inputs.all().size(), 1U);
  EXPECT_EQ(&truth(), &parts_.inputs.all()[0]);
  EXPECT_EQ(truth().lag, 0);
  EXPECT_FALSE(truth().on_demand);
  const runtime::Input& host = parts_.inputs.ReadOnDemand(IndexOf<arbitration_t>());
  EXPECT_EQ(&host, &parts_.inputs.all()[1]);
  EXPECT_EQ(host.lag, 1) << "its producer comes later in a step";
  EXPECT_TRUE(host.on_demand);
}

TEST_F(InputsTest, HearNothingBeforeTheRoleHasJoinedAndAfterItHasLeft) {
  SayTruth(0);
  Join();
  SayTruth(1);
  parts_.own.Leave();
  SayTruth(2);
  EXPECT_THAT(role_.rule->kept, ElementsAre(1));
  EXPECT_FALSE(truth().ring.Has(0));
  EXPECT_FALSE(truth().ring.Has(2));
}

TEST_F(InputsTest, PassToTheRuleOnlyWhatIsOfThisRunAndOfAStepOfTheScenario) {
  Join();
  auto foreign = Script::Of<truth_t>(0);
  foreign.header.run_id = Script::kRunId + 1;
  script_.Say(foreign);
  for (const std::int64_t step : {std::int64_t{-1}, parts_.run.steps, parts_.run.steps + 1000}) {
    SayTruth(step);
  }
  EXPECT_EQ(role_.rule->heard, 0);
  EXPECT_EQ(counted().foreign, 1);
  EXPECT_EQ(counted().out_of_window, 3);
  SayTruth(parts_.run.steps - 1);
  EXPECT_EQ(role_.rule->heard, 1);
}

TEST_F(InputsTest, KeepOnlyWhatTheRuleLetsIn) {
  Join();
  role_.rule->verdict = Verdict::kDuplicate;
  SayTruth(0);
  EXPECT_EQ(counted().duplicates, 1);
  role_.rule->verdict = Verdict::kOutOfWindow;
  SayTruth(0);
  EXPECT_EQ(counted().out_of_window, 1);
  role_.rule->verdict = Verdict::kLate;
  SayTruth(0);
  role_.rule->verdict = Verdict::kElsewhere;
  SayTruth(0);
  EXPECT_FALSE(truth().ring.Has(0));
  role_.rule->verdict = Verdict::kNew;
  SayTruth(0);
  EXPECT_TRUE(truth().ring.Has(0));
  EXPECT_THAT(role_.rule->kept, ElementsAre(0));
}

TEST_F(InputsTest, HandOnOnlySoundMessagesThatAreNew) {
  Join();
  std::vector<double> gaps_m;
  truth().keep = [&gaps_m](std::int64_t /*step*/, runtime::Arrival& arrival) {
    gaps_m.push_back(arrival.As<truth_t>()->host_gap_m);
  };
  SayTruth(0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(gaps_m, IsEmpty());
  EXPECT_EQ(counted().not_finite, 1);
  SayTruth(0, 40);
  SayTruth(0, 40);
  EXPECT_THAT(gaps_m, ElementsAre(40));
  EXPECT_EQ(counted().duplicates, 1);
}

TEST_F(InputsTest, AreReadyForAStepWhoseMessageIsThereOrWouldBeFromBeforeTheRun) {
  Join();
  EXPECT_FALSE(truth().ReadyFor(0));
  SayTruth(0);
  EXPECT_TRUE(truth().ReadyFor(0));
  const runtime::Input& host = parts_.inputs.ReadOnDemand(IndexOf<arbitration_t>());
  EXPECT_TRUE(host.ReadyFor(0));
  EXPECT_FALSE(host.ReadyFor(1));
}

TEST_F(InputsTest, BlameTheOtherProgramForAMessageThatContradictsTheLog) {
  Join();
  Remember(3);
  SayTruth(3);
  EXPECT_FALSE(parts_.own.left()) << "it is what the log has";
  SayTruth(3, 40);
  EXPECT_EQ(counted().error,
            "step 3: TRUTH differs from the log: world is not the program or version that was "
            "recorded");
}

TEST_F(InputsTest, BlameASecondProducerForAnyOtherContradiction) {
  Join();
  Remember(3);
  SayTruth(4);
  SayTruth(4, 40);
  EXPECT_EQ(counted().error,
            "step 4: TRUTH came twice with different contents: is there a second world?");
}

// ---- the driver --------------------------------------------------------------------------------

using InputsOfADriverTest = test::DriverInRun;

TEST_F(InputsOfADriverTest, CountsUnsoundMessagesByKindAndGivesThemNoPlace) {
  script_.SayRun(run_t::GO, -1);
  // WHEN invalid messages come before the valid message of their step
  SayUnsound(0);
  SayBytes("TRUTH", std::vector<std::uint8_t>(runtime::kHeaderEnd - 1));
  truth_t infinite = Truth(0);
  infinite.preceding_speed_mps = -std::numeric_limits<double>::infinity();
  script_.Say(infinite);
  EXPECT_TRUE(commands_.empty());
  // THEN the valid message still has its effect
  script_.Say(Truth(0));
  EXPECT_EQ(commands_.size(), 1U);
  EXPECT_EQ(Status().wrong_type, 1);
  EXPECT_EQ(Status().malformed, 2);
  EXPECT_EQ(Status().not_finite, 2);
}

TEST_F(InputsOfADriverTest, TakesNoUnsoundMessageForASecondProducer) {
  script_.SayRun(run_t::GO, -1);
  script_.Say(Truth(0));
  SayUnsound(0);
  EXPECT_FALSE(own_.left());
  EXPECT_EQ(Status().wrong_type, 1);
  EXPECT_EQ(Status().malformed, 1);
  EXPECT_EQ(Status().not_finite, 1);
  // A second valid message with other contents ends the node.
  truth_t other = Truth(0);
  other.host_gap_m += 1;
  script_.Say(other);
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(own_.message().error,
            "step 0: TRUTH came twice with different contents: is there a second world?");
}

}  // namespace
}  // namespace fogline
