// The recorder on a bus in memory: the requests that it answers, and how it continues a log.
#include "services/recorder/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "services/log/remains.h"
#include "services/log/step_order.h"
#include "tests/support/command.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline {
namespace {

using test::Script;
using testing::HasSubstr;

constexpr std::int64_t kSteps = 150;

std::string Content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class RecorderTest : public testing::Test {
 protected:
  /// Publishes the messages of all other roles in a step.
  static void SayStep(Script& script, std::int64_t step) {
    ForEachStepChannel([&]<class M>(std::size_t) {
      M message = Script::Of<M>(step);
      if constexpr (std::is_same_v<M, truth_t>) message.last = step == kSteps - 1;
      script.Say(message);
    });
  }
  /// Makes a recorder for a run. `progress` is the newest step that the world has begun.
  std::unique_ptr<recorder::Recorder> Record(Script& script, const std::string& name,
                                             recorder::Recorder::Existing existing,
                                             std::int64_t progress = -1) {
    auto recorder = std::make_unique<recorder::Recorder>(script.bus(), Script::kRunId,
                                                         folder_.File(name), existing);
    script.SayRun(run_t::GO, progress);
    return recorder;
  }
  /// Records the whole run, or the steps of the run that an existing log lacks.
  void RecordAll(const std::string& name, recorder::Recorder::Existing existing) {
    Script script;
    const auto recorder = Record(script, name, existing);
    EXPECT_EQ(ErrorOf(*recorder), "");
    for (std::int64_t step = 0; step < kSteps; ++step) SayStep(script, step);
    recorder->node().parts().own.Leave();
  }
  static const std::string& ErrorOf(recorder::Recorder& recorder) {
    return recorder.node().parts().own.message().error;
  }
  /// Lets the recorder answer all requests, a part of them in each turn.
  void AnswerAll(recorder::Recorder& recorder) {
    constexpr int kTurns = 100;
    for (int i = 0; i < kTurns; ++i) {
      recorder.node().Poll(Clock::now());
      script_.bus().Drain();
    }
  }
  /// Writes the scenario of the run into a log, as a recorder does.
  void WriteScenario(log::EventLogWriter& log) const {
    const std::vector<std::string> parts = runtime::SplitScenario(script_.text());
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      runtime::Encode(runtime::MakeRunPart(Script::kRunId, run_t::GO, 0,
                                           runtime::HashOf(script_.text()), parts, i),
                      bytes);
      log.Write(ChannelOf<run_t>().name, 0, bytes);
    }
  }
  /// Writes the steps from `first` to `end` - 1. All steps have the same size.
  static void WriteSteps(log::EventLogWriter& log, std::int64_t first, std::int64_t end) {
    std::vector<std::uint8_t> bytes;
    for (std::int64_t step = first; step < end; ++step) {
      ForEachStepChannel([&]<class M>(std::size_t channel) {
        runtime::Encode(Script::Of<M>(step), bytes);
        log.Write(kChannels[channel].name, step * 100'000, bytes);
      });
    }
  }
  /// Records the whole run. @return the bytes of its log
  std::string WholeLog() {
    RecordAll("whole", recorder::Recorder::Existing::kReplace);
    return Content(folder_.File("whole"));
  }

  const test::ScratchFolder folder_;
  Script script_;
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  std::vector<truth_t>& truths_ = script_.Listen<truth_t>();
};

TEST_F(RecorderTest, GoesOnWithALogThatIsCutAnywhereAndCompletesItByteByByte) {
  const std::string whole = WholeLog();
  ASSERT_GT(whole.size(), 100'000U);
  // The cuts are in the scenario, in the last part of the scenario, in the first step, and between
  // and within events and steps.
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{40}, std::size_t{3000}, std::size_t{8000}, std::size_t{20'000},
        whole.size() / 2, whole.size() / 2 + 1, whole.size() / 2 + 100, whole.size() - 1,
        whole.size()}) {
    std::ofstream(folder_.File("cut"), std::ios::binary)
        .write(whole.data(), static_cast<long>(size));
    RecordAll("cut", recorder::Recorder::Existing::kResume);
    EXPECT_TRUE(Content(folder_.File("cut")) == whole) << size << " bytes";
  }
}

TEST_F(RecorderTest, AnswersForWhatItsProducersMayHaveForgotten) {
  const auto recorder = Record(script_, "log", recorder::Recorder::Existing::kReplace);
  for (std::int64_t step = 0; step < 100; ++step) SayStep(script_, step);
  truths_.clear();
  script_.AskFor("TRUTH", 10, 63);
  AnswerAll(*recorder);
  // The request is for steps 10 to 72, and the run is at step 99. The recorder answers only for
  // steps that are at least kMaxAhead = 32 steps old, so step 67 is the last one.
  ASSERT_EQ(truths_.size(), 58U);
  for (std::size_t i = 0; i < truths_.size(); ++i) {
    EXPECT_EQ(truths_[i].header.step, static_cast<std::int64_t>(10 + i));
  }
  truths_.clear();
  script_.AskFor("TRUTH", 68, 10);
  script_.AskFor("TRUTH", 1000, 10);
  script_.AskFor("TRUTH", -5, 10);
  script_.AskFor("TRUTHS", 0, 10);
  AnswerAll(*recorder);
  EXPECT_TRUE(truths_.empty());
}

TEST_F(RecorderTest, AnswersAFloodOfRequestsWithABoundedNumberOfMessages) {
  const auto recorder = Record(script_, "log", recorder::Recorder::Existing::kReplace);
  for (std::int64_t step = 0; step < 100; ++step) SayStep(script_, step);
  truths_.clear();
  constexpr int kRequests = 500;
  const TimePoint began = Clock::now();
  for (int i = 0; i < kRequests; ++i) script_.AskFor("TRUTH", 0, 1'000'000'000);
  AnswerAll(*recorder);
  const std::chrono::duration<double> took = Clock::now() - began;
  // The requests are for 32,000 messages. The recorder sends a step again after 2 ms at the
  // earliest, so it sends each step at most 500 times in a second.
  EXPECT_GE(truths_.size(), static_cast<std::size_t>(runtime::kRingSteps));
  EXPECT_LE(static_cast<double>(truths_.size()), runtime::kRingSteps * (1 + 500 * took.count()));
}

TEST_F(RecorderTest, AnswersForWhatItsPredecessorHasWritten) {
  WholeLog();
  const auto recorder = Record(script_, "whole", recorder::Recorder::Existing::kResume, kSteps - 1);
  EXPECT_EQ(status_.back().header.step, kSteps - 1);
  truths_.clear();
  script_.AskFor("TRUTH", 0, 2);
  AnswerAll(*recorder);
  ASSERT_EQ(truths_.size(), 2U);
  EXPECT_EQ(truths_[1].header.step, 1);
}

TEST_F(RecorderTest, LeavesTheLogOfAnotherRunAlone) {
  const std::string whole = WholeLog();
  Script others;
  recorder::Recorder recorder(others.bus(), Script::kRunId + 1, folder_.File("whole"),
                              recorder::Recorder::Existing::kResume);
  const std::vector<std::string> parts = runtime::SplitScenario(others.text());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    others.Say(runtime::MakeRunPart(Script::kRunId + 1, run_t::GO, 0,
                                    runtime::HashOf(others.text()), parts, i));
  }
  EXPECT_THAT(ErrorOf(recorder), HasSubstr("whole: the log is of run 7, not of run 8"));
  EXPECT_TRUE(Content(folder_.File("whole")) == whole);
}

TEST_F(RecorderTest, LeavesTheLogOfAnotherScenarioAlone) {
  const std::string whole = WholeLog();
  Script others;
  recorder::Recorder recorder(others.bus(), Script::kRunId, folder_.File("whole"),
                              recorder::Recorder::Existing::kResume);
  Scenario scenario;
  scenario.seed += 1;
  const std::string text = PrintScenario(scenario);
  const std::vector<std::string> parts = runtime::SplitScenario(text);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    others.Say(runtime::MakeRunPart(Script::kRunId, run_t::GO, 0, runtime::HashOf(text), parts, i));
  }
  EXPECT_THAT(ErrorOf(recorder), HasSubstr("whole: the log is of another scenario"));
  EXPECT_TRUE(Content(folder_.File("whole")) == whole);
}

