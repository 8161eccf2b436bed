// The steps of a run in a log of any length, and the positions of these steps in the log.
#include "services/recorder/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <random>

#include "common/process/this_process.h"
#include "services/log/step_order.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

constexpr std::int64_t kRunId = 7;
constexpr std::string_view kScenario = R"({"version":1})";

/// A message of a step. The follower's message is longer in some steps than in others.
template <class M>
std::vector<std::uint8_t> Encoded(std::int64_t step, bool last = false) {
  M message{};
  message.header = {.run_id = kRunId, .step = step, .utime = step * 100'000};
  if constexpr (std::is_same_v<M, truth_t>) message.last = last;
  if constexpr (std::is_same_v<M, follower_command_t>) {
    message.num_followers = static_cast<std::int32_t>(step % 7);
    message.acceleration_mps2.assign(static_cast<std::size_t>(step % 7), 0.5);
    message.safe_distance_m.assign(static_cast<std::size_t>(step % 7), 40);
  }
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  return bytes;
}

void WriteStep(log::EventLogWriter& log, std::int64_t step, bool last = false) {
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    log.Write(kChannels[channel].name, step * 100'000, Encoded<M>(step, last));
  });
}

void WriteFront(log::EventLogWriter& log, bool realtime = false) {
  std::vector<std::uint8_t> bytes;
  run_t run = runtime::MakeRunPart(kRunId, run_t::PREPARE, 0, runtime::HashOf(kScenario),
                                   {std::string(kScenario)}, 0);
  run.realtime = realtime ? 1 : 0;
  runtime::Encode(run, bytes);
  log.Write(ChannelOf<run_t>().name, 0, bytes);
}

class HistoryTest : public testing::Test {
 protected:
  /// Writes a log of `steps` steps.
  void Write(std::int64_t steps) const {
    log::EventLogWriter log(file_);
    WriteFront(log);
    for (std::int64_t step = 0; step < steps; ++step) WriteStep(log, step, step == steps - 1);
  }
  /// The result of reading the log from its end. ReadFromFront() reads the log from front to back,
  /// for comparison.
  log::Remains ReadFromEnd(std::int64_t tail = log::kTailBytes) const {
    return log::ReadRemains(file_, log::ReadFront(file_), {}, tail);
  }
  log::Remains ReadFromFront() const {
    return ReadFromEnd(static_cast<std::int64_t>(std::filesystem::file_size(file_)));
  }
  void ExpectStep(recorder::History& history, std::int64_t step) const {
    std::map<std::string_view, std::vector<std::uint8_t>> messages;
    history.ForEachMessage(step, [&](std::string_view channel, runtime::Bytes bytes) {
      messages[channel].assign(bytes.begin(), bytes.end());
    });
    EXPECT_EQ(messages.size(), log::kStepChannels);
    ForEachStepChannel([&]<class M>(std::size_t channel) {
      EXPECT_EQ(messages[kChannels[channel].name], Encoded<M>(step)) << step;
    });
  }

  const test::ScratchFolder folder_;
  const std::string file_ = folder_.File("log");
};

void ExpectSame(const log::Remains& a, const log::Remains& b) {
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.head.bytes, b.head.bytes);
  EXPECT_EQ(a.head.events, b.head.events);
  EXPECT_EQ(a.last, b.last);
  EXPECT_EQ(a.final, b.final);
}

TEST_F(HistoryTest, FindsTheSameFromTheEndAsFromTheFrontWhereverTheLogIsCut) {
  constexpr std::int64_t kSteps = 60;
  constexpr std::int64_t kTail = 16'384;
  Write(kSteps);
  EXPECT_TRUE(ReadFromEnd(kTail).final);
  EXPECT_EQ(ReadFromEnd(kTail).steps, kSteps);
  // The test shortens the file by 37 bytes at a time. So it cuts each of the last 40 events at
  // several positions.
  for (auto size = static_cast<std::int64_t>(std::filesystem::file_size(file_)); size > 60'000;
       size -= 37) {
    std::filesystem::resize_file(file_, static_cast<std::uintmax_t>(size));
    const log::Remains remains = ReadFromEnd(kTail);
    ExpectSame(remains, ReadFromFront());
    EXPECT_EQ(log::OddEnd(file_, log::ReadFront(file_), remains), "");
  }
}

