#include "tools/runner/scenario_run.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "services/runtime/wire/build_id.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/copied_log.h"
#include "tests/support/input_errors.h"
#include "tests/unit/tools/short_run.h"
#include "tools/runner/bus_run.h"

namespace fogline::test {
namespace {

using runner::LoggedRun;
using runner::RunOptions;
using runner::RunResult;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

constexpr std::int64_t kRunSteps = 30;

TEST(CheckPossibleTest, NamesTheFieldOfAScenarioThatNoPartCanHave) {
  EXPECT_NO_THROW(runner::CheckPossible(Paper(kRunSteps), "paper.json"));
  const Scenario impossible = Paper(
      kRunSteps, {R"(/road/grade=[{"position_m":50,"grade":0},{"position_m":20,"grade":0.05}])"});
  try {
    runner::CheckPossible(impossible, "mine.json");
    FAIL() << "it is possible";
  } catch (const ScenarioError& error) {
    const std::string message =
        "20 m does not come after 50 m, the place before it; places must increase";
    EXPECT_EQ(error.what(), "mine.json: error: /road/grade/1/position_m: " + message);
    ASSERT_THAT(error.diagnostics(), SizeIs(1));
    EXPECT_EQ(error.diagnostics()[0].rule, "impossible");
    EXPECT_EQ(error.diagnostics()[0].file, "mine.json");
    EXPECT_EQ(error.diagnostics()[0].pointer, "/road/grade/1/position_m");
    EXPECT_EQ(error.diagnostics()[0].message, message);
  }
}

/// One run without messages, and one over messages in memory.
class RunTest : public testing::Test {
 protected:
  RunResult Run(const std::string& transport, const std::string& log = "") const {
    RunOptions options;
    options.transport = transport;
    options.log = log;
    return runner::RunScenario(Paper(kRunSteps), options);
  }
  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
};

TEST_F(RunTest, HasTheSameResultOverAnyTransport) {
  const RunResult direct = Run("direct");
  const RunResult memq = Run("memq", log_);
  EXPECT_EQ(direct.transport, "direct");
  EXPECT_EQ(memq.transport, "memq");
  EXPECT_EQ(direct.steps, kRunSteps);
  EXPECT_EQ(memq.steps, kRunSteps);
  EXPECT_EQ(direct.digest, memq.digest);
  EXPECT_EQ(direct.seed, memq.seed);
  EXPECT_EQ(direct.measures.min_host_gap_m, memq.measures.min_host_gap_m);
  EXPECT_TRUE(direct.log.empty());
  EXPECT_EQ(memq.log, log_);
  EXPECT_TRUE(memq.checked);
  const log::RunLog log = ReadToTheEnd(log_);
  EXPECT_TRUE(log.complete);
  EXPECT_TRUE(log.seal && log.seal->whole);
}

TEST_F(RunTest, KeepsTheSamplesOnlyOnRequest) {
  RunOptions options = Direct("");
  EXPECT_THAT(runner::RunScenario(Paper(kRunSteps), options).samples, IsEmpty());
  options.samples = true;
  EXPECT_THAT(runner::RunScenario(Paper(kRunSteps), options).samples, SizeIs(kRunSteps));
}

TEST_F(RunTest, ComputesTheStepsAgainOnRequest) {
  RunOptions options;
  options.transport = "memq";
  options.verify = true;
  const RunResult result = runner::RunScenario(Paper(kRunSteps), options);
  ASSERT_TRUE(result.verification);
  EXPECT_TRUE(result.verification->Holds());
  EXPECT_THAT(result.verification->roles, SizeIs(kRoles.size() - 1));
  options.verify.reset();
  EXPECT_FALSE(runner::RunScenario(Paper(kRunSteps), options).verification);
}

TEST_F(RunTest, RefusesATransportThatIsNone) {
  EXPECT_THAT(ErrorOf([&] { Run("pigeon"); }),
              StartsWith("error: --transport pigeon: neither direct, memq, "));
}

TEST_F(RunTest, ReadFromItsLogIsTheSame) {
  const RunResult made = Run("direct", log_);
  const LoggedRun read = runner::ReadLoggedRun(log_);
  const LoggedRun measured = runner::MeasureLoggedRun(log_, Paper(kRunSteps));
  EXPECT_THAT(read.result.samples, SizeIs(kRunSteps));
  EXPECT_THAT(measured.result.samples, IsEmpty());
  for (const LoggedRun& run : {read, measured}) {
    EXPECT_TRUE(run.complete) << run.note;
    EXPECT_EQ(run.result.digest, made.digest);
    EXPECT_EQ(run.result.steps, kRunSteps);
    EXPECT_EQ(run.result.seed, made.seed);
    EXPECT_EQ(run.result.log, log_);
    EXPECT_EQ(run.result.measures.min_host_gap_m, made.measures.min_host_gap_m);
    EXPECT_EQ(run.result.measures.max_doc, made.measures.max_doc);
    EXPECT_THAT(run.result.followers, SizeIs(made.followers.size()));
  }
}

TEST_F(RunTest, IsNotReadFromALogWithAMessageThatIsNone) {
  Run("direct", log_);
  const std::string altered = folder_.File("altered.lcm");
  Copy(log_, altered,
       [](log::EventLogWriter&, const log::Event& event, std::vector<std::uint8_t>& data) {
         const bool is_step_9 = runtime::ReadInt64(data, runtime::kStepOffset) == 9;
         if (event.channel == "RADAR" && is_step_9) data.pop_back();
         return true;
       });
  EXPECT_THROW(runner::ReadLoggedRun(altered), InputError);
  EXPECT_THROW(runner::ReadLoggedRun(folder_.File("missing.lcm")), InputError);
}

TEST(BusRunTest, DrawsAPositiveIdThatNoOtherRunHas) {
  std::set<std::int64_t> ids;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t id = runner::DrawRunId();
    EXPECT_GT(id, 0);
    ids.insert(id);
  }
  EXPECT_THAT(ids, SizeIs(1000));
}

TEST(BusRunTest, ReportsTheRunAndItsLog) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  RunOptions options;
  options.transport = "memq";
  const runner::LogSealer sealer(log);
  const runner::BusRun run = runner::RunOnBus(Paper(kRunSteps), options, log, sealer);
  EXPECT_EQ(ReadToTheEnd(log).run_id, run.run_id);
  EXPECT_TRUE(sealer.HasAllTold(run.written));
  EXPECT_NO_THROW(sealer.Check(run.written));
  EXPECT_THAT(run.restarts, IsEmpty());
  EXPECT_THAT(run.other_builds, IsEmpty());
  EXPECT_THAT(run.builds, testing::Each(runtime::OwnBuildId()));
  for (const std::int64_t refused : run.refused) EXPECT_EQ(refused, 0);
}

}  // namespace
}  // namespace fogline::test