TEST_F(RecorderTest, LeavesAFileThatIsNoLogAlone) {
  std::ofstream(folder_.File("text")) << "hello, world";
  const auto recorder = Record(script_, "text", recorder::Recorder::Existing::kResume);
  EXPECT_THAT(ErrorOf(*recorder), HasSubstr("not an LCM event log"));
  EXPECT_EQ(Content(folder_.File("text")), "hello, world");
}

TEST_F(RecorderTest, SaysWhenStepsAreGoneThatItHadAcknowledged) {
  WholeLog();
  // The world begins a step only if the step kMaxAhead = 32 before it is on disk. The world has
  // begun step 400, so step 368 must be on disk.
  const auto recorder = Record(script_, "whole", recorder::Recorder::Existing::kResume, 400);
  EXPECT_THAT(ErrorOf(*recorder),
              HasSubstr("the log has 150 steps, but the recorder had written 369"));
}

TEST_F(RecorderTest, SaysThatItLivesWhileItReadsALogFromFrontToBack) {
  // GIVEN a log of 30 MB with zeros at its end, so that the recorder must read the whole log
  constexpr std::int64_t kMany = 20'000;
  const std::string file = folder_.File("long");
  {
    log::EventLogWriter log(file);
    WriteScenario(log);
    WriteSteps(log, 0, kMany);
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) + 2 * log::kTailBytes);
  // WHEN a recorder continues this log
  const auto recorder = Record(script_, "long", recorder::Recorder::Existing::kResume);
  EXPECT_EQ(ErrorOf(*recorder), "");
  // THEN the recorder has reported its progress while it read, and then that it is ready
  std::vector<std::int64_t> steps;
  for (const status_t& status : status_) {
    if (status.state == status_t::WAITING) steps.push_back(status.header.step);
  }
  ASSERT_GE(steps.size(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(steps));
  EXPECT_GT(steps.front(), 0);
  EXPECT_EQ(status_.back().state, status_t::READY);
  EXPECT_EQ(status_.back().header.step, kMany - 1);
}

