// A run in real time reports which roles have real-time priority.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sched.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "services/graph.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/realtime/not_whole.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The beginning of a command line for an ordinary user. Such a user lacks the capabilities and
/// limits by which the kernel grants real-time priority.
std::vector<std::string> WithoutPriority() {
  std::vector<std::string> command{"prlimit", "--rtprio=0", "--memlock=8388608"};
  if (geteuid() == 0) {
    command.insert(command.end(), {"setpriv", "--bounding-set=-sys_nice,-ipc_lock",
                                   "--inh-caps=-sys_nice,-ipc_lock"});
  }
  return command;
}

std::vector<std::string> Realtime(const ScratchFolder& folder) {
  return {Program("fogline"),
          "run",
          "scenario/paper.json",
          "--realtime",
          "--speed",
          "5",
          "--json",
          "--set",
          "/steps=60",
          "--transport",
          "udpm",
          "--log",
          folder.File("run.lcm")};
}

TEST(PriorityInRealtimeTest, IsSaidToBeMissingAtTheStartAndInTheResult) {
  const ScratchFolder folder;
  std::vector<std::string> command = WithoutPriority();
  for (const std::string& word : Realtime(folder)) command.push_back(word);
  const Outcome run = RunCommand(command);
  if (run.code != 0) {  // on a busy machine the recorder may lack messages without the priority
    ASSERT_EQ(run.code, kFailed) << run.err;
    ASSERT_THAT(run.err, HasSubstr(kNotWhole));
  }
  EXPECT_THAT(run.err,
              HasSubstr("warning: without real-time priority: world, radar, lidar, fusion, "
                        "acc, driver, arbitrator, follower, recorder. On a busy machine "
                        "steps begin late; `fogline doctor` says how to grant it\n"));
  const json priority = json::parse(run.out)["realtime"]["priority"];
  EXPECT_EQ(priority["refused"].size(), kRoles.size());
  EXPECT_TRUE(priority["granted"].empty());
  // AND the verbs that read the log later report the same
  const std::string log = folder.File("run.lcm");
  const json metrics = json::parse(RunCommand({Program("fogline"), "metrics", log, "--json"}).out);
  EXPECT_EQ(metrics[0]["realtime"]["priority"], priority);
  const json events = json::parse(RunCommand({Program("fogline"), "events", log, "--json"}).out);
  EXPECT_EQ(events[0]["priority"], priority);
  EXPECT_THAT(RunCommand({Program("fogline"), "events", log}).out,
              HasSubstr("  without real-time priority: world, radar, "));
  // AND doctor reports the missing priority, with a recipe
  std::vector<std::string> examine = WithoutPriority();
  examine.insert(examine.end(), {Program("fogline"), "doctor", "--json"});
  const json document = json::parse(RunCommand(examine).out);
  json finding;
  for (const json& one : document["findings"]) {
    if (finding.is_null() && one["check"] == "realtime_priority") finding = one;
  }
  EXPECT_EQ(finding["level"], "warning") << finding;
  EXPECT_THAT(finding["recipes"][0]["script"].get<std::string>(), HasSubstr(" - rtprio 10\n"));
}

TEST(PriorityInRealtimeTest, IsSaidToBeThereIfTheKernelGrantsIt) {
  const sched_param wanted{.sched_priority = 1};
  const sched_param usual{};
  if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) != 0) {
    GTEST_SKIP() << "the kernel grants no real-time priority to this test";
  }
  sched_setscheduler(0, SCHED_OTHER, &usual);
  const ScratchFolder folder;
  const Outcome run = RunCommand(Realtime(folder));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("with real-time priority: world, radar, "));
  EXPECT_EQ(json::parse(run.out)["realtime"]["priority"]["granted"].size(), kRoles.size());
}

TEST(PriorityInRealtimeTest, IsMissedByARoleThatAPersonHasStarted) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  std::vector<std::string> command = WithoutPriority();
  command.insert(command.end(), {Program("fogline-driver"), "--lcm-url", url});
  Background driver(command);
  // Without the priority the driver may be late. This does no harm, because the recorder can ask
  // again for the driver's messages of the last 32 steps. At this speed these steps take 3.2 s.
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--realtime",
                                  "--set", "/steps=60", "--lcm-url", url, "--external", "driver",
                                  "--log", folder.File("run.lcm")});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("warning: without real-time priority: driver. On a busy"));
  EXPECT_EQ(driver.Wait(), 0);
  EXPECT_THAT(driver.Err(), HasSubstr("fogline-driver: the kernel grants no real-time priority"));
}

}  // namespace
}  // namespace fogline::test
