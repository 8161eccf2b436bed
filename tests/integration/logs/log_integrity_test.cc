// Tests in which the log of a run is changed, or a role has another build. The run reports such a
// log or role.
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "services/graph.h"
#include "services/runtime/wire/wire.h"
#include "tests/integration/logs/log_integrity_fixture.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

void PutRunId(std::int64_t run_id, Payload& bytes) {
  for (int i = 0; i < 8; ++i) {
    bytes[runtime::kRunIdOffset + static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(run_id >> (8 * (7 - i)));
  }
}

// ---- the log of a run, while the run continues --------------------------------------------------

TEST_F(LogIntegrityTest, ALogThatAnotherTakesThePlaceOfEndsTheRunAlthoughItHasItsRunId) {
  const std::string other = DirectLog("other.lcm", {"--seed", "2"});
  Background run(Run());
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  ASSERT_TRUE(GrowsTo(1, log_));
  // WHEN a forged log replaces the log of this run. The forged log is a log of another run, into
  // which the test has written the id of this run
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

class DisturbedLogTest : public LogIntegrityTest {
 protected:
  /// Lets a run begin, stops its driver, and calls `disturb`, which changes the log on the disk.
  /// @return the outcome of the run
  Outcome Disturbed(const std::function<void(Background& run)>& disturb) {
    Background run(Run({"--pace", "1", "--set", "/steps=60"}));
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

TEST_F(DisturbedLogTest, ThatIsRemovedEndsTheRun) {
  const Outcome outcome = Disturbed([&](Background&) { std::filesystem::remove(log_); });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error: " + log_ + ": the log was removed during the run"));
  EXPECT_EQ(outcome.out, "");
}

TEST_F(DisturbedLogTest, ThatIsEmptiedEndsTheRun) {
  const Outcome outcome = Disturbed([&](Background&) { std::filesystem::resize_file(log_, 0); });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error: " + log_ + ": error: not an LCM event log"));
  EXPECT_EQ(outcome.out, "");
}

TEST_F(DisturbedLogTest, ThatIsRemovedEndsARunInOneProcessToo) {
  Background run({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                  "--set", "/steps=500000", "--log", log_});
  ASSERT_TRUE(GrowsTo(1'000'000, log_)) << run.Err();
  std::filesystem::remove(log_);
  EXPECT_EQ(run.Wait(), 3) << run.Err();
  EXPECT_THAT(run.Err(), HasSubstr(log_ + ": the log was removed during the run"));
}

class FlippedBitTest : public DisturbedLogTest {};

TEST_F(FlippedBitTest, InAMessageEndsTheRun) {
  const Outcome outcome = Disturbed([&](Background&) {
    const EventPlace radar = FirstEventOf(log_, "RADAR");
    FlipLowestBit(log_, radar.at + radar.size - 17);  // in its range rate
  });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: " + log_ + ": the log on disk is not what the recorder wrote: "));
  EXPECT_EQ(outcome.out, "");
}

TEST_F(FlippedBitTest, BeforeTheRecorderIsKilledEndsTheRunToo) {
  const Outcome outcome = Disturbed([&](Background& run) {
    const EventPlace radar = FirstEventOf(log_, "RADAR");
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

// ---- builds -------------------------------------------------------------------------------------

/// A driver of another build: the same program with another build id.
std::string DriverOfAnotherBuild(const ScratchFolder& folder) {
  const std::string program = folder.File("fogline-driver");
  std::filesystem::copy_file(Program("fogline-driver"), program);
  std::ifstream in(program, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  // The beginning of the build id's ELF note: name size 4, content size 20, type 3
  // (NT_GNU_BUILD_ID), name.
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
    EXPECT_EQ(json["verified"]["roles"].size(), kRoles.size() - 1);
    EXPECT_THAT(json["verified"]["left_out"], IsEmpty());
  }
}

}  // namespace
}  // namespace fogline::test
