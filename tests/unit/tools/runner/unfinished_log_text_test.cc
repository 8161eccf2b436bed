#include "tools/runner/unfinished_log_text.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/environment_url.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

using runner::CommandToGoOn;
using runner::RunOptions;
using runner::UnfinishedLogText;

/// Default options, except for the name of the log.
RunOptions OnlyLog() {
  RunOptions options;
  options.log = "run.lcm";
  return options;
}

class CommandToGoOnTest : public testing::Test {
 protected:
  const EnvironmentUrl environment_;
};

TEST_F(CommandToGoOnTest, HasWhatTheLogDoesNotContain) {
  EXPECT_EQ(CommandToGoOn(OnlyLog()), "fogline run --resume run.lcm");
  RunOptions options = OnlyLog();
  options.transport = "memq";
  options.external = {Role::kDriver, Role::kAcc};
  options.pace = 0.5;
  options.stall_limit = milliseconds(5500);
  options.restarts = 0;
  options.wait = Duration::zero();
  options.same_build = true;
  options.verify = false;
  options.traffic = {.key_file = "key", .faults = "loss=0.1"};
  EXPECT_EQ(CommandToGoOn(options),
            "fogline run --resume run.lcm --transport memq --external driver --external acc "
            "--pace 0.5 --stall-timeout 5.5 --restarts 0 --wait 0 --same-build --no-verify "
            "--key key --faults loss=0.1");
  options = OnlyLog();
  options.verify = true;
  EXPECT_EQ(CommandToGoOn(options), "fogline run --resume run.lcm --verify");
}

TEST_F(CommandToGoOnTest, PlacesTheRolesOnTheSameMachines) {
  RunOptions options = OnlyLog();
  options.hosts = hosts::MakePlan({.on = {"fusion=anna@lab2"}, .ssh = "ssh -4"});
  EXPECT_EQ(CommandToGoOn(options),
            "fogline run --resume run.lcm --on 'fusion=anna@lab2' --ssh 'ssh -4'");
}

TEST_F(CommandToGoOnTest, QuotesWordsForAShell) {
  RunOptions options = OnlyLog();
  options.log = "my run's log.lcm";
  options.transport = "udpm://239.255.76.67:7700?ttl=0";
  EXPECT_EQ(CommandToGoOn(options), R"(fogline run --resume 'my run'\''s log.lcm' --lcm-url )"
                                    R"('udpm://239.255.76.67:7700?ttl=0')");
}

TEST_F(CommandToGoOnTest, NamesTheTransportIfTheEnvironmentNamesAnother) {
  environment_.Set("udpm://239.255.76.67:7701?ttl=0");
  EXPECT_EQ(CommandToGoOn(OnlyLog()), "fogline run --resume run.lcm --transport udpm");
}

TEST_F(CommandToGoOnTest, IsNoneWithoutALogOrInRealTime) {
  EXPECT_EQ(CommandToGoOn({}), "");
  RunOptions options = OnlyLog();
  options.realtime = true;
  EXPECT_EQ(CommandToGoOn(options), "");
}

TEST(UnfinishedLogTextTest, TellsWhatARunHasLeft) {
  const ScratchFolder folder;
  RunOptions options = Direct(folder.File("run.lcm"));
  EXPECT_EQ(UnfinishedLogText(1, options), "no log was written");
  runner::RunScenario(Paper(10), options);
  const std::int64_t run_id = ReadToTheEnd(options.log).run_id;
  const std::string log = "the log so far: " + options.log.string();
  EXPECT_EQ(UnfinishedLogText(run_id, options), log);
  options.command_to_go_on = "COMMAND";
  EXPECT_EQ(UnfinishedLogText(run_id, options), log + "\n  to go on: COMMAND");
  EXPECT_EQ(UnfinishedLogText(run_id + 1, options), "no log was written")
      << "an older log is another run's";
  options.log.clear();
  EXPECT_EQ(UnfinishedLogText(run_id, options), "");
}

}  // namespace
}  // namespace fogline::test
