// The tests read the run of a log in which messages are missing.
#include "services/log/run_log.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline {
namespace {

using test::kSteps;
using testing::HasSubstr;

class RunLogTest : public testing::Test {
 protected:
  /// The run in a log that has these messages only.
  log::RunLog Read(const test::ShortLog& contents) const { return test::RunOf(file_, contents); }
  static test::ShortLog InRealTime(bool (*has)(std::string_view channel, std::int64_t step)) {
    return {.realtime = true, .has = has};
  }

 private:
  test::ScratchFolder folder_;
  const std::string file_ = folder_.File("log");
};

TEST_F(RunLogTest, InRealTimeHasEndedWithoutTheLastStateOfTheWorldAndIsIncomplete) {
  const log::RunLog run = Read(InRealTime([](std::string_view channel, std::int64_t step) {
    return !(channel == ChannelOf<truth_t>().name && step == kSteps - 1);
  }));
  EXPECT_EQ(run.steps, kSteps);
  EXPECT_TRUE(run.ended) << run.note;
  EXPECT_FALSE(run.complete);
  EXPECT_EQ(run.note, "real time, 1 messages missing; published, but not in the log: 1");
  ASSERT_TRUE(run.realtime);
  EXPECT_EQ(run.realtime->unlogged_messages, 1);
}

TEST_F(RunLogTest, InRealTimeHasEndedWithTheLastStepOfAWorldThatIsDone) {
  test::ShortLog collision = InRealTime([](std::string_view channel, std::int64_t step) {
    return step == 0 || (step == 1 && channel != ChannelOf<truth_t>().name);
  });
  EXPECT_FALSE(Read(collision).ended);
  collision.done = 1;
  EXPECT_TRUE(Read(collision).ended) << Read(collision).note;
}

TEST_F(RunLogTest, InRealTimeIsCompleteWithoutAMessageThatWasNotPublished) {
  const log::RunLog run = Read(InRealTime([](std::string_view channel, std::int64_t step) {
    return !(channel == ChannelOf<radar_t>().name && step == 1);
  }));
  EXPECT_TRUE(run.complete) << run.note;
  EXPECT_EQ(run.note, "real time, 1 messages missing");
}

TEST_F(RunLogTest, InRealTimeIsIncompleteWithoutItsLastStep) {
  const log::RunLog run = Read(InRealTime(
      [](std::string_view /*channel*/, std::int64_t step) { return step < kSteps - 1; }));
  EXPECT_FALSE(run.ended);
  EXPECT_FALSE(run.complete);
  EXPECT_THAT(run.note, HasSubstr("ends after step 1 of 3"));
}

TEST_F(RunLogTest, InRealTimeHasNoStepBeyondTheScenarioThatAMessageBeforeItClaims) {
  test::ShortLog contents{.realtime = true};
  contents.early = std::int64_t{1} << 20;
  const log::RunLog run = Read(contents);
  EXPECT_EQ(run.steps, kSteps);
  EXPECT_TRUE(run.complete) << run.note;
}

TEST_F(RunLogTest, InLockstepIsIncompleteWithoutTheLastStateOfTheWorld) {
  const log::RunLog run = Read({.has = [](std::string_view channel, std::int64_t step) {
    return !(channel == ChannelOf<truth_t>().name && step == kSteps - 1);
  }});
  EXPECT_EQ(run.steps, kSteps - 1);
  EXPECT_FALSE(run.complete);
  EXPECT_THAT(run.note, HasSubstr("ends after step 1 of 3"));
}

}  // namespace
}  // namespace fogline
