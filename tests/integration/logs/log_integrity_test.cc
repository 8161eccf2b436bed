// The log of a run is changed during the run or later. The run, or the reader of the log, reports
// the change.
#include <fcntl.h>
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "services/log/event_log.h"
#include "services/log/log_seal.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/support/command.h"
#include "tests/support/relay_fixture.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using Words = std::vector<std::string>;
using Payload = std::vector<std::uint8_t>;

Words With(Words command, const Words& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

/// The offset of the first event of a channel in a log, and the event's size in bytes.
struct Place {
  std::size_t at = 0;
  std::size_t size = 0;
};
Place PlaceOf(const std::string& log, std::string_view channel) {
  log::EventLogReader reader(log);
  std::size_t at = 0;
  while (const auto event = reader.Next()) {
    if (event->channel == channel) return {.at = at, .size = log::SizeInFile(*event)};
    at = reader.good_bytes();
  }
  ADD_FAILURE() << "no " << channel << " in " << log;
  return {};
}

void FlipLowestBit(const std::string& file, std::size_t at) {
  const int fd = open(file.c_str(), O_RDWR);
  std::uint8_t byte = 0;
  EXPECT_EQ(pread(fd, &byte, 1, static_cast<off_t>(at)), 1);
  byte ^= 1;
  EXPECT_EQ(pwrite(fd, &byte, 1, static_cast<off_t>(at)), 1);
  close(fd);
}

/// Copies the events of a log into another file, altered by `change` and without the log's seal.
void Rewrite(const std::string& from, const std::string& to,
             const std::function<void(std::string_view channel, Payload&)>& change) {
  log::EventLogReader reader(from);
  log::EventLogWriter writer(to);
  while (const auto event = reader.Next()) {
    if (event->channel == log::kLogSealChannel) continue;
    Payload bytes(event->data.begin(), event->data.end());
    change(event->channel, bytes);
    writer.Write(event->channel, event->utime, bytes);
  }
}

void PutRunId(std::int64_t run_id, Payload& bytes) {
  for (int i = 0; i < 8; ++i) {
    bytes[runtime::kRunIdOffset + static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(run_id >> (8 * (7 - i)));
  }
}

class LogIntegrityTest : public testing::Test {
 protected:
  /// A run with a driver from elsewhere. The run waits until the test starts this driver.
  Words Run(const Words& more = {}) const {
    return With({Program("fogline"), "run", "scenario/paper.json", "--json", "--external", "driver",
                 "--stall-timeout", "60", "--lcm-url", url_, "--log", log_},
                more);
  }
  Words Driver() const { return {Program("fogline-driver"), "--lcm-url", url_}; }
  std::int64_t RunIdIn(const std::string& err) const {
    return std::stoll(err.substr(err.find("run ") + 4));
  }
  static nlohmann::json Digest(const Words& arguments, int code) {
    const Outcome outcome = RunCommand(With({Program("fogline"), "digest", "--json"}, arguments));
    EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false)[0];
  }
  /// Makes a log of a run in one process. @return its path
  std::string DirectLog(const std::string& name, const Words& more = {}) const {
    const std::string log = folder_.File(name);
    const Outcome run =
        RunCommand(With({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                         "--quiet", "--set", "/steps=50", "--log", log},
                        more));
    EXPECT_EQ(run.code, 0) << run.err;
    return log;
  }

  ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string url_ = runtime::Bus(runtime::FreshMulticastUrl()).url();
};

// ---- the log of a run, while it goes on ---------------------------------------------------------

TEST_F(LogIntegrityTest, ALogThatAnotherTakesThePlaceOfEndsTheRunAlthoughItHasItsRunId) {
  const std::string other = DirectLog("other.lcm", {"--seed", "2"});
  Background run(Run());
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  ASSERT_TRUE(GrowsTo(1, log_));
  // WHEN the log of another run replaces the log of this run, and has this run's id
  const std::int64_t run_id = RunIdIn(run.Err());
  const std::string forged = folder_.File("forged.lcm");
  Rewrite(other, forged, [run_id](std::string_view, Payload& bytes) { PutRunId(run_id, bytes); });
  std::filesystem::rename(forged, log_);
  const Background driver(Driver());
  EXPECT_EQ(run.Wait(), 3);
  EXPECT_THAT(run.Err(), HasSubstr("fogline run: error: " + log_ +
                                   ": the log is not the file that the run began with: it was "
                                   "replaced meanwhile"));
  EXPECT_EQ(run.Out(), "");
}

class FlippedBitTest : public LogIntegrityTest {
 protected:
  /// Lets a run begin, stops its driver, and calls `disturb`, which changes the log on the disk.
  /// @return the outcome of the run
  Outcome Disturbed(const std::function<void(Background& run)>& disturb) {
    Background run(Run({"--pace", "10", "--set", "/steps=60"}));
    Background driver(Driver());
    constexpr std::uintmax_t kSomeSteps = 30'000;
    EXPECT_TRUE(GrowsTo(kSomeSteps, log_)) << run.Err();
    driver.Signal(SIGSTOP);
    disturb(run);
    driver.Signal(SIGCONT);
    const int code = run.Wait();
    return {.code = code, .out = run.Out(), .err = run.Err()};
  }
};

TEST_F(FlippedBitTest, InAMessageEndsTheRun) {
  const Outcome outcome = Disturbed([&](Background&) {
    const Place radar = PlaceOf(log_, "RADAR");
    FlipLowestBit(log_, radar.at + radar.size - 17);  // in its range rate
  });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: " + log_ + ": the log on disk is not what the recorder wrote: "));
  EXPECT_EQ(outcome.out, "");
}

TEST_F(FlippedBitTest, BeforeTheRecorderIsKilledEndsTheRunToo) {
  const Outcome outcome = Disturbed([&](Background& run) {
    const Place radar = PlaceOf(log_, "RADAR");
    FlipLowestBit(log_, radar.at + radar.size - 17);
    kill(PidOf(run.Err(), "recorder"), SIGKILL);
    EXPECT_TRUE(run.WaitForErr("started again as pid")) << run.Err();
  });
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the log on disk is not what the recorder wrote: "));
}

TEST_F(FlippedBitTest, IsTheOnlyThingThatEndsTheRunWhenItsRecorderIsKilled) {
  const Outcome outcome = Disturbed([&](Background& run) {
    kill(PidOf(run.Err(), "recorder"), SIGKILL);
    EXPECT_TRUE(run.WaitForErr("started again as pid")) << run.Err();
  });
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Digest({log_}, 0)["seal"], "holds");
}

