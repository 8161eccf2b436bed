// The messages that a role publishes and keeps, and its answers to requests.
#include "services/runtime/node/outputs.h"

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

class OutputsTest : public test::FakeRoleInRun {
 protected:
  /// The role publishes a step.
  void Publish(std::int64_t step) {
    std::vector<std::uint8_t> bytes;
    runtime::Encode(Script::Of<driver_command_t>(step), bytes);
    role_.node().outputs().Publish(IndexOf<driver_command_t>(), step, bytes);
    parts_.steps.StartAt(step + 1);
    script_.bus().Drain();
  }
  std::vector<std::int64_t> Published() const {
    std::vector<std::int64_t> steps;
    for (const driver_command_t& command : commands_) steps.push_back(command.header.step);
    return steps;
  }
  std::vector<driver_command_t>& commands_ = script_.Listen<driver_command_t>();
};

TEST_F(OutputsTest, PublishAStepOnceAndAgainOnRequest) {
  Join();
  for (std::int64_t step = 0; step < 3; ++step) Publish(step);
  EXPECT_THAT(Published(), ElementsAre(0, 1, 2));
  commands_.clear();
  script_.AskFor("DRIVER_COMMAND", 1, 5);
  EXPECT_THAT(Published(), ElementsAre(1, 2));
  EXPECT_EQ(parts_.own.message().repairs_served, 2);
}

TEST_F(OutputsTest, OnlyKeepAStepForWhichTheRecorderAnswers) {
  constexpr std::int64_t kProgress = 100;
  Join(kProgress);
  constexpr std::int64_t kOld = kProgress - 2 * runtime::kMaxAhead;
  Publish(kOld);
  EXPECT_THAT(Published(), IsEmpty());
  Publish(kOld + 1);
  EXPECT_THAT(Published(), ElementsAre(kOld + 1));
  commands_.clear();
  script_.AskFor("DRIVER_COMMAND", kOld, 1);
  EXPECT_THAT(Published(), ElementsAre(kOld));
}

TEST_F(OutputsTest, PublishEveryStepInRealtime) {
  Join(100, 1);
  Publish(0);
  EXPECT_THAT(Published(), ElementsAre(0));
}

TEST_F(OutputsTest, RefuseAMessageThatIsTooLarge) {
  Join();
  const std::vector<std::uint8_t> huge(runtime::kMaxMessageBytes + 1);
  try {
    role_.node().outputs().Publish(IndexOf<driver_command_t>(), 5, huge);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "step 5: DRIVER_COMMAND takes 1401 bytes, at most 1400 fit");
  }
}

TEST_F(OutputsTest, TellTheRuleOfAStepThatIsNotComputedYet) {
  Join();
  Publish(0);
  script_.AskFor("DRIVER_COMMAND", 0, 1);
  EXPECT_THAT(role_.rule->asked_ahead, IsEmpty());
  script_.AskFor("DRIVER_COMMAND", 1, 1);
  EXPECT_THAT(role_.rule->asked_ahead, ElementsAre(1));
}

TEST_F(OutputsTest, TellTheWorkOfEveryRequestWhileTheRoleRuns) {
  script_.AskFor("TRUTH", 3, 2);
  EXPECT_THAT(role_.asked, IsEmpty());
  Join();
  script_.AskFor("TRUTH", 3, 2);
  script_.AskFor("STATUS", 7, 1);
  EXPECT_THAT(role_.asked, ElementsAre("TRUTH 3 2"));
  EXPECT_THAT(role_.asked_status, ElementsAre(7));
}

TEST_F(OutputsTest, RefuseRequestsOfAnotherRunAndImpossibleSteps) {
  Join();
  auto foreign = Script::Of<resend_t>(0);
  foreign.header.run_id = Script::kRunId + 1;
  foreign.channel = "DRIVER_COMMAND";
  script_.Say(foreign);
  EXPECT_EQ(parts_.own.message().foreign, 1);
  script_.AskFor("DRIVER_COMMAND", -1, 1);
  script_.AskFor("DRIVER_COMMAND", runtime::kMaxStep + 1, 1);
  EXPECT_EQ(parts_.own.message().out_of_window, 2);
  EXPECT_THAT(role_.asked, IsEmpty());
}

// ---- the driver --------------------------------------------------------------------------------

using OutputsOfADriverTest = test::DriverInRun;

TEST_F(OutputsOfADriverTest, AnswersARangeFromItsRing) {
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
  script_.AskFor("DRIVER_COMMAND", 7, 0);  // from a requester that does not know ranges
  EXPECT_EQ(commands_.size(), 1U);
}

TEST_F(OutputsOfADriverTest, AnswersAFloodOfRequestsWithAFewMessages) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t k = 0; k < runtime::kRingSteps; ++k) script_.Say(Truth(k));
  commands_.clear();
  constexpr int kRequests = 200;
  const TimePoint began = Clock::now();
  for (int i = 0; i < kRequests; ++i) script_.AskFor("DRIVER_COMMAND", 0, 1'000'000'000);
  const std::chrono::duration<double> took = Clock::now() - began;
  // The requests are for 12,800 messages. The role sends each step at most once per millisecond, so
  // at most 1000 times in a second.
  EXPECT_GE(commands_.size(), static_cast<std::size_t>(runtime::kRingSteps));
  EXPECT_LE(static_cast<double>(commands_.size()), runtime::kRingSteps * (1 + 1000 * took.count()));
}

TEST_F(OutputsOfADriverTest, AnswersForTheNewestStepsInAFloodOfRequestsForOldOnes) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t k = 0; k < runtime::kRingSteps; ++k) script_.Say(Truth(k));
  // GIVEN a node whose rate limit permits no further answers with old steps for the moment
  const TimePoint until = Clock::now() + milliseconds(20);
  while (Clock::now() < until) script_.AskFor("DRIVER_COMMAND", 0, runtime::kRingSteps - 3);
  commands_.clear();
  // WHEN a role requests the step for which the run waits
  script_.AskFor("DRIVER_COMMAND", runtime::kRingSteps - 1, 1);
  EXPECT_EQ(commands_.size(), 1U);
}

}  // namespace
}  // namespace fogline
