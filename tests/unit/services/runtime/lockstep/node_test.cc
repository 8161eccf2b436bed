// A role in a run. The example is the driver: TRUTH in, DRIVER_COMMAND out.
#include "services/runtime/node/node.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>

#include <csignal>
#include <limits>

#include "services/driver/driver.h"
#include "services/runtime/process/step_node.h"
#include "tests/unit/runtime/script.h"

namespace fogline {
namespace {

using test::Script;

class NodeTest : public testing::Test {
 protected:
  truth_t Truth(std::int64_t step) {
    auto truth = Script::Of<truth_t>(step);
    truth.host_gap_m = 40;
    truth.host_speed_mps = 20 + 0.01 * static_cast<double>(step);
    return truth;
  }
  /// The encoded TRUTH of a step, for tests that change its bytes.
  std::vector<std::uint8_t> Encoded(const truth_t& truth) {
    std::vector<std::uint8_t> bytes;
    runtime::Encode(truth, bytes);
    return bytes;
  }
  void SayBytes(std::string_view channel, runtime::Bytes bytes) {
    script_.bus().Publish(channel, bytes);
    script_.bus().Drain();
  }
  /// The node's next STATUS, half a second later.
  const status_t& Status() {
    later_ += milliseconds(500);
    script_.Poll(node_, Clock::now() + later_);
    return status_.back();
  }
  /// Publishes three invalid messages of a step.
  void SayUnsound(std::int64_t step) {
    std::vector<std::uint8_t> other_type = Encoded(Truth(step));
    other_type[0] ^= 1;
    SayBytes("TRUTH", other_type);
    std::vector<std::uint8_t> longer = Encoded(Truth(step));
    longer.push_back(0);
    SayBytes("TRUTH", longer);
    truth_t nan = Truth(step);
    nan.host_gap_m = std::numeric_limits<double>::quiet_NaN();
    SayBytes("TRUTH", Encoded(nan));
  }

  /// Answers every step of every request, as a network without loss would.
  void AnswerRequests() {
    while (served_ < requests_.size()) {
      const resend_t request = requests_[served_++];
      if (request.channel != "TRUTH") continue;
      for (std::int64_t k = 0; k < request.count; ++k) {
        script_.Say(Truth(request.header.step + k));
      }
      script_.Poll(node_);
    }
  }

  Script script_;
  std::vector<resend_t>& requests_ = script_.Listen<resend_t>();
  std::vector<driver_command_t>& commands_ = script_.Listen<driver_command_t>();
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  runtime::StepNode<driver::Driver> node_{script_.bus(), Script::kRunId};
  runtime::OwnStatus& own_ = node_.node().parts().own;
  std::size_t served_ = 0;
  Duration later_{};
};

TEST_F(NodeTest, AsksForTheScenarioOfItsRunUnasked) {
  script_.Poll(node_);
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].channel, "RUN");
}

TEST_F(NodeTest, AsksForOneStepAtATimeWhenItIsInStep) {
  script_.SayRun(run_t::GO, -1);
  script_.Say(Truth(0));
  // WHEN another role asks for an answer and the node lacks its input
  script_.AskFor("DRIVER_COMMAND", 1, 1);
  // THEN the node asks for this input
  ASSERT_EQ(requests_.size(), 2U);
  EXPECT_EQ(requests_[1].channel, "TRUTH");
  EXPECT_EQ(requests_[1].header.step, 1);
  EXPECT_EQ(requests_[1].count, 1);
}

TEST_F(NodeTest, WaitsBeforeItAsksForAStepThatMayBeOnItsWay) {
  script_.SayRun(run_t::GO, -1);
  script_.Say(Truth(0));
  script_.Say(Truth(2));
  script_.Poll(node_);
  EXPECT_TRUE(requests_.empty());
  script_.Poll(node_, Clock::now() + milliseconds(60));
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].header.step, 1);
  EXPECT_EQ(requests_[0].count, 1) << "step 2 is there";
}

TEST_F(NodeTest, CatchesUpManyStepsAtATimeAndInSilence) {
  constexpr std::int64_t kProgress = 200;
  script_.SayRun(run_t::GO, kProgress);
  script_.Poll(node_);
  // GIVEN that it asks at once for as many steps as its ring holds
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].header.step, 0);
  EXPECT_EQ(requests_[0].count, runtime::kRingSteps - 1);
  // WHEN it gets these steps, and all that it asks for next
  AnswerRequests();
  // THEN it reaches the step of the other roles and has asked for each step once
  script_.Say(Truth(kProgress + 1));
  ASSERT_EQ(requests_.size(), 4U);
  std::int64_t next = 0;
  for (const resend_t& request : requests_) {
    EXPECT_EQ(request.header.step, next);
    next += request.count;
  }
  EXPECT_EQ(next, kProgress + 1);
  // AND it publishes only the steps for which the recorder does not answer
  ASSERT_FALSE(commands_.empty());
  EXPECT_EQ(commands_.front().header.step, kProgress - runtime::kRingSteps + 1);
  EXPECT_EQ(commands_.back().header.step, kProgress + 1);
  EXPECT_EQ(commands_.size(), static_cast<std::size_t>(runtime::kRingSteps + 1));
}