// ---- the seal -----------------------------------------------------------------------------------

TEST_F(LogIntegrityTest, ARunSealsItsLogOnEveryTransport) {
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

TEST_F(LogIntegrityTest, ARunInRealtimeSealsItsLogWithTheStatusOfItsRoles) {
  const Outcome run =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--realtime", "--speed", "10",
                  "--set", "/steps=20", "--json", "--verify", "--log", log_});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["log_checked"], true);
  EXPECT_THAT(json["verified"]["roles"], IsEmpty());
  EXPECT_TRUE(json["verified"]["same"].is_null()) << "nothing was compared";
  EXPECT_EQ(json["verified"]["left_out"][0]["why"], "a run in real time");
  EXPECT_EQ(Digest({log_}, 0)["seal"], "holds");
  // WHEN a STATUS is changed (the measures of real time come from STATUS)
  const Place status = PlaceOf(log_, "STATUS");
  FlipLowestBit(log_, status.at + status.size - 1);
  const Outcome metrics = RunCommand({Program("fogline"), "metrics", log_});
  EXPECT_EQ(metrics.code, 1);
  EXPECT_THAT(metrics.err, HasSubstr("altered: the bytes differ from the sealed ones"));
}

TEST_F(LogIntegrityTest, ARunThatIsInterruptedSealsWhatItHas) {
  Background run(Run({"--pace", "1"}));
  const Background driver(Driver());
  ASSERT_TRUE(GrowsTo(30'000, log_)) << run.Err();
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130);
  const auto digest = Digest({log_}, 1);
  EXPECT_EQ(digest["complete"], false);
  EXPECT_EQ(digest["seal"], "holds");
}

TEST_F(LogIntegrityTest, EveryReaderNamesALogThatWasChangedSinceItWasSealed) {
  const std::string log = DirectLog("log.lcm");
  const Place radar = PlaceOf(log, "RADAR");
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

TEST_F(LogIntegrityTest, TheFileOfASealedLogIsComparedByDigest) {
  const std::string log = DirectLog("log.lcm");
  FlipLowestBit(log, 19);  // the time of the first event; no digest covers it
  EXPECT_EQ(Digest({log}, 1)["seal"], "broken");
}

TEST_F(LogIntegrityTest, ALogIsSignedWithTheKeyOfItsRun) {
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

TEST_F(LogIntegrityTest, ALogThatLcmToolsPlayAndRecordKeepsDigestAndSeal) {
  const std::string log = DirectLog("log.lcm");
  const std::string copy = folder_.File("copy.lcm");
  {
    // Over TCP, because lcm-logger loses UDP messages when a busy machine holds it up.
    const Relay relay;
    runtime::Bus bus(relay.url());
    Background logger(
        {"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + relay.url(), copy});
    // Sends until lcm-logger has written a message of this channel. Then it has written all earlier
    // messages, too.
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

TEST_F(LogIntegrityTest, ALogWithOtherTimesIsACopyAndItsSealProvesNoResultOfARunInRealTime) {
  const std::string key = folder_.File("key");
  runtime::SigningKey::Create(key);
  const std::string lockstep = DirectLog("lockstep.lcm", {"--key", key});
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--realtime", "--speed",
                        "10", "--quiet", "--set", "/steps=50", "--key", key, "--log", log_})
                .code,
            0);
  EXPECT_EQ(Digest({log_, "--key", key}, 0)["seal"], "holds");
  // The last byte of the time: an event begins with sync word, number, time.
  constexpr std::size_t kTimeInEvent = 19;
  for (const auto& [log, code] : {std::pair{lockstep, 0}, std::pair{log_, 1}}) {
    FlipLowestBit(log, kTimeInEvent);
    FlipLowestBit(log, PlaceOf(log, log::kLogSealChannel).at + kTimeInEvent);
    const auto digest = Digest({log, "--key", key}, code);
    EXPECT_EQ(digest["seal"], "copy") << log;
    EXPECT_EQ(digest["signature"], "holds") << log;
  }
}

TEST_F(LogIntegrityTest, ARunGoesOnWithNoLogThatWasChangedSinceItWasSealed) {
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
  // WHEN one bit of its first step is changed
  const Place radar = PlaceOf(log_, "RADAR");
  FlipLowestBit(log_, radar.at + radar.size - 17);
  expect_refused(key, "the log is not the one that was sealed: ");
  // THEN the run does not continue this log, but continues the log that was sealed
  FlipLowestBit(log_, radar.at + radar.size - 17);
  EXPECT_EQ(resume(key).code, 0);
  EXPECT_EQ(Digest({log_, "--key", key}, 0)["signature"], "holds");
}

// ---- builds -------------------------------------------------------------------------------------

/// A driver of another build: the same program with another build id.
std::string DriverOfAnotherBuild(const ScratchFolder& folder) {
  const std::string program = folder.File("fogline-driver");
  std::filesystem::copy_file(Program("fogline-driver"), program);
  std::ifstream in(program, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  // A note: name size 4, content size 20, type 3 (NT_GNU_BUILD_ID), name.
  using namespace std::string_view_literals;
  const std::size_t note = content.find("\x04\0\0\0\x14\0\0\0\x03\0\0\0GNU\0"sv);
  EXPECT_NE(note, std::string::npos);
  FlipLowestBit(program, note + 16);
  return program;
}

TEST_F(LogIntegrityTest, ARoleOfAnotherBuildIsNamedAndLeftOutOfTheCheck) {
  const Background driver({DriverOfAnotherBuild(folder_), "--lcm-url", url_});
  const Outcome run = RunCommand(Run({"--set", "/steps=50"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("warning: driver (pid " + std::to_string(driver.pid()) + " on "));
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json["other_builds"].size(), 1U) << json["other_builds"];
  const auto other = json["other_builds"][0];
  EXPECT_EQ(other["role"], "driver");
  EXPECT_NE(other["build"], other["expected"]);
  EXPECT_FALSE(other["expected"].is_null());
  EXPECT_EQ(json["verified"]["same"], true);
  EXPECT_EQ(json["verified"]["roles"].size(), 7U);
  EXPECT_EQ(json["verified"]["left_out"][0]["role"], "driver");
  EXPECT_EQ(json["verified"]["left_out"][0]["why"], "of another build");
  EXPECT_EQ(Digest({log_}, 0)["builds"]["driver"], other["build"]) << "it is in the log";
}

TEST_F(LogIntegrityTest, ARoleOfAnotherBuildIsRefusedWithSameBuild) {
  Background driver({DriverOfAnotherBuild(folder_), "--lcm-url", url_});
  const Outcome run = RunCommand(Run({"--same-build"}));
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("fogline run: error: driver (pid " + std::to_string(driver.pid()) +
                                 " on "));
  EXPECT_THAT(run.err, HasSubstr(" (--same-build)"));
  EXPECT_EQ(driver.Wait(), 0) << "told to leave";
}

TEST_F(LogIntegrityTest, RolesOfTheSameBuildAreAcceptedWithSameBuildOnEveryTransport) {
  for (const char* transport : {"memq", "udpm"}) {
    const Outcome run =
        RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", transport,
                    "--same-build", "--verify", "--json", "--set", "/steps=50", "--log",
                    folder_.File(std::string(transport) + ".lcm")});
    ASSERT_EQ(run.code, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_THAT(json["other_builds"], IsEmpty());
    EXPECT_EQ(json["verified"]["roles"].size(), 8U);
    EXPECT_THAT(json["verified"]["left_out"], IsEmpty());
  }
}

}  // namespace
}  // namespace fogline::test
