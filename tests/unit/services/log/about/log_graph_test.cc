// A log names the channels of its steps (log_graph_t). A step of the log is complete if it has a
// message of each of these channels.
#include "services/log/about/log_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/log/remains.h"
#include "services/log/run_log.h"
#include "tests/support/command.h"
#include "tests/support/input_errors.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline {
namespace {

using testing::HasSubstr;

constexpr std::string_view kFollowers = ChannelOf<follower_command_t>().name;

bool IsOfNoFollower(std::string_view channel, std::int64_t /*step*/) {
  return channel != kFollowers;
}

/// The graph of a program without the channel of the following cars.
log_graph_t WithoutFollowers() {
  log_graph_t graph{};
  graph.header = {.run_id = test::kRunId, .step = -1, .utime = 0};
  ForEachStepChannel([&graph]<class M>(std::size_t channel) {
    if (kChannels[channel].name == kFollowers) return;
    graph.channel.emplace_back(kChannels[channel].name);
    graph.type.emplace_back(M::getTypeName());
    graph.type_hash.push_back(M::getHash());
    graph.producer.emplace_back(NameOf(kChannels[channel].from));
  });
  graph.num_channels = static_cast<std::int32_t>(graph.channel.size());
  return graph;
}

class LogGraphTest : public testing::Test {
 protected:
  log::RunLog Read(const test::ShortLog& contents) const { return test::RunOf(file_, contents); }

  test::ScratchFolder folder_;
  const std::string file_ = folder_.File("log");
};

TEST_F(LogGraphTest, OfAProgramWithFewerChannelsMakesItsStepsComplete) {
  EXPECT_EQ(Read({.has = IsOfNoFollower}).steps, 0) << "the log names no graph";
  for (const bool realtime : {false, true}) {
    const log::RunLog run =
        Read({.realtime = realtime, .has = IsOfNoFollower, .graph = WithoutFollowers()});
    EXPECT_EQ(run.steps, test::kSteps);
    EXPECT_TRUE(run.complete) << run.note;
    EXPECT_EQ(run.note, "") << "no message is missing";
    EXPECT_FALSE(run.channels[IndexOf<follower_command_t>()]);
    EXPECT_EQ(run.channels.count() + 1, log::OwnStepChannels().count());
  }
}

TEST_F(LogGraphTest, DemandsTheChannelsThatItNames) {
  const log::RunLog run =
      Read({.has =
                [](std::string_view channel, std::int64_t step) {
                  return IsOfNoFollower(channel, step) && !(channel == "RADAR" && step == 1);
                },
            .graph = WithoutFollowers()});
  EXPECT_EQ(run.steps, 1);
  EXPECT_THAT(run.note, HasSubstr("step 1 lacks RADAR"));
  EXPECT_THAT(run.note, testing::Not(HasSubstr(std::string(kFollowers))));
}

TEST_F(LogGraphTest, LeavesMessagesOfOtherChannelsOutOfTheDigest) {
  const log::RunLog without = Read({.has = IsOfNoFollower, .graph = WithoutFollowers()});
  const log::RunLog with = Read({.graph = WithoutFollowers()});
  EXPECT_EQ(with.digest, without.digest);
  EXPECT_NE(Read({}).digest, without.digest);
}

TEST_F(LogGraphTest, WithAChannelThatThisProgramLacksIsRefusedByName) {
  log_graph_t graph = WithoutFollowers();
  graph.channel.back() = "SON\nAR";
  graph.type.back() = "sonar_t";
  graph.producer.back() = "sonar";
  EXPECT_EQ(test::ErrorOf([&] { Read({.graph = graph}); }),
            file_ +
                ": error: the log has the channel SON\\u000aAR (sonar_t from sonar), which this "
                "program does not have: read the log with the version of Fogline that wrote it");
}

TEST_F(LogGraphTest, OfAnotherRunOrWithoutTruthHasNoEffect) {
  log_graph_t other = WithoutFollowers();
  other.header.run_id = test::kRunId + 1;
  EXPECT_EQ(Read({.graph = other}).channels, log::OwnStepChannels());
  log_graph_t blind = WithoutFollowers();
  blind.channel.front() = "RADAR";
  EXPECT_EQ(Read({.graph = blind}).channels, log::OwnStepChannels());
  EXPECT_TRUE(Read({.graph = blind}).complete);
}

TEST_F(LogGraphTest, OfALogThatNamesNoneIsThatOfTheTypesOrTheFirst) {
  EXPECT_EQ(Read({}).channels, log::OwnStepChannels());
  const log::RunLog older = Read({.type_fingerprint = TypeFingerprint() + 1});
  EXPECT_EQ(older.channels.count(), 9U) << "TRUTH to FOLLOWER_COMMAND, whatever came later";
  EXPECT_EQ(older.channels & log::OwnStepChannels(), older.channels);
  EXPECT_TRUE(older.complete) << older.note;
}

TEST_F(LogGraphTest, ThatIsWrittenIsReadAndBelongsToTheFrontOfTheLog) {
  std::int64_t size = 0;
  {
    test::WriteShortLog(file_, {.has = [](std::string_view, std::int64_t) { return false; }});
    const log::LogHead scenario = log::ReadFront(file_).head;
    log::EventLogWriter writer(file_, scenario);
    log::WriteLogGraph(writer, test::kRunId);
    writer.Flush();
    size = writer.size();
    EXPECT_GT(size, scenario.bytes);
  }
  const log::LogFront front = log::ReadFront(file_);
  EXPECT_EQ(front.head.bytes, size);
  log::EventLogReader reader(file_);
  std::optional<log::Event> last;
  while (const auto event = reader.Next()) last = event;
  ASSERT_TRUE(last);
  EXPECT_EQ(log::ReadLogGraph(*last, test::kRunId), log::OwnStepChannels());
}

}  // namespace
}  // namespace fogline
