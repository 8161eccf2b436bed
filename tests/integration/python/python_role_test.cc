// A class in Python takes a role of a run. The run has the same result as with the role in C++.
// This also holds with signatures and after the process was killed. In real time, the class takes
// part in the run, too.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <deque>

#include "services/log/run_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/integration/faults/watched_run.h"
#include "tests/integration/python/python.h"
#include "tests/integration/runs/paper_run.h"
#include "tests/support/machine.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

/// Returns the text of the Python block that contains `text`, in a Markdown page.
std::string BlockWith(const std::string& text, const std::string& page) {
  const std::string fence = "```python\n";
  const std::size_t begin = page.rfind(fence, page.find(text)) + fence.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

// A role in Python. In each step it sends the message that a log has for this step. It fails if an
// input differs from the input in the log.
constexpr const char* kReplayed = R"(
import sys
import fogline_lab as fl

name, file, *options = sys.argv[1:]
kind = next(one for one in fl.ROLES if one.ROLE == name)
log = fl.read_log(file)
channel_of = {log.type_of(channel): channel for channel in fl.STEP_CHANNELS}
recorded = {one: list(log.messages(channel_of[one])) for one in (*kind.READS, *kind.WRITES)}

class Replayed(kind):
    def start(self):
        return self.outputs(0)

    def step(self, *inputs):
        step = inputs[0].header.step
        for message in inputs:
            message.header.run_id = log.run_id
            if message != recorded[type(message)][step]:
                raise ValueError(f"{message} differs from {recorded[type(message)][step]}")
        return self.outputs(step + kind.BEGINS)

    def outputs(self, step):
        messages = tuple(recorded[one][step] for one in kind.WRITES)
        return messages if len(messages) > 1 else messages[0]

fl.serve(Replayed, options)
)";

class PythonRoleTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!PythonRunsRoles()) return MachineLacks("pybind11, so fogline_lab cannot run a role");
  }

  /// Copies the driver from the page docs/python.md. @return its file
  std::string DriverOfThePage() const {
    const std::string page = Content(SourceDirectory() / "docs/python.md");
    return WriteScript(folder_, BlockWith("fl.serve(MyDriver)", page));
  }

  /// A run of the paper's scenario with these external roles.
  std::vector<std::string> Run(const std::vector<std::string>& roles,
                               const std::vector<std::string>& more = {}) const {
    std::vector<std::string> options = more;
    for (const std::string& role : roles) options.insert(options.end(), {"--external", role});
    return PaperRun(url_, Log(), options);
  }
  std::string Log() const { return folder_.File("run.lcm"); }

  ScratchFolder folder_;
  const std::string url_ = runtime::FreshMulticastUrl();
};

using PythonRoleInRealtimeTest = PythonRoleTest;

TEST_F(PythonRoleTest, TheDriverOfThePageHasTheDigestOfFoglinesOwn) {
  Background driver(Python(DriverOfThePage(), {"--lcm-url", url_}));
  const Outcome run = RunCommand(Run({"driver"}));
  ASSERT_EQ(run.code, 0) << run.err << driver.Err();
  EXPECT_EQ(nlohmann::json::parse(run.out)["digest"], UndisturbedDigest(500, {}));
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST_F(PythonRoleTest, TheDriverOfThePageIsThatOfTheExamples) {
  EXPECT_EQ(Content(DriverOfThePage()),
            Content(SourceDirectory() / "tools/python/examples/driver.py"));
}

TEST_F(PythonRoleTest, KilledInTheMiddleAndStartedAgainItCatchesUp) {
  // GIVEN a run that lasts longer than the runner needs to notice the end of a role
  WatchedRun watched({"--external", "driver", "--stall-timeout", "60"}, 1500);
  const auto command = Python(DriverOfThePage(), {"--lcm-url", watched.url()});
  const Background first(command);
  watched.WaitForStep(100);
  watched.Signal("driver", SIGKILL);
  const Background second(command);
  const auto result = watched.ExpectSameResult();
  EXPECT_EQ(WatchedRun::RestartsOf(result, "driver"), 1) << result["restarts"];
}

TEST_F(PythonRoleTest, EveryRoleThatComputesStepsMayBeInPython) {
  const std::vector<std::string> steps{"--set", "/steps=60"};
  const std::string recorded = folder_.File("recorded.lcm");
  std::vector<std::string> direct{Program("fogline"),
                                  "run",
                                  "scenario/paper.json",
                                  "--transport",
                                  "direct",
                                  "--json",
                                  "--log",
                                  recorded};
  direct.insert(direct.end(), steps.begin(), steps.end());
  const Outcome before = RunCommand(direct);
  ASSERT_EQ(before.code, 0) << before.err;
  // WHEN each role is a process in Python
  const std::string script = WriteScript(folder_, kReplayed);
  std::vector<std::string> roles;
  std::deque<Background> processes;
  for (const RoleInfo& info : kRoles) {
    if (info.role == Role::kRecorder) continue;
    roles.emplace_back(info.name);
    processes.emplace_back(Python(script, {roles.back(), recorded, "--lcm-url", url_}));
  }
  const Outcome run = RunCommand(Run(roles, steps));
  // THEN each process has received the inputs in the log, and the run has the digest of the log
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["digest"], nlohmann::json::parse(before.out)["digest"]);
  for (Background& process : processes) EXPECT_EQ(process.Wait(), 0) << process.Err();
}

