// The log and the traffic of a run are changed while it goes on, or later: the run, or the reader
// of the log, says so.
#include <fcntl.h>
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "services/recorder/event_log.h"
#include "services/recorder/log_seal.h"
#include "services/runtime/bus.h"
#include "services/runtime/seal.h"
#include "tests/support/command.h"

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

/// Where the first event of a channel begins in a log, and the event.
struct Place {
  std::size_t at = 0;
  std::size_t size = 0;
};
Place PlaceOf(const std::string& log, std::string_view channel) {
  EventLogReader reader(log);
  std::size_t at = 0;
  while (const auto event = reader.Next()) {
    if (event->channel == channel) return {.at = at, .size = SizeInFile(*event)};
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

/// Writes the events of a log into another file, as `change` leaves them; without its seal.
void Rewrite(const std::string& from, const std::string& to,
             const std::function<void(std::string_view channel, Payload&)>& change) {
  EventLogReader reader(from);
  EventLogWriter writer(to);
  while (const auto event = reader.Next()) {
    if (event->channel == kLogSealChannel) continue;
    Payload bytes(event->data.begin(), event->data.end());
    change(event->channel, bytes);
    writer.Write(event->channel, event->utime, bytes);
  }
}

void PutRunId(std::int64_t run_id, Payload& bytes) {
  for (int i = 0; i < 8; ++i) {
    bytes[kRunIdOffset + static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(run_id >> (8 * (7 - i)));
  }
}

class LogIntegrityTest : public testing::Test {
 protected:
  /// A run with a driver from elsewhere, so that the test says when it goes on.
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
  /// A log of a run in one process.
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
  const std::string url_ = Bus(FreshMulticastUrl()).url();
};

// ---- the log of a run, while it goes on ---------------------------------------------------------

TEST_F(LogIntegrityTest, ALogThatAnotherTakesThePlaceOfEndsTheRunAlthoughItHasItsRunId) {
  const std::string other = DirectLog("other.lcm", {"--seed", "2"});
  Background run(Run());
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  ASSERT_TRUE(GrowsTo(1, log_));
  // WHEN a log of another run, which says that it is of this one, takes the place of its log
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
  /// Lets a run begin, stops its driver, and has `disturb` change the log of what is on the disk.
  /// @return what has come of the run
  Outcome Disturbed(const std::function<void(const Background& run)>& disturb) {
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
  const Outcome outcome = Disturbed([&](const Background&) {
    const Place radar = PlaceOf(log_, "RADAR");
    FlipLowestBit(log_, radar.at + radar.size - 17);  // in its range rate
  });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: " + log_ + ": the log on disk is not what the recorder wrote: "));
  EXPECT_EQ(outcome.out, "");
}

TEST_F(FlippedBitTest, BeforeTheRecorderIsKilledEndsTheRunToo) {
  const Outcome outcome = Disturbed([&](const Background& run) {
    const Place radar = PlaceOf(log_, "RADAR");
    FlipLowestBit(log_, radar.at + radar.size - 17);
    kill(PidOf(run.Err(), "recorder"), SIGKILL);
    while (run.Err().find("started again as pid") == std::string::npos && IsAlive(run.pid())) {
    }
  });
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the log on disk is not what the recorder wrote: "));
}

TEST_F(FlippedBitTest, IsTheOnlyThingThatEndsTheRunWhenItsRecorderIsKilled) {
  const Outcome outcome = Disturbed([&](const Background& run) {
    kill(PidOf(run.Err(), "recorder"), SIGKILL);
    while (run.Err().find("started again as pid") == std::string::npos && IsAlive(run.pid())) {
    }
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
  // WHEN a STATUS is changed, from which the measures of real time are made
  const Place status = PlaceOf(log_, "STATUS");
  FlipLowestBit(log_, status.at + status.size - 1);
  const Outcome metrics = RunCommand({Program("fogline"), "metrics", log_});
  EXPECT_EQ(metrics.code, 1);
  EXPECT_THAT(metrics.err, HasSubstr("altered: other bytes than those that were sealed"));
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
    EXPECT_THAT(outcome.err, HasSubstr("altered: sealed with digest ")) << verb.front();
  }
}

TEST_F(LogIntegrityTest, TheFileOfASealedLogIsComparedByDigest) {
  const std::string log = DirectLog("log.lcm");
  FlipLowestBit(log, 19);  // the time of the first event, which is in no digest
  EXPECT_EQ(Digest({log}, 1)["seal"], "broken");
}

TEST_F(LogIntegrityTest, ALogIsSignedWithTheKeyOfItsRun) {
  const std::string key = folder_.File("key");
  const std::string other = folder_.File("other_key");
  SealKey::Create(key);
  SealKey::Create(other);
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
    // WHEN the log is changed, and sealed again without the key
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
    Bus bus(url_);
    Background logger({"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + url_, copy});
    // Until it listens, and until it has all.
    const auto mark = [&](std::string_view channel) {
      const auto has = [&] {
        std::ifstream in(copy, std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(in), {}};
        return content.find(channel) != std::string::npos;
      };
      while (!has() && IsAlive(logger.pid())) {
        bus.Publish(channel, Payload(kHeaderEnd));
        bus.Wait(milliseconds(10));
      }
    };
    mark("BEGIN");
    Background player({"lcm-logplayer", "--speed=5", "--lcm-url=" + url_, log});
    ASSERT_EQ(player.Wait(), 0) << player.Err();
    mark("END");
    logger.Signal(SIGINT);
    logger.Wait();
  }
  const auto ours = Digest({log}, 0);
  const auto theirs = Digest({copy}, 0);
  EXPECT_EQ(theirs["digest"], ours["digest"]);
  EXPECT_EQ(theirs["seal"], "holds");
  EXPECT_EQ(theirs["builds"], ours["builds"]);
}

// ---- builds -------------------------------------------------------------------------------------

/// A driver that is of another build: the same program, but for what its linker has said of it.
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

// ---- traffic ------------------------------------------------------------------------------------

/// Carries messages between a run and a role of it on another network, and alters one of them.
class Bridge {
 public:
  Bridge(const std::string& run, const std::string& role) : run_(run), role_(role) {
    for (const char* channel : {"RUN", "TRUTH", "RESEND"}) Carry(run_, role_, channel);
    for (const char* channel : {"LIDAR", "STATUS"}) Carry(role_, run_, channel);
  }

  /// The range of this step becomes larger on its way.
  void Alter(std::int64_t step) { altered_ = step; }

  void RunUntilTheEndOf(const Background& program) {
    while (IsAlive(program.pid())) {
      run_.Wait(milliseconds(1));
      run_.Drain();
      role_.Drain();
    }
  }

 private:
  void Carry(Bus& from, Bus& to, const std::string& channel) {
    from.Subscribe(channel, [this, &to, channel](Bytes bytes) {
      Payload payload(bytes.begin(), bytes.end());
      lidar_t lidar{};
      if (Decode(payload, lidar) && lidar.header.step == altered_) {
        lidar.range_m += 0.25;
        Encode(lidar, payload);
      }
      to.Publish(channel, payload);
    });
  }

  Bus run_;
  Bus role_;
  std::int64_t altered_ = -1;
};

class AlteredTrafficTest : public LogIntegrityTest {
 protected:
  /// A run whose LiDAR is behind the bridge.
  Outcome RunAcross(Bridge& bridge, const Words& more) {
    const Background lidar({Program("fogline-lidar"), "--lcm-url", lidar_url_});
    Background run(With({Program("fogline"), "run", "scenario/paper.json", "--json", "--external",
                         "lidar", "--lcm-url", url_, "--set", "/steps=50", "--log", log_},
                        more));
    bridge.RunUntilTheEndOf(run);
    return {.code = run.Wait(), .out = run.Out(), .err = run.Err()};
  }

  const std::string lidar_url_ = Bus(FreshMulticastUrl()).url();
  Bridge bridge_{url_, lidar_url_};
};

TEST_F(AlteredTrafficTest, IsFoundByComputingTheStepsAgain) {
  bridge_.Alter(20);
  const Outcome run = RunAcross(bridge_, {});
  EXPECT_EQ(run.code, 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("fogline run: error: step 20: LIDAR of lidar: range_m is "));
  const auto verified = nlohmann::json::parse(run.out)["verified"];
  EXPECT_EQ(verified["same"], false);
  EXPECT_EQ(verified["first"]["role"], "lidar");
  EXPECT_EQ(verified["first"]["step"], 20);
  EXPECT_EQ(verified["first"]["field"], "range_m");
}

TEST_F(AlteredTrafficTest, EndsATableAlsoWhereStderrIsAFullDisk) {
  bridge_.Alter(20);
  const Background lidar({Program("fogline-lidar"), "--lcm-url", lidar_url_});
  Background table({"sh", "-c", "exec 2>/dev/full; exec \"$@\"", "sh", Program("fogline"), "table",
                    "scenario/paper.json", "--thresholds", "0.5", "--set", "/steps=50",
                    "--external", "lidar", "--lcm-url", url_});
  bridge_.RunUntilTheEndOf(table);
  EXPECT_EQ(table.Wait(), 1);
}

TEST_F(AlteredTrafficTest, IsNotLookedForOnRequest) {
  bridge_.Alter(20);
  const Outcome run = RunAcross(bridge_, {"--no-verify"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(nlohmann::json::parse(run.out)["verified"].is_null());
}

TEST_F(AlteredTrafficTest, IsNotFoundWhereNothingWasAltered) {
  const Outcome run = RunAcross(bridge_, {});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["verified"]["roles"].size(), 8U);
}

}  // namespace
}  // namespace fogline::test