/// The bytes that this process has read so far: by calls, and through mapped files.
std::int64_t BytesRead() {
  std::ifstream io("/proc/self/io");
  std::string name;
  std::int64_t by_calls = 0;
  io >> name >> by_calls;
  EXPECT_EQ(name, "rchar:");
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return by_calls + (use.ru_minflt + use.ru_majflt) * sysconf(_SC_PAGESIZE);
}

TEST_F(RecorderTest, ReadsOfALongLogOnlyItsEndWhenItGoesOn) {
  // GIVEN a log of a hundred gigabytes that has only its front and its last steps
  constexpr std::int64_t kLongLog = 100'000'000'000;
  constexpr std::int64_t kLastSteps = 2000;  // more than the end that a recorder reads
  const std::string file = folder_.File("long");
  {
    log::EventLogWriter log(file);
    WriteScenario(log);
    WriteSteps(log, 0, 1);
  }
  const log::LogFront front = log::ReadFront(file);
  const std::int64_t step_bytes =
      static_cast<std::int64_t>(std::filesystem::file_size(file)) - front.head.bytes;
  const std::int64_t steps = kLongLog / step_bytes;
  std::filesystem::resize_file(file,
                               static_cast<std::uintmax_t>(front.head.bytes + steps * step_bytes));
  {
    log::EventLogWriter log(
        file,
        {.bytes = front.head.bytes + steps * step_bytes,
         .events = front.head.events + steps * static_cast<std::int64_t>(log::kStepChannels)});
    WriteSteps(log, steps, steps + kLastSteps);
  }
  // WHEN a recorder continues this log
  const std::int64_t before = BytesRead();
  const auto recorder = Record(script_, "long", recorder::Recorder::Existing::kResume);
  // THEN the recorder is ready at the last step, with a checksum of the end of the log
  EXPECT_EQ(ErrorOf(*recorder), "");
  EXPECT_EQ(status_.back().state, status_t::READY);
  EXPECT_EQ(status_.back().header.step, steps + kLastSteps - 1);
  EXPECT_EQ(status_.back().log_bytes, static_cast<std::int64_t>(std::filesystem::file_size(file)));
  // AND the recorder has read only some megabytes: at most twice the end of the log, and the pages
  // of the process itself
  EXPECT_LT(BytesRead() - before, 64 << 20);
}

