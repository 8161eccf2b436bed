// A run seals its log. A reader of the log reports whether the seal holds.
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>

#include "services/log/log_seal.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/integration/logs/log_integrity_fixture.h"
#include "tests/integration/network/relay_fixture.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class SealedLogTest : public LogIntegrityTest {};

TEST_F(SealedLogTest, ARunSealsItsLogOnEveryTransport) {
  for (const char* transport : {"direct", "memq", "udpm"}) {
    const std::string log = folder_.File(std::string(transport) + ".lcm");
    const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                    transport, "--json", "--log", log});
    ASSERT_EQ(run.code, 0) << run.err;
    const auto digest = Digest({log}, 0);
    EXPECT_EQ(digest["seal"], "holds");
    EXPECT_EQ(digest["signature"], "none");
    EXPECT_EQ(digest["digest"], nlohmann::json::parse(run.out)["digest"]);
    EXPECT_EQ(digest["builds"].size(), kRoles.size());
    EXPECT_FALSE(digest["builds"]["driver"].is_null());
  }
}

TEST_F(SealedLogTest, ARunInRealtimeSealsItsLogWithTheStatusOfItsRoles) {
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--realtime",
                                  "--set", "/steps=20", "--json", "--verify", "--log", log_});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["log_checked"], true);
  EXPECT_THAT(json["verified"]["roles"], IsEmpty());
  EXPECT_TRUE(json["verified"]["same"].is_null()) << "nothing was compared";
  EXPECT_EQ(json["verified"]["left_out"][0]["why"], "a run in real time");
  EXPECT_EQ(Digest({log_}, 0)["seal"], "holds");
  // WHEN a STATUS is changed, THEN `fogline metrics` refuses the log. Some metrics of a run in real
  // time come from STATUS
  const EventPlace status = FirstEventOf(log_, "STATUS");
  FlipLowestBit(log_, status.at + status.size - 1);
  const Outcome metrics = RunCommand({Program("fogline"), "metrics", log_});
  EXPECT_EQ(metrics.code, 1);
  EXPECT_THAT(metrics.err, HasSubstr("altered: the bytes differ from the sealed ones"));
}

TEST_F(SealedLogTest, ARunThatIsInterruptedSealsWhatItHas) {
  // A recorder that does not end within 1.5 s is killed, and leaves the log without a seal. Then
  // the test tries again.
  constexpr int kTries = 3;
  nlohmann::json digest = nlohmann::json::object();
  for (int i = 0; i < kTries && digest.value("seal", "none") == "none"; ++i) {
    std::filesystem::remove(log_);
    Background run(Run({"--pace", "1"}));
    const Background driver(Driver());
    ASSERT_TRUE(GrowsTo(30'000, log_)) << run.Err();
    run.Signal(SIGINT);
    EXPECT_EQ(run.Wait(), 130);
    digest = Digest({log_}, 1);
  }
  EXPECT_EQ(digest["complete"], false);
  EXPECT_EQ(digest["seal"], "holds");
}

TEST_F(SealedLogTest, EveryReaderNamesALogThatWasChangedSinceItWasSealed) {
  const std::string log = DirectLog("log.lcm");
  const EventPlace radar = FirstEventOf(log, "RADAR");
  FlipLowestBit(log, radar.at + radar.size - 17);
  for (const Words& verb :
       {Words{"digest"}, Words{"metrics"}, Words{"events"}, Words{"replay", "--role", "world"},
        Words{"diff", log}, Words{"report", "-o", folder_.File("report.html")},
        Words{"export", "--out", folder_.File("run.mat")}}) {
    const Outcome outcome = RunCommand(With(With({Program("fogline")}, verb), {log}));
    EXPECT_EQ(outcome.code, 1) << verb.front() << ": " << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr("altered: the seal names digest ")) << verb.front();
  }
}

TEST_F(SealedLogTest, TheFileOfASealedLogIsComparedByDigest) {
  const std::string log = DirectLog("log.lcm");
  FlipLowestBit(log, 19);  // the time of the first event; no digest covers this time
  EXPECT_EQ(Digest({log}, 1)["seal"], "broken");
}

TEST_F(SealedLogTest, ALogIsSignedWithTheKeyOfItsRun) {
  const std::string key = folder_.File("key");
  const std::string other = folder_.File("other_key");
  runtime::SigningKey::Create(key);
  runtime::SigningKey::Create(other);
  for (const char* transport : {"direct", "memq", "udpm"}) {
    SCOPED_TRACE(transport);
    const std::string log = folder_.File(std::string(transport) + ".lcm");
    ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                          transport, "--quiet", "--set", "/steps=50", "--key", key, "--log", log})
                  .code,
              0);
    EXPECT_EQ(Digest({log}, 0)["signature"], "not checked");
    EXPECT_EQ(Digest({log, "--key", key}, 0)["signature"], "holds");
    EXPECT_EQ(Digest({log, "--key", other}, 1)["signature"], "wrong");
    // WHEN the log is changed and written again without the key
    const std::string forged = folder_.File("forged.lcm");
    Rewrite(log, forged, [](std::string_view channel, Payload& bytes) {
      if (channel == "RADAR") bytes.back() ^= 1;
    });
    EXPECT_EQ(Digest({forged, "--key", key}, 1)["signature"], "none");
    EXPECT_EQ(Digest({forged}, 0)["seal"], "none") << "as a log of lcm-logger";
  }
}

