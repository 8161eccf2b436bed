#include "tools/web/log/log_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/support/copied_log.h"
#include "tests/support/input_errors.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::web {
namespace {

using test::Direct;
using test::Paper;
using testing::HasSubstr;

class LogIndexTest : public testing::Test {
 protected:
  /// Runs the beginning of the paper's scenario in this process. @return its log
  std::string Run(std::int64_t steps, std::vector<std::string> overrides = {}) {
    const std::string file = folder_.File("run.lcm");
    runner::RunScenario(Paper(steps, std::move(overrides)), Direct(file));
    return file;
  }
  std::string File(const std::string& name) const { return folder_.File(name); }

  /// Expects that the index has each message that RunLogReader finds. @return the number of steps
  /// that RunLogReader finds
  static std::int64_t CompareAll(const std::string& file, const LogIndex& index) {
    log::RunLogReader reader(file);
    std::int64_t step = 0;
    for (; const log::StepMessages* messages = reader.Next(); ++step) {
      for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
        EXPECT_TRUE(std::ranges::equal(index.Message(step, channel), (*messages)[channel]))
            << "step " << step << ", " << kChannels[channel].name;
      }
    }
    return step;
  }

 private:
  test::ScratchFolder folder_;
};

TEST_F(LogIndexTest, HasTheMessagesThatRunLogReaderReads) {
  const std::string file = Run(120);
  const LogIndex index(file);
  EXPECT_EQ(CompareAll(file, index), 120);
  EXPECT_EQ(index.first_step(), 0);
  EXPECT_EQ(index.last_step(), 119);
  EXPECT_EQ(index.messages(), 120 * static_cast<std::int64_t>(log::kStepChannels));
  EXPECT_EQ(index.run().digest, test::ReadToTheEnd(file).digest);
  EXPECT_TRUE(index.run().complete);
}

TEST_F(LogIndexTest, HasTheMessagesThatBelongToNoStep) {
  const std::string file = Run(10);
  const LogIndex index(file);
  std::int64_t runs = 0;
  log::EventLogReader reader(file);
  while (const auto event = reader.Next()) {
    if (event->channel != ChannelOf<run_t>().name) continue;
    ASSERT_LT(runs, index.control_messages(IndexOf<run_t>()));
    EXPECT_TRUE(std::ranges::equal(index.ControlMessage(IndexOf<run_t>(), runs++), event->data));
  }
  EXPECT_GT(runs, 0);
  EXPECT_EQ(index.control_messages(IndexOf<run_t>()), runs);
  EXPECT_EQ(index.control_messages(IndexOf<truth_t>()), 0);
}

TEST_F(LogIndexTest, HasNothingOutsideOfTheRun) {
  const LogIndex index(Run(10));
  EXPECT_TRUE(index.Message(-1, IndexOf<truth_t>()).empty());
  EXPECT_TRUE(index.Message(10, IndexOf<truth_t>()).empty());
  EXPECT_TRUE(index.Message(0, IndexOf<run_t>()).empty());
  EXPECT_TRUE(index.Message(0, IndexOf<status_t>()).empty());
}

TEST_F(LogIndexTest, ShowsATornLogAsFarAsItGoes) {
  const std::string file = Run(50);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const LogIndex index(file);
  const std::int64_t steps = CompareAll(file, index);
  EXPECT_GT(steps, 10);
  // The file ends within a step. The index also has the messages of this step.
  EXPECT_GE(index.last_step(), steps - 1);
  EXPECT_LE(index.last_step(), steps);
  EXPECT_FALSE(index.run().complete);
  EXPECT_THAT(index.run().note, HasSubstr("ends after step"));
}

