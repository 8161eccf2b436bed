// A process of a run is killed while the system cannot start this process again: the program is
// missing, or the user may not start another process. One test kills the relay of a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "common/clock.h"
#include "services/graph.h"
#include "tests/support/children.h"
#include "tests/support/command.h"
#include "tests/support/machine.h"

namespace fogline::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Runs of the paper's scenario, five times as fast as real time (--pace 5). An undisturbed run
/// takes 10 s.
class StartAgainTest : public testing::Test {
 protected:
  std::vector<std::string> Run(const std::string& fogline, const std::vector<std::string>& more) {
    std::vector<std::string> command{
        fogline, "run", "scenario/paper.json", "--json", "--log", log(), "--pace", "5"};
    // On a busy machine a new process may need more than 4 s, which is the usual limit.
    if (std::ranges::find(more, "--stall-timeout") == more.end()) {
      command.insert(command.end(), {"--stall-timeout", "30"});
    }
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  std::string log() const { return folder_.File("run.lcm"); }
  /// Makes an installation of Fogline that the test can change.
  void MakeInstallation() const {
    fs::create_directory(folder_.File("bin"));
    fs::copy_file(Program("fogline"), folder_.File("bin/fogline"));
    for (const RoleInfo& info : kRoles) {
      const std::string name = "fogline-" + std::string(info.name);
      fs::create_symlink(Program(name), folder_.File("bin/" + name));
    }
  }

  /// Expects that the run has the result of an undisturbed run and reports one restart of the
  /// process.
  static void ExpectSameResult(Background& run, const std::string& role) {
    ASSERT_EQ(run.Wait(), 0) << run.Err();
    const auto result = nlohmann::json::parse(run.Out());
    const Outcome direct = RunCommand(
        {Program("fogline"), "run", "scenario/paper.json", "--json", "--transport", "direct"});
    EXPECT_EQ(result["digest"], nlohmann::json::parse(direct.out)["digest"]);
    ASSERT_EQ(result["restarts"].size(), 1U) << result["restarts"];
    EXPECT_EQ(result["restarts"][0]["role"], role);
    EXPECT_EQ(result["restarts"][0]["count"], 1);
    EXPECT_THAT(result["restarts"][0]["last"].get<std::string>(),
                HasSubstr("was killed by signal 9 (Killed) at step "));
    EXPECT_THAT(run.Err(), HasSubstr(role + " (pid "));
  }
  /// Waits for longer than the first five tries to start the process again. The first try comes 10
  /// ms after the end of the process. The other tries come after another 20, 40, 80 and 160 ms
  /// (RestartPolicy). The test waits for a fixed time because the runner does not report a failed
  /// try.
  static void StayAway() { std::this_thread::sleep_for(milliseconds(500)); }

  ScratchFolder folder_;
};

TEST_F(StartAgainTest, WaitsForAProgramThatIsBeingReplaced) {
  MakeInstallation();
  Background run(Run(folder_.File("bin/fogline"), {}));
  ASSERT_TRUE(GrowsTo(20'000, log())) << run.Err();
  // WHEN a role is killed while its program is missing
  fs::rename(folder_.File("bin/fogline-fusion"), folder_.File("bin/away"));
  kill(PidOf(run.Err(), "fusion"), SIGKILL);
  StayAway();
  fs::rename(folder_.File("bin/away"), folder_.File("bin/fogline-fusion"));
  ExpectSameResult(run, "fusion");
}

TEST_F(StartAgainTest, EndsTheRunByTheStallTimeoutAndSaysWhatWillNotStart) {
  MakeInstallation();
  const std::string fusion = folder_.File("bin/fogline-fusion");
  // The error must name the fusion. If a busy machine gave another role no processor time for 1 s
  // at the end of the run, the error may name this other role. Then the test tries again.
  constexpr int kTries = 3;
  std::string err;
  for (int i = 0; i < kTries && err.find("from fusion (last heard: step ") == err.npos; ++i) {
    Background run(Run(folder_.File("bin/fogline"), {"--stall-timeout", "5"}));
    ASSERT_TRUE(GrowsTo(20'000, log())) << run.Err();
    fs::rename(fusion, folder_.File("bin/away"));
    kill(PidOf(run.Err(), "fusion"), SIGKILL);
    EXPECT_EQ(run.Wait(), 3);
    fs::rename(folder_.File("bin/away"), fusion);
    fs::remove(log());
    err = run.Err();
  }
  EXPECT_THAT(err, HasSubstr("from fusion (last heard: step "));
  EXPECT_THAT(err, HasSubstr("; cannot start " + fusion + ": No such file or directory\n"));
}

TEST_F(StartAgainTest, WaitsForRoomForAProcess) {
  if (geteuid() != 0) return MachineLacks("root, to be a user with a limit of processes");
  // GIVEN a run under a user id that no other process has. The test then lets this user start no
  // more processes
  fs::permissions(folder_.path(), fs::perms::all);
  const std::string user = "4" + std::to_string(getpid() % 100'000);
  const std::vector<std::string> as_user{"setpriv", "--reuid", user,
                                         "--regid", user,      "--clear-groups"};
  std::vector<std::string> command = as_user;
  const auto rest = Run(Program("fogline"), {});
  command.insert(command.end(), rest.begin(), rest.end());
  Background run(command);
  ASSERT_TRUE(GrowsTo(20'000, log())) << run.Err();
  const auto limit = [&](const std::string& processes) {
    std::vector<std::string> prlimit = as_user;
    prlimit.insert(prlimit.end(),
                   {"prlimit", "--pid", std::to_string(run.pid()), "--nproc=" + processes + ":"});
    const Outcome outcome = RunCommand(prlimit);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  };
  rlimit before{};
  getrlimit(RLIMIT_NPROC, &before);
  limit("1");
  // WHEN a role is killed, and the user may start processes again half a second later
  kill(PidOf(run.Err(), "fusion"), SIGKILL);
  StayAway();
  limit(before.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(before.rlim_cur));
  ExpectSameResult(run, "fusion");
}

/// The child of `parent` that runs the program `name`, 0 if there is none.
pid_t ChildNamed(pid_t parent, const std::string& name) {
  for (const pid_t child : ChildrenOf(parent)) {
    std::ifstream in("/proc/" + std::to_string(child) + "/cmdline");
    std::string program;
    std::getline(in, program, '\0');
    if (fs::path(program).filename() == name) return child;
  }
  return 0;
}

TEST_F(StartAgainTest, TheRelayOfARunIsStartedAgainWhereItWas) {
  Background run(Run(Program("fogline"), {"--transport", "tcpq"}));
  ASSERT_TRUE(GrowsTo(20'000, log())) << run.Err();
  const pid_t relay = ChildNamed(run.pid(), "fogline-relay");
  ASSERT_NE(relay, 0);
  kill(relay, SIGKILL);
  ExpectSameResult(run, "relay");
  EXPECT_THAT(run.Err(), HasSubstr("relay (pid " + std::to_string(relay) +
                                   ") was killed by signal 9 (Killed) at step "));
}

}  // namespace
}  // namespace fogline::test