TEST_F(HistoryTest, InRealTimePassesOverTheStatusOfARoleThatHasComputedNoStep) {
  constexpr std::int64_t kSteps = 4;
  {
    log::EventLogWriter log(file_);
    WriteFront(log, /*realtime=*/true);
    for (std::int64_t step = 0; step < kSteps; ++step) {
      WriteStep(log, step);
      log.Write(ChannelOf<status_t>().name, step * 100'000, Encoded<status_t>(-1));
    }
  }
  EXPECT_EQ(ReadFromFront().steps, kSteps);
}

TEST_F(HistoryTest, EndsBeforeAStepThatDoesNotFollowTheOneBefore) {
  {
    log::EventLogWriter log(file_);
    WriteFront(log);
    for (const std::int64_t step : {0, 1, 3}) WriteStep(log, step);
  }
  EXPECT_EQ(ReadFromFront().steps, 2);
}

TEST(StepOrderTest, AStepBeginsOnlyWithTheEventOfItsNumber) {
  constexpr std::int64_t kFront = 2;
  constexpr auto kEvents = static_cast<std::int64_t>(log::kStepChannels);
  const std::vector<std::uint8_t> truth = Encoded<truth_t>(5);
  log::Event event{};
  event.channel = log::kStepNames.front();
  event.data = truth;
  for (std::int64_t number = 0; number < kFront + 10 * kEvents; ++number) {
    event.number = number;
    const auto begun = log::StepBegunBy(event, kFront, kEvents, kRunId);
    EXPECT_EQ(begun.has_value(), number == kFront + 5 * kEvents) << number;
  }
  event.number = kFront + 5 * kEvents;
  EXPECT_EQ(log::StepBegunBy(event, kFront, kEvents, kRunId), 5);
  EXPECT_FALSE(log::StepBegunBy(event, kFront, kEvents, kRunId + 1)) << "another run";
}

TEST_F(HistoryTest, ReadsOfALongLogOnlyItsEndAndWhatItIsAskedFor) {
  // GIVEN a log of a hundred gigabytes that has only its front and its last steps. The part between
  // them contains no event; a reader would need minutes for this part.
  constexpr std::int64_t kPeriod = 7;  // the period of the steps' sizes
  constexpr std::int64_t kSteps = 14'000'000 * kPeriod;
  Write(kPeriod);
  const log::LogFront front = log::ReadFront(file_);
  const std::int64_t period_bytes =
      static_cast<std::int64_t>(std::filesystem::file_size(file_)) - front.head.bytes;
  log::LogHead head{.bytes = front.head.bytes + kSteps / kPeriod * period_bytes,
                    .events = front.head.events};
  ASSERT_GT(head.bytes, 100'000'000'000);
  head.events += kSteps * static_cast<std::int64_t>(log::kStepChannels);
  std::filesystem::resize_file(file_, static_cast<std::uintmax_t>(front.head.bytes));
  {
    log::EventLogWriter log(file_, head);
    for (std::int64_t step = kSteps; step < kSteps + 500; ++step) WriteStep(log, step);
  }
  // WHEN a recorder continues this log, THEN the recorder finds the last step and the steps before
  // it
  const log::Remains remains = ReadFromEnd();
  EXPECT_EQ(remains.steps, kSteps + 500);
  EXPECT_EQ(remains.head.events, head.events + 500 * static_cast<std::int64_t>(log::kStepChannels));
  recorder::History history(file_, front, remains);
  for (std::int64_t step = kSteps + 499; step >= kSteps + 100; --step) ExpectStep(history, step);
}

TEST_F(HistoryTest, SaysThatItLivesWhileItReadsALogThatDoesNotEndAsItShould) {
  // GIVEN a log of 20 MB with foreign bytes after its steps, so that the reader must read the whole
  // log
  constexpr std::int64_t kSteps = 20'000;
  Write(kSteps);
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) + 2 * log::kTailBytes);
  // WHEN the log is read
  std::vector<std::int64_t> heard;
  const log::Remains remains = log::ReadRemains(
      file_, log::ReadFront(file_), [&heard](std::int64_t steps) { heard.push_back(steps); });
  // THEN the reader finds all steps, and has reported increasing numbers of steps meanwhile
  EXPECT_EQ(remains.steps, kSteps);
  ASSERT_GE(heard.size(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(heard));
  EXPECT_GT(heard.front(), 0);
  EXPECT_LT(heard.front(), heard.back());
  EXPECT_THAT(log::OddEnd(file_, log::ReadFront(file_), remains),
              testing::EndsWith(" " + std::to_string(2 * log::kTailBytes) +
                                " bytes do not continue step 19999"));
}

TEST_F(HistoryTest, HandsOutEveryStepInWhateverOrderItIsAskedFor) {
  constexpr std::int64_t kSteps = 2000;
  Write(kSteps + 1);  // the additional step is marked as the last step
  recorder::History history(file_, log::ReadFront(file_), ReadFromEnd());
  std::mt19937 random(7);
  for (int i = 0; i < 500; ++i) {
    ExpectStep(history, std::uniform_int_distribution<std::int64_t>(0, kSteps - 1)(random));
  }
  for (std::int64_t step = 0; step < kSteps; ++step) ExpectStep(history, step);
}

TEST_F(HistoryTest, NamesTheStepThatIsDamaged) {
  Write(1000);
  const log::LogFront front = log::ReadFront(file_);
  const log::Remains remains = ReadFromEnd();
  std::fstream(file_, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(remains.head.bytes / 2)
      .write(std::string(100'000, 'x').c_str(), 100'000);
  recorder::History history(file_, front, remains);
  EXPECT_THROW(ExpectStep(history, 505), std::runtime_error);
  ExpectStep(history, 10);
  ExpectStep(history, 990);
}

TEST_F(HistoryTest, TakesNoMoreMemoryTheLongerTheRunIs) {
  Write(1);
  recorder::History history(file_, log::ReadFront(file_), ReadFromEnd());
  constexpr std::int64_t kSteps = 20'000'000;
  const std::int64_t before = MeasureThisProcess().rss_bytes;
  for (std::int64_t step = 1; step < kSteps; ++step) history.Add(step * 3000);
  EXPECT_EQ(history.steps(), kSteps);
  // An index of all steps would take 160 MB: eight bytes for each step.
  EXPECT_LT(MeasureThisProcess().rss_bytes - before, 1 << 20);
}

}  // namespace
}  // namespace fogline