TEST_F(LogIndexTest, ShowsTheStepsBehindALostMessage) {
  const std::string file = Run(30);
  test::Copy(
      file, File("lossy.lcm"),
      [](log::EventLogWriter& writer, const log::Event& event, std::vector<std::uint8_t>& data) {
        const bool lost =
            event.channel == "LIDAR" && runtime::ReadInt64(data, runtime::kStepOffset) == 10;
        // An event of an unknown channel takes the place of the lost event.
        if (lost) writer.Write("OTHER", event.utime, data);
        if (lost) data.assign(4, 0);
        return true;
      });
  const LogIndex index(File("lossy.lcm"));
  EXPECT_EQ(index.run().steps, 10);
  EXPECT_EQ(index.last_step(), 29);
  EXPECT_TRUE(index.Message(10, IndexOf<lidar_t>()).empty());
  EXPECT_FALSE(index.Message(10, IndexOf<radar_t>()).empty());
  EXPECT_FALSE(index.Message(29, IndexOf<lidar_t>()).empty());
}

TEST_F(LogIndexTest, TakesTheFirstOfTwoMessages) {
  const std::string file = Run(5);
  test::Copy(
      file, File("twice.lcm"),
      [](log::EventLogWriter& writer, const log::Event& event, std::vector<std::uint8_t>& data) {
        writer.Write(event.channel, event.utime, data);
        if (event.channel == "TRUTH") data.back() ^= 1;
        return true;
      });
  const LogIndex index(File("twice.lcm"));
  const LogIndex original(file);
  EXPECT_TRUE(std::ranges::equal(index.Message(3, IndexOf<truth_t>()),
                                 original.Message(3, IndexOf<truth_t>())));
  EXPECT_EQ(index.messages(), original.messages());
}

TEST_F(LogIndexTest, NeedsNoMemoryForAForgedStep) {
  // GIVEN a log with messages of a very late step and of a negative one
  const std::string file = Run(5);
  test::Copy(
      file, File("forged.lcm"),
      [](log::EventLogWriter& writer, const log::Event& event, std::vector<std::uint8_t>& data) {
        std::vector<std::uint8_t> forged = data;
        for (const int late : {0x7f, 0x80}) {  // also a negative step
          if (event.channel != "TRUTH") break;
          forged[runtime::kStepOffset] = static_cast<std::uint8_t>(late);
          writer.Write(event.channel, event.utime, forged);
        }
        return true;
      });
  EXPECT_EQ(LogIndex(File("forged.lcm")).last_step(), 4);
}

TEST_F(LogIndexTest, FindsTheEventsOfThePaper) {
  const LogIndex index(Run(320));
  std::vector<std::pair<std::int64_t, std::string>> found;
  for (const RunEvent& event : index.events()) {
    if (event.kind != "alarm") found.emplace_back(event.step, std::string(event.kind));
    EXPECT_DOUBLE_EQ(event.time_s, 0.1 * static_cast<double>(event.step));
  }
  // `fogline events` reports transfers at the same steps, 203 and 297. The fog of the scenario
  // begins at step 190.
  using Pair = std::pair<std::int64_t, std::string>;
  EXPECT_THAT(found, testing::Contains(Pair(190, "fog")));
  EXPECT_THAT(found, testing::Contains(Pair(203, "transfer")));
  EXPECT_THAT(found, testing::Contains(Pair(297, "transfer")));
  const auto alarm = std::ranges::find(index.events(), "alarm", &RunEvent::kind);
  ASSERT_NE(alarm, index.events().end());
  EXPECT_THAT(alarm->text, HasSubstr("reaches the threshold 0.50"));
}

TEST_F(LogIndexTest, RefusesWhatIsNoLogOfARun) {
  EXPECT_THAT(test::ErrorOf([&] { LogIndex{File("missing.lcm")}; }), HasSubstr("cannot read"));
  { log::EventLogWriter empty(File("empty.lcm")); }
  EXPECT_THAT(test::ErrorOf([&] { LogIndex{File("empty.lcm")}; }), HasSubstr("is empty"));
  {
    log::EventLogWriter other(File("other.lcm"));
    other.Write("CAMERA", 0, std::vector<std::uint8_t>(100));
  }
  EXPECT_THAT(test::ErrorOf([&] { LogIndex{File("other.lcm")}; }), HasSubstr("scenario"));
}

}  // namespace
}  // namespace fogline::web
