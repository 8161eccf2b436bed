// The seal of a log: the changes that the seal reveals, and the changes that it cannot reveal.
#include "services/log/log_seal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "common/errors.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/digest.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tests/support/command.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline {
namespace {

using test::Content;
using test::kRunId;
using test::kScenario;
using test::kStep_us;
using test::kSteps;
using test::WriteShortLog;
using testing::HasSubstr;

void Write(const std::string& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/// The result of reading a log.
struct Reading {
  bool readable = true;
  log::RunLog run;
};

Reading Read(const std::string& file,
             log::RunLogReader::Compared compared = log::RunLogReader::Compared::kFile) {
  Reading reading;
  try {
    log::RunLogReader reader(file, compared);
    while (reader.Next() != nullptr) {
    }
    reading.run = reader.run();
  } catch (const InputError&) {
    reading.readable = false;
  }
  return reading;
}

class LogSealTest : public testing::Test {
 protected:
  log_seal_t SealOfLog() const {
    const log::RunLog run = Read(log_).run;
    log_seal_t seal{};
    seal.header = {.run_id = kRunId, .step = kSteps - 1, .utime = (kSteps - 1) * kStep_us};
    seal.digest = run.digest;
    seal.steps = run.steps;
    seal.complete = run.complete;
    seal.scenario_hash = run.scenario_hash;
    seal.file_hash =
        runtime::HashOf(Content(log_).substr(0, static_cast<std::size_t>(head_.bytes)));
    seal.num_roles = 1;
    seal.role = {"world"};
    seal.build_id = {4711};
    return seal;
  }
  void SealIt(const runtime::SigningKey* key = nullptr) const {
    log::SealLog(log_, head_, SealOfLog(), key);
  }

  test::ScratchFolder folder_;
  const std::string log_ = folder_.File("log");
  const log::LogHead head_ = WriteShortLog(log_);
};

TEST_F(LogSealTest, HoldsForTheLogThatWasSealedAndChangesNoDigest) {
  const std::string before = Read(log_).run.digest;
  EXPECT_FALSE(Read(log_).run.seal);
  SealIt();
  const log::RunLog run = Read(log_).run;
  ASSERT_TRUE(run.seal);
  EXPECT_TRUE(run.seal->whole);
  EXPECT_TRUE(run.complete);
  EXPECT_FALSE(run.altered) << run.note;
  EXPECT_EQ(run.note, "");
  EXPECT_EQ(run.digest, before);
  EXPECT_EQ(run.seal->says.build_id, std::vector<std::int64_t>{4711});
}

TEST_F(LogSealTest, ShowsABitThatIsFlippedInAnyByteOfTheFile) {
  SealIt();
  const std::string sealed = Content(log_);
  // Flips one bit of one byte at a time. The position of this bit differs from byte to byte.
  for (std::size_t at = 0; at < sealed.size(); ++at) {
    std::string altered = sealed;
    altered[at] = static_cast<char>(altered[at] ^ (1 << (at % 8)));
    Write(folder_.File("altered"), altered);
    const Reading reading = Read(folder_.File("altered"));
    EXPECT_FALSE(reading.readable && reading.run.complete)
        << "byte " << at << " of " << sealed.size();
  }
}

TEST_F(LogSealTest, ShowsStepsThatWereChangedToAReaderOfTheRunAlone) {
  SealIt();
  std::string altered = Content(log_);
  const std::size_t radar = altered.find("RADAR");
  altered[radar + 5 + runtime::kHeaderEnd + 8] ^= 1;
  Write(log_, altered);
  const log::RunLog run = Read(log_, log::RunLogReader::Compared::kRun).run;
  EXPECT_TRUE(run.altered);
  EXPECT_FALSE(run.complete);
  EXPECT_THAT(run.note, HasSubstr("altered: the seal names digest "));
}

TEST_F(LogSealTest, ThatDoesNotFitLeavesTheLogAsItWas) {
  const std::string before = Content(log_);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit shorter{.rlim_cur = before.size() + 20, .rlim_max = limit.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &shorter), 0);
  std::string error;
  try {
    SealIt();
  } catch (const std::runtime_error& thrown) {
    error = thrown.what();
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(error, HasSubstr("cannot append FOGLINE_SEAL to " + log_ + ": "));
  EXPECT_THAT(error, HasSubstr("the log is as before"));
  EXPECT_EQ(Content(log_), before);
}

TEST_F(LogSealTest, ShowsWhatWasAddedBehindIt) {
  SealIt();
  std::ofstream(log_, std::ios::app | std::ios::binary) << Content(log_).substr(0, 200);
  EXPECT_TRUE(Read(log_).run.altered);
}

TEST_F(LogSealTest, HoldsInACopyWithOtherEventTimes) {
  SealIt();
  // GIVEN a copy of the log that lcm-logger records while lcm-logplayer plays the log
  const std::string copy = folder_.File("copy");
  {
    log::EventLogReader reader(log_);
    log::EventLogWriter writer(copy);
    std::int64_t now_us = 1'700'000'000'000'000;
    while (const auto event = reader.Next()) {
      writer.Write(event->channel, ++now_us, event->data);
    }
  }
  const log::RunLog run = Read(copy).run;
  ASSERT_TRUE(run.seal);
  EXPECT_TRUE(run.seal->copied);
  EXPECT_TRUE(run.complete) << run.note;
  EXPECT_EQ(run.note, "");
}

TEST_F(LogSealTest, OfAnotherRunSaysNothingOfThisOne) {
  SealIt();
  log_seal_t others = SealOfLog();
  others.header.run_id = kRunId + 1;
  others.digest = runtime::HashOf("another run");
  Write(folder_.File("others"), "");
  log::SealLog(folder_.File("others"), {}, others, nullptr);
  // GIVEN a log of lcm-logger that contains the seal of its run and the seal of another run
  const std::string copy = folder_.File("copy");
  {
    log::EventLogReader others_reader(folder_.File("others"));
    log::EventLogReader reader(log_);
    log::EventLogWriter writer(copy);
    constexpr std::int64_t kNow_us = 1'700'000'000'000'000;
    while (const auto event = reader.Next()) {
      if (log::IsLogSeal(*event))
        writer.Write(log::kLogSealChannel, kNow_us, others_reader.Next()->data);
      writer.Write(event->channel, kNow_us, event->data);
    }
  }
  const log::RunLog run = Read(copy).run;
  EXPECT_TRUE(run.complete);
  EXPECT_EQ(run.note, "1 messages of other runs ignored");
}

TEST_F(LogSealTest, IsSignedWithAKeyAndWithNoOther) {
  runtime::SigningKey::Create(folder_.File("key"));
  runtime::SigningKey::Create(folder_.File("other"));
  const runtime::SigningKey key = runtime::SigningKey::Load(folder_.File("key"));
  SealIt(&key);
  const log::RunLog run = Read(log_).run;
  ASSERT_TRUE(run.seal && run.seal->whole);
  EXPECT_FALSE(run.altered) << run.note;
  EXPECT_EQ(log::VerifySeal(*run.seal, key), log::SealSignature::kHolds);
  EXPECT_EQ(log::VerifySeal(*run.seal, runtime::SigningKey::Load(folder_.File("other"))),
            log::SealSignature::kWrong);
}

TEST_F(LogSealTest, MadeWithoutTheKeyIsNotSigned) {
  runtime::SigningKey::Create(folder_.File("key"));
  const runtime::SigningKey key = runtime::SigningKey::Load(folder_.File("key"));
  SealIt();
  EXPECT_EQ(log::VerifySeal(*Read(log_).run.seal, key), log::SealSignature::kNone);
}

TEST(WhyNotWrittenTest, SaysWhenTheBytesAreNotWhatWasTold) {
  const test::ScratchFolder folder;
  log::WrittenLog first;
  log::WrittenLog last;
  {
    log::EventLogWriter writer(folder.File("log"));
    writer.Write("FIRST", 0, std::vector<std::uint8_t>(100, 1));
    writer.Flush();
    first = writer.written();
    writer.Write("SECOND", 0, std::vector<std::uint8_t>(100, 2));
    writer.Flush();
    last = writer.written();
  }
  std::string content = Content(folder.File("log"));
  const auto why = [&](const std::vector<log::WrittenLog>& written) {
    std::ofstream(folder.File("log"), std::ios::binary) << content;
    return log::WhyNotWritten(log::EventLogReader(folder.File("log")), written);
  };
  EXPECT_EQ(why({}), "");
  EXPECT_EQ(why({first, last}), "");
  EXPECT_EQ(why({last, first}), "") << "in any order";
  // A change in the bytes that the report `first` covers.
  content[50] ^= 1;
  EXPECT_THAT(why({first}),
              HasSubstr("the log on disk is not what the recorder wrote: it wrote 133 bytes"));
  // A change after these bytes, which only the report `last` covers.
  content[50] ^= 1;
  content[200] ^= 1;
  EXPECT_EQ(why({first}), "");
  EXPECT_THAT(why({first, last}), HasSubstr("267 bytes with checksum "));
  // A file that is shorter than reported.
  content.resize(200);
  EXPECT_THAT(why({first, last}), HasSubstr(", on disk are 200 with "));
}

}  // namespace
}  // namespace fogline
