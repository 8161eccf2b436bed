#include "tools/runner/log_sealer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/runtime/wire/wire.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

using runner::LoggedRoles;
using runner::LogSealer;
using testing::HasSubstr;

constexpr std::int64_t kSteps = 20;

/// A log of a run without a seal, as the run's recorder leaves it.
class LogSealerTest : public testing::Test {
 protected:
  LogSealerTest() {
    const std::string sealed = folder_.File("sealed.lcm");
    runner::RunScenario(Paper(kSteps), Direct(sealed));
    log::EventLogReader reader(sealed);
    log::EventLogWriter writer(log_);
    while (const auto event = reader.Next()) {
      if (log::IsLogSeal(*event)) continue;
      writer.Write(event->channel, event->utime, event->data);
    }
    writer.Flush();
    written_ = {writer.written()};
    roles_.builds.fill(4711);
  }

  void Append(const std::string& bytes) const {
    std::ofstream(log_, std::ios::app | std::ios::binary) << bytes;
  }
  /// The error text of Check(); "" if there is no error.
  std::string Trouble(const LogSealer& sealer) const {
    try {
      sealer.Check(written_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  std::vector<log::WrittenLog> written_;
  LoggedRoles roles_;
};

TEST_F(LogSealerTest, FindsTheBytesThatTheRecorderHasReported) {
  const LogSealer sealer(log_);
  EXPECT_EQ(Trouble(sealer), "");
  EXPECT_TRUE(sealer.HasAllTold(written_));
  EXPECT_FALSE(sealer.HasAllTold({})) << "no recorder has reported anything";
  Append("x");
  EXPECT_FALSE(sealer.HasAllTold(written_));
}

TEST_F(LogSealerTest, FindsAChangedByte) {
  const LogSealer sealer(log_);
  std::fstream file(log_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(log_)) - 1);
  file.put('\x7f');
  file.close();
  EXPECT_THAT(Trouble(sealer), HasSubstr(log_ + ": "));
}

TEST_F(LogSealerTest, FindsAnotherFileInThePlaceOfTheLog) {
  const LogSealer sealer(log_);
  std::filesystem::copy_file(log_, folder_.File("copy"));
  std::filesystem::rename(folder_.File("copy"), log_);
  EXPECT_THAT(Trouble(sealer), HasSubstr("it was replaced meanwhile"));
  std::filesystem::remove(log_);
  EXPECT_THAT(Trouble(LogSealer(log_)), HasSubstr("the log was removed during the run"));
}

TEST_F(LogSealerTest, SealsAWholeRun) {
  const LogSealer sealer(log_);
  const log::RunLog run = ReadToTheEnd(log_);
  const runtime::SigningKey key({1, 2, 3});
  sealer.Seal(run, written_, roles_, &key);
  const log::RunLog sealed = ReadToTheEnd(log_);
  ASSERT_TRUE(sealed.seal && sealed.seal->whole);
  EXPECT_TRUE(sealed.complete);
  EXPECT_FALSE(sealed.altered);
  const log_seal_t& says = sealed.seal->says;
  EXPECT_EQ(says.digest, run.digest);
  EXPECT_EQ(says.steps, kSteps);
  EXPECT_EQ(says.header.step, kSteps - 1);
  EXPECT_TRUE(says.complete);
  EXPECT_EQ(says.build_id, std::vector<std::int64_t>(kRoles.size(), 4711));
  EXPECT_EQ(log::WhyNotSealedFile(*sealed.seal, log::EventLogReader(log_)), "");
  EXPECT_EQ(log::VerifySeal(*sealed.seal, key), log::SealSignature::kHolds);
  EXPECT_EQ(log::VerifySeal(*sealed.seal, runtime::SigningKey({4, 5})), log::SealSignature::kWrong);
}

TEST_F(LogSealerTest, WritesThePriorityOfARunInRealTimeUnderTheSeal) {
  roles_.priority = {.granted = {"world", "radar"}, .refused = {"lidar"}, .unknown = {"acc"}};
  log::RunLog run = ReadToTheEnd(log_);
  run.realtime.emplace();
  LogSealer(log_).Seal(run, written_, roles_, nullptr);
  log::EventLogReader reader(log_);
  std::optional<log::RealtimePriority> found;
  std::string last;
  while (const auto event = reader.Next()) {
    last = event->channel;
    if (event->channel == log::kLogPriorityChannel) found = log::ReadPriority(*event, run.run_id);
  }
  ASSERT_TRUE(found);
  EXPECT_EQ(found->granted, roles_.priority->granted);
  EXPECT_EQ(found->refused, roles_.priority->refused);
  EXPECT_EQ(found->unknown, roles_.priority->unknown);
  EXPECT_EQ(last, log::kLogSealChannel);
  const log::RunLog sealed = ReadToTheEnd(log_);
  EXPECT_TRUE(sealed.complete);
  EXPECT_EQ(sealed.digest, run.digest);
  EXPECT_EQ(log::WhyNotSealedFile(*sealed.seal, log::EventLogReader(log_)), "");
}

TEST_F(LogSealerTest, SealsNoLogThatWasChanged) {
  const LogSealer sealer(log_);
  const log::RunLog run = ReadToTheEnd(log_);
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) - 1);
  const std::string before = Content(log_);
  EXPECT_THROW(sealer.Seal(run, written_, roles_, nullptr), std::runtime_error);
  EXPECT_TRUE(Content(log_) == before);
}

TEST_F(LogSealerTest, SealsARunThatEndedEarlyAsFarAsItGoes) {
  // GIVEN a log without its last step
  const std::string part = folder_.File("part.lcm");
  log::EventLogReader reader(log_);
  log::EventLogWriter writer(part);
  while (const auto event = reader.Next()) {
    if (runtime::ReadInt64(event->data, runtime::kStepOffset) == kSteps - 1) break;
    writer.Write(event->channel, event->utime, event->data);
  }
  writer.Flush();
  LogSealer(part).SealCutOff({writer.written()}, roles_, nullptr);
  const log::RunLog sealed = ReadToTheEnd(part);
  ASSERT_TRUE(sealed.seal && sealed.seal->whole);
  EXPECT_EQ(sealed.seal->says.steps, kSteps - 1);
  EXPECT_FALSE(sealed.seal->says.complete);
}

TEST_F(LogSealerTest, LeavesALogAsItIsIfItHasMoreThanWasReported) {
  const log::LogHead head = ReadToTheEnd(log_).events;
  {
    log::EventLogWriter writer(log_, head);
    writer.Write("TRUTH", 0, std::vector<std::uint8_t>{1, 2, 3});
  }
  const std::string before = Content(log_);
  LogSealer(log_).SealCutOff(written_, roles_, nullptr);
  EXPECT_TRUE(Content(log_) == before);
}

TEST_F(LogSealerTest, MakesNoLogWhereThereIsNone) {
  std::filesystem::remove(log_);
  LogSealer(log_).SealCutOff(written_, roles_, nullptr);
  EXPECT_FALSE(std::filesystem::exists(log_));
}

}  // namespace
}  // namespace fogline::test