TEST_F(SealedLogTest, ALogThatLcmToolsPlayAndRecordKeepsDigestAndSeal) {
  const std::string log = DirectLog("log.lcm");
  const std::string copy = folder_.File("copy.lcm");
  {
    // The messages go over TCP, because lcm-logger loses UDP messages when a busy machine delays
    // lcm-logger.
    const Relay relay;
    runtime::Bus bus(relay.url());
    Background logger(
        {"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + relay.url(), copy});
    // Sends messages until lcm-logger has written a message of this channel. lcm-logger has then
    // also written all earlier messages.
    const auto mark = [&](std::string_view channel) {
      const auto has = [&] {
        std::ifstream in(copy, std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(in), {}};
        return content.find(channel) != std::string::npos;
      };
      const TimePoint end = Clock::now() + kPatience;
      while (!has() && IsAlive(logger.pid()) && Clock::now() < end) {
        bus.Publish(channel, Payload(runtime::kHeaderEnd));
        bus.Wait(milliseconds(10));
      }
      return has();
    };
    ASSERT_TRUE(mark("BEGIN"));
    Background player({"lcm-logplayer", "--speed=5", "--lcm-url=" + relay.url(), log});
    ASSERT_EQ(player.Wait(), 0) << player.Err();
    ASSERT_TRUE(mark("END"));
    logger.Signal(SIGINT);
    logger.Wait();
  }
  const auto ours = Digest({log}, 0);
  const auto theirs = Digest({copy}, 0);
  EXPECT_EQ(theirs["digest"], ours["digest"]);
  EXPECT_EQ(theirs["seal"], "copy");
  EXPECT_EQ(theirs["builds"], ours["builds"]);
}

TEST_F(SealedLogTest, ALogWithOtherTimesIsACopyAndItsSealProvesNoResultOfARunInRealTime) {
  const std::string key = folder_.File("key");
  runtime::SigningKey::Create(key);
  const std::string lockstep = DirectLog("lockstep.lcm", {"--key", key});
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--realtime",
                                  "--quiet", "--set", "/steps=20", "--key", key, "--log", log_});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(Digest({log_, "--key", key}, 0)["seal"], "holds");
  // The offset of the last byte of an event's time. The time comes after the sync word and the
  // number of the event.
  constexpr std::size_t kTimeInEvent = 19;
  for (const auto& [log, code] : {std::pair{lockstep, 0}, std::pair{log_, 1}}) {
    FlipLowestBit(log, kTimeInEvent);
    FlipLowestBit(log, FirstEventOf(log, log::kLogSealChannel).at + kTimeInEvent);
    const auto digest = Digest({log, "--key", key}, code);
    EXPECT_EQ(digest["seal"], "copy") << log;
    EXPECT_EQ(digest["signature"], "holds") << log;
  }
}

TEST_F(SealedLogTest, ARunGoesOnWithNoLogThatWasChangedSinceItWasSealed) {
  const std::string key = folder_.File("key");
  const std::string other = folder_.File("other_key");
  runtime::SigningKey::Create(key);
  runtime::SigningKey::Create(other);
  // GIVEN the signed log of a run that was interrupted
  Background run({Program("fogline"), "run", "scenario/paper.json", "--transport", "memq", "--pace",
                  "10", "--key", key, "--log", log_});
  ASSERT_TRUE(GrowsTo(200'000, log_)) << run.Err();
  run.Signal(SIGINT);
  ASSERT_EQ(run.Wait(), 130) << run.Err();
  EXPECT_EQ(Digest({log_, "--key", key}, 1)["signature"], "holds");
  const auto resume = [&](const std::string& with) {
    return RunCommand({Program("fogline"), "run", "--resume", log_, "--transport", "memq",
                       "--quiet", "--key", with});
  };
  const auto expect_refused = [&](const std::string& with, const std::string& why) {
    const std::string before = Content(log_);
    const Outcome refused = resume(with);
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(log_ + ": error: --resume: " + why));
    EXPECT_EQ(Content(log_), before);
  };
  expect_refused(other, "the seal of the log is not signed with this key");
  // WHEN one bit of the log's first step is changed
  const EventPlace radar = FirstEventOf(log_, "RADAR");
  FlipLowestBit(log_, radar.at + radar.size - 17);
  expect_refused(key, "the log is not the one that was sealed: ");
  // THEN the run does not continue this log. WHEN the bit is changed back, THEN the run continues
  FlipLowestBit(log_, radar.at + radar.size - 17);
  EXPECT_EQ(resume(key).code, 0);
  EXPECT_EQ(Digest({log_, "--key", key}, 0)["signature"], "holds");
}

}  // namespace
}  // namespace fogline::test
