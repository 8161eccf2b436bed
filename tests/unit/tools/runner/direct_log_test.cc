#include "tools/runner/direct_log.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/errors.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/copied_log.h"
#include "tests/support/input_errors.h"
#include "tests/unit/tools/short_run.h"
#include "tools/runner/resumed_log.h"

namespace fogline::test {
namespace {

using runner::DirectLog;
using runner::RunOptions;

constexpr std::int64_t kDirectSteps = 12;
constexpr std::int64_t kDirectCut = 7;

class DirectLogTest : public testing::Test {
 protected:
  /// Passes the messages of these steps from one log to another log.
  static void AddSteps(const std::string& from, DirectLog& to, std::int64_t first,
                       std::int64_t end) {
    log::EventLogReader reader(from);
    while (const auto event = reader.Next()) {
      const std::size_t channel = ChannelNamed(event->channel);
      if (channel == kNumChannels || kChannels[channel].pace != Pace::kStep) continue;
      const std::int64_t step = runtime::ReadInt64(event->data, runtime::kStepOffset);
      if (step < first || step >= end) continue;
      to.Add(step, kChannels[channel], event->utime, event->data);
    }
  }
  /// Writes the log of a run up to step kDirectCut - 1. @return the options that resume this log
  RunOptions Resumed() const {
    Copy(log_, part_,
         [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
           return event.channel == "RUN" ||
                  runtime::ReadInt64(data, runtime::kStepOffset) < kDirectCut;
         });
    RunOptions options = Direct(part_);
    options.resume = runner::ResumedLog(part_, nullptr).resumption();
    return options;
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string part_ = folder_.File("part.lcm");
  const Scenario scenario_ = Paper(kDirectSteps);
  const runner::RunResult whole_ = runner::RunScenario(scenario_, Direct(log_));
  const std::int64_t run_id_ = ReadToTheEnd(log_).run_id;
};

TEST_F(DirectLogTest, HasTheScenarioAndAllMessagesAndASealAtItsEnd) {
  const std::string file = folder_.File("again.lcm");
  DirectLog log(Direct(file), run_id_, scenario_);
  AddSteps(log_, log, 0, kDirectSteps);
  log.Flush();
  log.End(whole_);
  EXPECT_TRUE(Content(file) == Content(log_));
  const log::RunLog run = ReadToTheEnd(file);
  ASSERT_TRUE(run.seal);
  EXPECT_TRUE(run.complete);
  EXPECT_EQ(run.seal->says.digest, whole_.digest);
}

TEST_F(DirectLogTest, IsOnTheDiskOnceItIsFlushed) {
  const std::string file = folder_.File("again.lcm");
  DirectLog log(Direct(file), run_id_, scenario_);
  AddSteps(log_, log, 0, 3);
  log.Flush();
  EXPECT_EQ(ReadToTheEnd(file).steps, 3);
}

TEST_F(DirectLogTest, OfAnInterruptedRunIsSealedAsFarAsItGoes) {
  const std::string file = folder_.File("again.lcm");
  DirectLog log(Direct(file), run_id_, scenario_);
  AddSteps(log_, log, 0, 5);
  log.CutOff();
  const log::RunLog run = ReadToTheEnd(file);
  ASSERT_TRUE(run.seal && run.seal->whole);
  EXPECT_EQ(run.seal->says.steps, 5);
  EXPECT_FALSE(run.seal->says.complete);
}

TEST_F(DirectLogTest, GoesOnBehindTheStepsThatItHas) {
  DirectLog log(Resumed(), run_id_, scenario_);
  AddSteps(log_, log, 0, kDirectSteps);
  log.Flush();
  log.End(whole_);
  EXPECT_TRUE(Content(part_) == Content(log_));
}

TEST_F(DirectLogTest, RefusesAMessageThatIsNotTheOneItHas) {
  DirectLog log(Resumed(), run_id_, scenario_);
  AddSteps(log_, log, 0, 2);
  std::vector<std::uint8_t> other;
  truth_t truth{};
  truth.header.step = 2;
  runtime::Encode(truth, other);
  EXPECT_EQ(ErrorOf([&] { log.Add(2, ChannelOf<truth_t>(), 0, other); }),
            part_ +
                ": error: --resume: step 2: TRUTH differs from what world computes here: the log "
                "was made by another program, or another version");
}

TEST_F(DirectLogTest, CannotBeWrittenWhereThereIsNoFolder) {
  EXPECT_THROW(DirectLog(Direct(folder_.File("none/run.lcm")), 1, scenario_), InputError);
}

}  // namespace
}  // namespace fogline::test