TEST_F(NodeTest, CountsNoStepAsImpossibleThatIsUnderWayWhileItCatchesUp) {
  script_.SayRun(run_t::GO, 200);
  script_.Say(Truth(200));
  script_.Say(Truth(200 + runtime::kRingSteps));
  script_.Poll(node_, Clock::now() + milliseconds(500));
  EXPECT_EQ(status_.back().out_of_window, 0);
  script_.Say(Truth(1'000'000));
  script_.Poll(node_, Clock::now() + milliseconds(1000));
  EXPECT_EQ(status_.back().out_of_window, 1);
}

TEST_F(NodeTest, AsksAgainForWhatIsLostOnTheWay) {
  script_.SayRun(run_t::GO, 30);
  script_.Poll(node_);
  const TimePoint before = Clock::now();  // not later than the next lines, on any machine
  for (std::int64_t k = 0; k <= 30; ++k) {
    if (k != 5 && k != 9) script_.Say(Truth(k));
  }
  script_.Poll(node_, before);
  EXPECT_EQ(requests_.size(), 1U) << "it may be on its way";
  script_.Poll(node_, Clock::now() + milliseconds(10));
  ASSERT_EQ(requests_.size(), 2U);
  EXPECT_EQ(requests_[1].header.step, 5);
  EXPECT_EQ(requests_[1].count, 5) << "5 to 9";
}

TEST_F(NodeTest, AnswersARangeFromItsRing) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t k = 0; k < 10; ++k) script_.Say(Truth(k));
  const std::vector<driver_command_t> said = commands_;
  commands_.clear();
  script_.AskFor("DRIVER_COMMAND", 2, 5);
  ASSERT_EQ(commands_.size(), 5U);
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    EXPECT_EQ(commands_[i].header.step, said[i + 2].header.step);
    EXPECT_EQ(commands_[i].acceleration_mps2, said[i + 2].acceleration_mps2);
  }
  commands_.clear();
  script_.AskFor("DRIVER_COMMAND", 7, 0);  // from a requester that knows no ranges
  EXPECT_EQ(commands_.size(), 1U);
}