TEST_F(PythonRoleTest, SignsAndVerifiesWithAKey) {
  const std::string key = folder_.File("key");
  runtime::SigningKey::Create(key);
  const Background driver(Python(DriverOfThePage(), {"--lcm-url", url_, "--key", key}));
  const Outcome run = RunCommand(Run({"driver"}, {"--key", key}));
  ASSERT_EQ(run.code, 0) << run.err << driver.Err();
  EXPECT_EQ(nlohmann::json::parse(run.out)["digest"], UndisturbedDigest(500, {}));
}

TEST_F(PythonRoleTest, NeedsNoRouteToAGroupWhoseTrafficStaysOnTheMachine) {
  if (geteuid() != 0) return MachineLacks("root, to make a network namespace");
  // GIVEN a machine whose only interface is loopback, without a route for multicast
  if (RunCommand({"unshare", "--net", "ip", "link", "set", "lo", "up"}).code != 0) {
    return MachineLacks("network namespaces");
  }
  std::vector<std::string> both{"unshare",
                                "--net",
                                "bash",
                                "-c",
                                "ip link set lo up; script=$1; url=$2; shift 2\n"
                                "PYTHONPATH=$0 /usr/bin/python3 -B $script --lcm-url $url &\n"
                                "\"$@\"; code=$?; wait; exit $code",
                                std::string(FOGLINE_BINARY_DIR) + "/python",
                                DriverOfThePage(),
                                url_};
  const std::vector<std::string> command = Run({"driver"});
  both.insert(both.end(), command.begin(), command.end());
  const Outcome run = RunCommand(both);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["digest"], UndisturbedDigest(500, {}));
}

TEST_F(PythonRoleTest, AnExceptionEndsTheRunByItsText) {
  const std::string script = WriteScript(folder_,
                                         "import fogline_lab as fl\n"
                                         "class Hasty(fl.Driver):\n"
                                         "    def step(self, truth):\n"
                                         "        return 1 / (20 - truth.header.step)\n"
                                         "fl.serve(Hasty)\n");
  Background driver(Python(script, {"--lcm-url", url_}));
  const Outcome run = RunCommand(Run({"driver"}));
  EXPECT_EQ(run.code, 3);
  const std::string text = "step 20: Hasty.step(): ZeroDivisionError: division by zero\n";
  EXPECT_THAT(run.err, HasSubstr("error: driver: " + text));
  EXPECT_EQ(driver.Wait(), 3);
  EXPECT_THAT(driver.Err(), HasSubstr("fogline-driver: error: " + text));
  EXPECT_THAT(driver.Err(), HasSubstr("script.py\", line 4, in step"));
}

TEST_F(PythonRoleTest, ANumberThatIsNotFiniteEndsTheRunByItsField) {
  const std::string script = WriteScript(folder_,
                                         "import fogline_lab as fl\n"
                                         "class Lost(fl.Driver):\n"
                                         "    def step(self, truth):\n"
                                         "        return float('nan')\n"
                                         "fl.serve(Lost)\n");
  const Background driver(Python(script, {"--lcm-url", url_}));
  const Outcome run = RunCommand(Run({"driver"}));
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("error: driver: step 0: acceleration_mps2 of DRIVER_COMMAND is "
                                 "not a finite number\n"));
}

TEST_F(PythonRoleTest, HasTheCommandLineOfTheRole) {
  const std::string driver = DriverOfThePage();
  const Outcome help = RunCommand(Python(driver, {"--help"}));
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("--lcm-url"));
  const Outcome wrong = RunCommand(Python(driver, {"--speed", "5"}));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("fogline-driver: error: "));
}

TEST_F(PythonRoleInRealtimeTest, DrivesInEveryStep) {
  constexpr int kRealtimeSteps = 100;
  const Background driver(Python(DriverOfThePage(), {"--lcm-url", url_}));
  // At this speed a step takes 50 ms.
  const Outcome run = RunCommand(Run({"driver"}, {"--realtime", "--speed", "2", "--set",
                                                  "/steps=" + std::to_string(kRealtimeSteps)}));
  ASSERT_EQ(run.code, 0) << run.err << driver.Err();
  log::RunLogReader reader(Log());
  int commands = 0;
  while (const log::StepMessages* step = reader.Next()) {
    commands += (*step)[IndexOf<driver_command_t>()].empty() ? 0 : 1;
  }
  EXPECT_TRUE(reader.run().realtime.has_value());
  EXPECT_GE(commands, kRealtimeSteps - 2);
}

}  // namespace
}  // namespace fogline::test
