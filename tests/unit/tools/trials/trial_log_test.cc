#include "tools/trials/trial_log.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "services/log/run_log.h"
#include "tests/support/command.h"
#include "tools/runner/scenario_run.h"

namespace fogline::trials {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// The sealed log of a run of 20 steps.
class TrialLogTest : public ::testing::Test {
 protected:
  TrialLogTest() {
    Scenario scenario;
    scenario.steps = 20;
    result_ = runner::RunScenario(scenario, {.transport = "direct", .log = log_});
  }

  trial_t Fact(std::int8_t kind, std::int64_t sequence, const std::string& text = "") const {
    trial_t fact{};
    fact.header.run_id = ReadStory(log_).run_id;
    fact.kind = kind;
    fact.sequence = sequence;
    fact.participant = 3;
    fact.trial = 2;
    fact.attempt = 1;
    fact.condition = "fog";
    fact.text = text;
    return fact;
  }

  test::ScratchFolder folder_;
  std::filesystem::path log_ = folder_.path() / "trial.lcm";
  runner::RunResult result_;
};

TEST_F(TrialLogTest, ACompleteRunWithoutAnEndIsToBeAsked) {
  const TrialStory story = ReadStory(log_);
  EXPECT_EQ(story.state, TrialState::kToAsk);
  EXPECT_EQ(story.steps, 20);
  EXPECT_THAT(story.facts, IsEmpty());
}

TEST_F(TrialLogTest, FactsAreAddedBehindTheRunAndChangeNeitherItsDigestNorItsCompleteness) {
  AddFacts(log_, ReadStory(log_), {Fact(trial_t::BEGIN, 0), Fact(trial_t::ANSWER, 1, "fine")},
           nullptr);
  AddFacts(log_, ReadStory(log_), {Fact(trial_t::END, 2)}, nullptr);
  const TrialStory story = ReadStory(log_);
  EXPECT_EQ(story.state, TrialState::kDone);
  EXPECT_FALSE(story.altered);
  ASSERT_THAT(story.facts, SizeIs(3));
  EXPECT_EQ(story.facts[1].text, "fine");
  EXPECT_EQ(story.facts[1].condition, "fog");
  const runner::LoggedRun run = runner::ReadLoggedRun(log_);
  EXPECT_TRUE(run.complete);
  EXPECT_THAT(run.note, IsEmpty());
  EXPECT_EQ(run.digest, result_.digest);
}

TEST_F(TrialLogTest, AFactIsAddedOnce) {
  AddFacts(log_, ReadStory(log_), {Fact(trial_t::BEGIN, 0)}, nullptr);
  const std::string before = test::Content(log_);
  AddFacts(log_, ReadStory(log_), {Fact(trial_t::BEGIN, 0)}, nullptr);
  EXPECT_EQ(test::Content(log_), before);
}

TEST_F(TrialLogTest, AFactWithTheLongestTextsIsReadAgain) {
  std::string letters;
  for (int i = 0; i < 50; ++i) letters += "\u00e4";  // two bytes each
  trial_t fact = Fact(trial_t::ANSWER, 0);
  fact.experiment = letters;
  fact.unit = letters;
  AddFacts(log_, ReadStory(log_), {fact}, nullptr);
  const TrialStory story = ReadStory(log_);
  ASSERT_THAT(story.facts, SizeIs(1));
  EXPECT_EQ(story.facts[0].experiment, letters);
  EXPECT_EQ(story.facts[0].unit, letters);
}

TEST_F(TrialLogTest, AFactThatNoReaderWouldUseIsNotWritten) {
  trial_t fact = Fact(trial_t::END, 1);
  fact.experiment = std::string(101, 'x');
  const std::string before = test::Content(log_);
  EXPECT_THROW(AddFacts(log_, ReadStory(log_), {Fact(trial_t::BEGIN, 0), fact}, nullptr),
               std::runtime_error);
  EXPECT_EQ(test::Content(log_), before);
}

TEST_F(TrialLogTest, ALogThatWasChangedGetsNothing) {
  const std::string sealed = test::Content(log_);
  const std::size_t last_truth = sealed.rfind("TRUTH");
  // The first place is in a message, which the digest covers. The second place is the last byte of
  // the event's time, which only the hash of the file covers.
  for (const std::size_t place : {last_truth + 60, last_truth - 9}) {
    std::string bytes = sealed;
    bytes[place] ^= 1;
    std::ofstream(log_, std::ios::binary) << bytes;
    const TrialStory story = ReadStory(log_);
    EXPECT_TRUE(story.altered) << story.note;
    EXPECT_THROW(AddFacts(log_, story, {Fact(trial_t::END, 0)}, nullptr), std::runtime_error);
    EXPECT_EQ(test::Content(log_), bytes);
    std::ofstream(log_, std::ios::binary) << sealed;
  }
}

TEST_F(TrialLogTest, ALogThatEndsEarlyIsThatOfABrokenRun) {
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  const TrialStory story = ReadStory(log_);
  EXPECT_EQ(story.state, TrialState::kBroken);
  EXPECT_THAT(story.note, HasSubstr("ends after step"));
}

TEST_F(TrialLogTest, AFileThatIsNoLogIsThatOfABrokenRun) {
  std::ofstream(log_) << "";
  EXPECT_EQ(ReadStory(log_).state, TrialState::kBroken);
  std::ofstream(log_) << "no log";
  EXPECT_EQ(ReadStory(log_).state, TrialState::kBroken);
}

TEST_F(TrialLogTest, TheTextOfAFaultNamesTheLogOnce) {
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  const std::string early = ReadStory(log_).note;
  EXPECT_EQ(FaultText(log_, ReadStory(log_)), log_.string() + ": " + early);
  std::ofstream(log_) << "no log";
  const std::string unreadable = ReadStory(log_).note;
  EXPECT_THAT(unreadable, StartsWith(log_.string() + ": error: "));
  EXPECT_EQ(FaultText(log_, ReadStory(log_)), unreadable);
}

}  // namespace
}  // namespace fogline::trials