TEST_F(RecorderTest, RefusesAnOutputThatIsNotTheOneInItsLog) {
  WholeLog();
  const auto recorder = Record(script_, "whole", recorder::Recorder::Existing::kResume, kSteps - 1);
  SayStep(script_, kSteps - 2);
  EXPECT_EQ(ErrorOf(*recorder), "");
  auto command = Script::Of<driver_command_t>(kSteps - 2);
  command.acceleration_mps2 = 1;
  script_.Say(command);
  EXPECT_EQ(
      ErrorOf(*recorder),
      "step 148: DRIVER_COMMAND differs from the log: driver is not the program or version that "
      "was recorded");
}

TEST_F(RecorderTest, SaysOnceThatTheDiskIsFull) {
  recorder::Recorder recorder(script_.bus(), Script::kRunId, "/dev/full");
  script_.SayRun(run_t::GO, -1);
  EXPECT_THAT(ErrorOf(recorder), HasSubstr("cannot write to /dev/full: No space left on device"));
  EXPECT_EQ(status_.back().state, status_t::FAILED);
}

/// CRC-32 of the first `bytes` bytes of a text.
std::int64_t ChecksumOf(const std::string& text, std::int64_t bytes) {
  return static_cast<std::int64_t>(crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()),
                                           static_cast<std::size_t>(bytes)));
}

TEST_F(RecorderTest, TellsInStatusWhatItHasWritten) {
  const auto recorder = Record(script_, "log", recorder::Recorder::Existing::kReplace);
  for (std::int64_t step = 0; step < 100; ++step) SayStep(script_, step);
  const status_t acknowledged = status_.back();
  EXPECT_EQ(acknowledged.header.step, 95);
  const std::string content = Content(folder_.File("log"));
  EXPECT_EQ(acknowledged.log_bytes, std::ssize(content)) << "no step behind it is on disk";
  EXPECT_EQ(acknowledged.log_checksum, ChecksumOf(content, acknowledged.log_bytes));
  const std::filesystem::path file = folder_.File("log");
  EXPECT_EQ(log::ReadRemains(file, log::ReadFront(file)).steps, acknowledged.header.step + 1);
  // WHEN the recorder leaves during an incomplete step, THEN its last STATUS counts the bytes of
  // this step, too
  truth_t truth = Script::Of<truth_t>(100);
  script_.Say(truth);
  recorder->node().parts().own.Leave();
  script_.bus().Drain();
  const std::string whole = Content(folder_.File("log"));
  EXPECT_GT(whole.size(), content.size());
  EXPECT_EQ(status_.back().log_bytes, std::ssize(whole));
  EXPECT_EQ(status_.back().log_checksum, ChecksumOf(whole, std::ssize(whole)));
}

TEST_F(RecorderTest, TellsOfALogThatItGoesOnWithWhatItHasFound) {
  const std::string whole = WholeLog();
  const auto recorder = Record(script_, "whole", recorder::Recorder::Existing::kResume, kSteps - 1);
  EXPECT_EQ(status_.back().log_bytes, std::ssize(whole));
  EXPECT_EQ(status_.back().log_checksum, ChecksumOf(whole, std::ssize(whole)));
}

}  // namespace
}  // namespace fogline