TEST_F(NodeTest, CountsUnsoundMessagesByKindAndGivesThemNoPlace) {
  script_.SayRun(run_t::GO, -1);
  // WHEN they come before the valid message of their step
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

TEST_F(NodeTest, TakesNoUnsoundMessageForASecondProducer) {
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

TEST_F(NodeTest, CountsWhatItRefusesOfRunAndResend) {
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

TEST_F(NodeTest, LetsAnOlderWordOfTheRunnerCountForNothing) {
  script_.SayRun(run_t::GO, -1);
  run_t older = runtime::MakeRunPart(Script::kRunId, run_t::STOP, 0, "", {"x"}, 0);
  older.sequence = 1;
  script_.Say(older);
  EXPECT_FALSE(own_.left());
  EXPECT_EQ(Status().duplicates, 1);
  older.sequence = 1000;
  script_.Say(older);
  EXPECT_TRUE(own_.left());
}

TEST_F(NodeTest, LooksForAnotherRunWhenARunnerFallsSilentBeforeAllOfTheScenarioIsThere) {
  Script other;
  runtime::StepNode<driver::Driver> node(other.bus(), std::nullopt);
  const std::vector<std::string> parts{"{", "}"};
  other.Say(Script::WithDriver(
      runtime::MakeRunPart(Script::kRunId + 1, run_t::PREPARE, 0, runtime::HashOf("{}"), parts, 0),
      0));
  other.SayRun(run_t::PREPARE, -1);
  EXPECT_TRUE(node.node().parts().own.Waits());
  other.Poll(node);
  other.PollUpTo(node, Clock::now() + milliseconds(6000));
  other.SayRun(run_t::PREPARE, -1);
  EXPECT_FALSE(node.node().parts().own.Waits());
}

/// A driver that was started by hand, in a run that waited for it.
class ExternalNodeTest : public testing::Test {
 protected:
  ExternalNodeTest() {
    script_.SayRun(run_t::PREPARE, -1);
    script_.Poll(node_);
    EXPECT_FALSE(own_.Waits());
  }

  /// The runner announces which process is the driver.
  void SayHolder(std::int64_t run_id, std::int64_t holder) {
    const std::vector<std::string> parts = runtime::SplitScenario(script_.text());
    script_.Say(Script::WithDriver(
        runtime::MakeRunPart(run_id, run_t::PREPARE, 0, runtime::HashOf(script_.text()), parts, 0),
        holder));
  }
  std::int64_t instance() const { return status_.back().instance; }

  Script script_;
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  runtime::StepNode<driver::Driver> node_{script_.bus(), std::nullopt};
  runtime::OwnStatus& own_ = node_.node().parts().own;
};

TEST_F(ExternalNodeTest, JoinsNoRunThatHasItsRoleOrStartsItItself) {
  Script other;
  const std::vector<status_t>& said = other.Listen<status_t>();
  runtime::StepNode<driver::Driver> node(other.bus(), std::nullopt);
  const std::vector<std::string> parts = runtime::SplitScenario(other.text());
  const run_t run = runtime::MakeRunPart(Script::kRunId, run_t::PREPARE, 0,
                                         runtime::HashOf(other.text()), parts, 0);
  for (int i = 0; i < 2; ++i) {
    other.Say(i == 0 ? run : Script::WithDriver(run, 4711));
    other.Poll(node, Clock::now() + milliseconds(300));
    EXPECT_TRUE(said.empty());
  }
  other.SayRun(run_t::PREPARE, -1);
  EXPECT_FALSE(node.node().parts().own.Waits());
}

TEST_F(ExternalNodeTest, GoesWhenAnotherProcessHasItsPlace) {
  SayHolder(Script::kRunId, 0);
  SayHolder(Script::kRunId, instance());
  EXPECT_FALSE(own_.released());
  SayHolder(Script::kRunId, instance() + 1);
  EXPECT_TRUE(own_.released());
  EXPECT_EQ(status_.back().state, status_t::LEFT);
  EXPECT_EQ(own_.message().error, "another process is the driver of run 7");
  // AND it publishes nothing more
  const std::size_t said = status_.size();
  script_.PollUpTo(node_, Clock::now() + milliseconds(1000));
  EXPECT_EQ(status_.size(), said);
}

TEST_F(ExternalNodeTest, GoesToARunThatWaitsForItOnlyWhenItsOwnRunnerIsSilent) {
  const std::int64_t another = Script::kRunId + 1;
  script_.PollUpTo(node_, Clock::now() + milliseconds(1900));
  SayHolder(another, 0);
  EXPECT_FALSE(own_.released()) << "the runner may be there";
  script_.PollUpTo(node_, Clock::now() + milliseconds(2100));
  SayHolder(another, 4711);
  EXPECT_FALSE(own_.released()) << "that run has a driver";
  SayHolder(another, 0);
  EXPECT_TRUE(own_.released());
  EXPECT_THAT(own_.message().error, testing::MatchesRegex("the runner of run 7 has been silent for "
                                                          "[0-9.]+ s; run 8 waits for the driver"));
}

TEST_F(ExternalNodeTest, HoldsItsOwnPauseAgainstNoRunner) {
  const TimePoint now = Clock::now();
  script_.Poll(node_, now + milliseconds(20'000));
  EXPECT_FALSE(own_.left()) << own_.message().error;
  script_.PollUpTo(node_, now + milliseconds(38'000));
  EXPECT_FALSE(own_.left()) << own_.message().error;
  script_.PollUpTo(node_, now + milliseconds(39'500));
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(own_.message().error, "the runner has been silent for 19 s");
}

TEST_F(ExternalNodeTest, WaitsAsLongAsTheRunOfARunnerThatHasStartedIt) {
  // GIVEN a process that dies with its parent
  int before = 0;
  ASSERT_EQ(prctl(PR_GET_PDEATHSIG, &before), 0);
  ASSERT_EQ(prctl(PR_SET_PDEATHSIG, SIGKILL), 0);
  Script other;
  runtime::StepNode<driver::Driver> started(other.bus(), Script::kRunId);
  ASSERT_EQ(prctl(PR_SET_PDEATHSIG, before), 0);
  other.SayRun(run_t::GO, -1);
  other.Poll(started);
  other.PollUpTo(started, Clock::now() + milliseconds(25'000));
  EXPECT_FALSE(started.node().parts().own.left()) << started.node().parts().own.message().error;
}

TEST_F(NodeTest, CutsAnErrorToWhatAStatusHasPlaceFor) {
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

TEST_F(NodeTest, AnswersAFloodOfRequestsWithAFewMessages) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t k = 0; k < runtime::kRingSteps; ++k) script_.Say(Truth(k));
  commands_.clear();
  constexpr int kRequests = 200;
  const TimePoint began = Clock::now();
  for (int i = 0; i < kRequests; ++i) script_.AskFor("DRIVER_COMMAND", 0, 1'000'000'000);
  const std::chrono::duration<double> took = Clock::now() - began;
  // Each step at most once per millisecond, of 12,800 requested messages.
  EXPECT_GE(commands_.size(), static_cast<std::size_t>(runtime::kRingSteps));
  EXPECT_LE(static_cast<double>(commands_.size()), runtime::kRingSteps * (1 + 1000 * took.count()));
}

TEST_F(NodeTest, AnswersForTheNewestStepsInAFloodOfRequestsForOldOnes) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t k = 0; k < runtime::kRingSteps; ++k) script_.Say(Truth(k));
  // GIVEN that the node has used up its burst of answers
  const TimePoint until = Clock::now() + milliseconds(20);
  while (Clock::now() < until) script_.AskFor("DRIVER_COMMAND", 0, runtime::kRingSteps - 3);
  commands_.clear();
  // WHEN a role asks for the step for which the run waits
  script_.AskFor("DRIVER_COMMAND", runtime::kRingSteps - 1, 1);
  EXPECT_EQ(commands_.size(), 1U);
}

}  // namespace
}  // namespace fogline
