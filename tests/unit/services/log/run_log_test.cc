// The tests read the run of a log in which messages are missing.
#include "services/log/run_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "common/errors.h"
#include "services/log/step_order.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/support/command.h"
#include "tests/support/copied_log.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline {
namespace {

using test::kSteps;
using testing::HasSubstr;

class RunLogTest : public testing::Test {
 protected:
  /// The run in a log that has these messages only.
  log::RunLog Read(const test::ShortLog& contents) const { return test::RunOf(file_, contents); }
  static log::RunLog ReadFile(const std::string& file) {
    log::RunLogReader reader(file);
    while (reader.Next() != nullptr) {
    }
    return reader.run();
  }
  static test::ShortLog InRealTime(bool (*has)(std::string_view channel, std::int64_t step)) {
    return {.realtime = true, .has = has};
  }

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
  EXPECT_EQ(run.note,
            "real time, 1 messages missing; published, but not in the log: at least 1 (TRUTH)");
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
  test::ShortLog contents = InRealTime([](std::string_view channel, std::int64_t step) {
    return !(channel == ChannelOf<radar_t>().name && step == 1);
  });
  const std::string missing = "real time, 1 messages missing";
  EXPECT_FALSE(Read(contents).complete);
  EXPECT_EQ(Read(contents).note, missing + "; perhaps published, but not in the log: RADAR");
  contents.radar_ticks = test::kSteps - 1;
  EXPECT_TRUE(Read(contents).complete);
  EXPECT_EQ(Read(contents).note, missing);
  contents.radar_ticks = test::kSteps;
  EXPECT_FALSE(Read(contents).complete);
  EXPECT_EQ(Read(contents).note, missing + "; published, but not in the log: at least 1 (RADAR)");
}

TEST_F(RunLogTest, InRealTimeIsIncompleteWithoutAnyStatusOfTheWorld) {
  const log::RunLog run = Read({.realtime = true, .status = false});
  EXPECT_TRUE(run.ended) << run.note;
  EXPECT_FALSE(run.complete);
  EXPECT_EQ(run.note, "real time, without STATUS of the world");
}

TEST_F(RunLogTest, InRealTimeIsIncompleteWithoutItsLastStep) {
  const log::RunLog run = Read(InRealTime(
      [](std::string_view /*channel*/, std::int64_t step) { return step < kSteps - 1; }));
  EXPECT_FALSE(run.ended);
  EXPECT_FALSE(run.complete);
  EXPECT_THAT(run.note, HasSubstr("ends after step 1 of 3"));
}

TEST_F(RunLogTest, InRealTimeSaysWithWhichStepItBegins) {
  const log::RunLog run =
      Read(InRealTime([](std::string_view /*channel*/, std::int64_t step) { return step > 0; }));
  EXPECT_EQ(run.note.substr(0, run.note.find(';')), "begins at step 1 of 3");
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

TEST_F(RunLogTest, InLockstepDoesNotEndAtAnIncompleteStepIfTheLogHasLaterStepsOrTheLast) {
  const auto note_without_radar = [&](std::int64_t step, std::int64_t end) {
    test::ShortLog contents;
    contents.has = [=](std::string_view channel, std::int64_t at) {
      return at < end && !(at == step && channel == ChannelOf<radar_t>().name);
    };
    return Read(contents).note;
  };
  EXPECT_EQ(note_without_radar(1, 3), "complete up to step 0 of 3; step 1 lacks RADAR");
  EXPECT_EQ(note_without_radar(2, 3), "complete up to step 1 of 3; step 2 lacks RADAR");
  EXPECT_EQ(note_without_radar(1, 2), "ends after step 0 of 3; step 1 lacks RADAR");
  EXPECT_EQ(note_without_radar(0, 3), "no step is read; step 0 lacks RADAR");
}

TEST_F(RunLogTest, IsIncompleteIfAStepHasTwoDifferentMessagesOfOneChannel) {
  test::WriteShortLog(file_);
  const std::string copy = folder_.File("copy");
  test::Copy(file_, copy, [](log::EventLogWriter& writer, const log::Event& event, auto& data) {
    if (event.channel != ChannelOf<radar_t>().name) return true;
    writer.Write(event.channel, event.utime, data);  // an equal message may come twice
    if (log::StepOf(event, test::kRunId) != 1) return true;
    std::vector<std::uint8_t> other = data;
    other.back() ^= 1;
    writer.Write(event.channel, event.utime, other);
    return true;
  });
  const log::RunLog run = ReadFile(copy);
  EXPECT_EQ(run.steps, kSteps);
  EXPECT_FALSE(run.complete);
  EXPECT_THAT(run.note, HasSubstr("step 1 has two different RADAR"));
}

TEST_F(RunLogTest, OfASignedRunHasNoMessageWithoutASignature) {
  test::WriteShortLog(file_);
  const std::string whole = folder_.File("signed");
  const std::string attacked = folder_.File("attacked");
  runtime::SigningKey::Secret secret{};
  secret.fill(1);
  runtime::MessageSigner signer(runtime::SigningKey(secret), std::nullopt);
  for (const std::string& copy : {whole, attacked}) {
    test::Copy(file_, copy, [&](log::EventLogWriter& writer, const log::Event& event, auto& data) {
      if (copy == attacked && event.channel == ChannelOf<radar_t>().name) {
        std::vector<std::uint8_t> forged = data;
        forged.back() ^= 1;
        writer.Write(event.channel, event.utime, forged);
      }
      const runtime::Bytes bytes = signer.Sign(event.channel, data);
      data.assign(bytes.begin(), bytes.end());
      return true;
    });
  }
  const log::RunLog expected = ReadFile(whole);
  EXPECT_TRUE(expected.complete) << expected.note;
  const log::RunLog run = ReadFile(attacked);
  EXPECT_EQ(run.digest, expected.digest);
  EXPECT_EQ(run.steps, kSteps);
  EXPECT_THAT(run.note, HasSubstr("3 messages of other runs ignored"));
}

/// Reads logs with gaps. `steps_` has the number of each step that was read, and how many messages
/// the step has.
class LogWithGapsTest : public testing::Test {
 protected:
  using Steps = std::vector<std::pair<std::int64_t, std::size_t>>;

  log::RunLog Read(const test::ShortLog& contents, log::ReadOptions options = {}) {
    test::WriteShortLog(file_, contents);
    return ReadFile(std::move(options));
  }
  log::RunLog ReadFile(log::ReadOptions options = {}) {
    options.gaps = true;
    log::RunLogReader reader(file_, options);
    steps_.clear();
    while (const log::StepMessages* messages = reader.Next()) {
      const auto there =
          std::ranges::count_if(*messages, [](runtime::Bytes message) { return !message.empty(); });
      steps_.emplace_back(reader.step(), static_cast<std::size_t>(there));
      tail_ += reader.InTail() ? 1 : 0;
    }
    return reader.run();
  }
  /// Replaces the log by a copy in which `edit` changes events (test::Copy()).
  template <class Edit>
  void Alter(const Edit& edit) {
    const std::string copy = folder_.File("copy");
    test::Copy(file_, copy, edit);
    std::filesystem::rename(copy, file_);
  }
  void RemoveScenario() {
    Alter([](auto&, const log::Event& event, auto& data) {
      if (event.channel == ChannelOf<run_t>().name) data.clear();
      return true;
    });
  }

  static constexpr std::size_t kAll = log::kStepChannels;
  test::ScratchFolder folder_;
  const std::string file_ = folder_.File("log");
  Steps steps_;
  int tail_ = 0;
};

TEST_F(LogWithGapsTest, GivesTheStepsAfterAMissingMessage) {
  const log::RunLog run = Read({.has = [](std::string_view channel, std::int64_t step) {
    return !(channel == ChannelOf<radar_t>().name && step == 1);
  }});
  EXPECT_EQ(steps_, (Steps{{0, kAll}, {1, kAll - 1}, {2, kAll}}));
  EXPECT_FALSE(run.complete);
  EXPECT_EQ(run.steps, 2);
  EXPECT_EQ(run.digest, "");
  EXPECT_EQ(run.gaps.messages[IndexOf<radar_t>()], 1);
  EXPECT_EQ(run.note, "1 message of 1 step is missing (RADAR 1), first: step 1 lacks RADAR");
}

TEST_F(LogWithGapsTest, GivesAnEmptyStepForAStepWithoutAMessage) {
  const log::RunLog run =
      Read({.has = [](std::string_view, std::int64_t step) { return step != 1; }});
  EXPECT_EQ(steps_, (Steps{{0, kAll}, {1, 0}, {2, kAll}}));
  EXPECT_EQ(run.gaps.Messages(), static_cast<std::int64_t>(kAll));
}

TEST_F(LogWithGapsTest, CountsAMessageThatTheLastStepLacksAsMissing) {
  const log::RunLog run = Read({.has = [](std::string_view channel, std::int64_t step) {
    return !(channel == ChannelOf<radar_t>().name && step == test::kSteps - 1);
  }});
  EXPECT_EQ(run.gaps.steps, 1);
  EXPECT_EQ(tail_, 0);
}

TEST_F(LogWithGapsTest, TakesTheIncompleteStepAtTheEndOfARunThatWasCutOffForNoGap) {
  const log::RunLog run = Read({.has = [](std::string_view channel, std::int64_t step) {
    return step == 0 || (step == 1 && channel == ChannelOf<truth_t>().name);
  }});
  EXPECT_EQ(steps_, (Steps{{0, kAll}, {1, 1}}));
  EXPECT_EQ(tail_, 1);
  EXPECT_FALSE(run.gaps.Any());
  EXPECT_NE(run.digest, "");
  EXPECT_THAT(run.note, HasSubstr("ends after step 0 of 3; step 1 lacks HOST_EGO, RADAR"));
}

TEST_F(LogWithGapsTest, HasNoTailIfItWasCutOffAfterAWholeStep) {
  const log::RunLog run = Read({.has = [](std::string_view channel, std::int64_t step) {
    return step < 2 && !(channel == ChannelOf<radar_t>().name && step == 0);
  }});
  EXPECT_EQ(steps_, (Steps{{0, kAll - 1}, {1, kAll}}));
  EXPECT_EQ(tail_, 0);
  EXPECT_FALSE(run.complete);
  EXPECT_EQ(run.note,
            "ends after step 1 of 3; 1 message of 1 step is missing (RADAR 1), first: step 0 lacks "
            "RADAR");
}

TEST_F(LogWithGapsTest, BeginsWithTheFirstStepOfALoggerThatCameLate) {
  const log::RunLog run =
      Read({.has = [](std::string_view, std::int64_t step) { return step > 0; }});
  EXPECT_EQ(steps_, (Steps{{1, kAll}, {2, kAll}}));
  EXPECT_EQ(run.gaps.first, 1);
  EXPECT_EQ(run.note, "begins at step 1 of 3");
}

TEST_F(LogWithGapsTest, OfACompleteLogHasTheDigestAndTheStepsOfTheUsualReader) {
  const log::RunLog run = Read({});
  log::RunLogReader usual(file_);
  while (usual.Next() != nullptr) {
  }
  EXPECT_TRUE(run.complete) << run.note;
  EXPECT_EQ(run.digest, usual.run().digest);
  EXPECT_EQ(run.steps, usual.run().steps);
}

TEST_F(LogWithGapsTest, IsReadWithoutAScenarioOnlyIfNoneIsNeeded) {
  Read({});
  RemoveScenario();
  try {
    ReadFile();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the log has no complete scenario of a run; --scenario"));
  }
  const log::RunLog run = ReadFile({.needs_scenario = false});
  EXPECT_EQ(steps_.size(), 3U);
  EXPECT_EQ(run.run_id, test::kRunId);
  EXPECT_FALSE(run.has_scenario);
  EXPECT_EQ(run.note, "the log has no scenario");
}

TEST_F(LogWithGapsTest, TakesTheGivenScenarioIfItsHashAgreesWithTheLog) {
  Read({});
  const log::RunLog same = ReadFile({.scenario_text = std::string(test::kScenario)});
  EXPECT_TRUE(same.complete) << same.note;
  const std::string other = R"({"version":1,"steps":4})";
  EXPECT_THROW(ReadFile({.scenario_text = other}), InputError);
  RemoveScenario();
  EXPECT_EQ(ReadFile({.scenario_text = other}).scenario.steps, 4);
}

TEST_F(LogWithGapsTest, OfSeveralRunsIsReadForTheFirstRunOrTheChosenOne) {
  Read({});
  const std::string both = folder_.File("both");
  constexpr std::int64_t kOther = test::kRunId + 1;
  {
    log::EventLogWriter writer(both);
    for (const bool second : {false, true}) {
      log::EventLogReader reader(file_);
      while (const auto event = reader.Next()) {
        std::vector<std::uint8_t> data(event->data.begin(), event->data.end());
        if (second) data[runtime::kRunIdOffset + 7] = kOther;
        writer.Write(event->channel, event->utime, data);
      }
    }
  }
  std::filesystem::rename(both, file_);
  const log::RunLog first = ReadFile();
  EXPECT_EQ(first.run_id, test::kRunId);
  ASSERT_EQ(first.other_runs.size(), 1U);
  EXPECT_EQ(first.other_runs.front().run_id, kOther);
  const log::RunLog chosen = ReadFile({.run_id = kOther});
  EXPECT_EQ(chosen.run_id, kOther);
  EXPECT_TRUE(chosen.complete) << chosen.note;
  EXPECT_EQ(chosen.digest, first.digest);
  try {
    ReadFile({.run_id = 99});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the log has no run 99; it has 7, 8"));
  }
}

TEST_F(LogWithGapsTest, DoesNotBeginWithAnImpossibleStep) {
  test::WriteShortLog(file_, {});
  Alter([](log::EventLogWriter& /*writer*/, const log::Event& event, auto& data) {
    if (event.channel != ChannelOf<run_t>().name) data[runtime::kStepOffset] = 1;
    return true;
  });
  const log::RunLog run = ReadFile();
  EXPECT_EQ(steps_.size(), 0U);
  EXPECT_THAT(run.note, HasSubstr("no step of 3 is complete; 3 impossible steps ignored"));
}

TEST_F(LogWithGapsTest, IsNotFilledUpToAnImpossibleStep) {
  test::WriteShortLog(file_, {});
  Alter([](log::EventLogWriter& writer, const log::Event& event, auto& data) {
    if (event.channel != ChannelOf<radar_t>().name) return true;
    std::vector<std::uint8_t> far = data;
    far[runtime::kStepOffset] = 1;  // step 2^56 and more
    writer.Write(event.channel, event.utime, far);
    return true;
  });
  const log::RunLog run = ReadFile();
  EXPECT_EQ(steps_.size(), 3U);
  EXPECT_THAT(run.note, HasSubstr("3 impossible steps ignored"));
}

}  // namespace
}  // namespace fogline
