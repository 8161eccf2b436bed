// Roles that are built outside of this tree replace ours: a program that knows only the message
// types (bare_driver.cc), and a class that uses Fogline's own runtime (my_driver.cc).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <deque>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "services/log/run_log.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// The name of the requester in the RESEND messages of this test.
constexpr const char* kTest = "test";

/// A folder outside of the tree with an installed Fogline. The external drivers are built only
/// against this installation.
class Elsewhere {
 public:
  Elsewhere() {
    Must({"cmake", "--install", FOGLINE_BINARY_DIR, "--prefix", folder_.File("fogline")});
    std::filesystem::copy(SourceDirectory() / "tests/integration/external_driver",
                          folder_.path() / "driver");
  }

  /// Builds bare_driver.cc with the compiler alone. @return the program's path
  /// @param other_types a folder of message types that take precedence over the installed ones
  std::string BareDriver(const std::string& other_types = "") const {
    const std::string program = folder_.File(other_types.empty() ? "bare" : "bare_other_types");
    std::vector<std::string> command{"c++", "-O2", "-ffp-contract=off", "-Wall", "-Wextra"};
    if (!other_types.empty()) command.insert(command.end(), {"-I", other_types});
    command.insert(command.end(), {"-I", folder_.File("fogline/include"),
                                   folder_.File("driver/bare_driver.cc"), "-llcm", "-o", program});
    Must(command);
    return program;
  }

  /// Builds my_driver.cc with CMake and find_package(fogline). @return the program's path
  std::string MyDriver() const {
    ConfigureMyDriver();
    Must({"cmake", "--build", folder_.File("driver/build")});
    return folder_.File("driver/build/my_driver");
  }

  /// The static libraries that the build of my_driver.cc names in a command.
  std::set<std::string> LibrariesOfMyDriver() const {
    ConfigureMyDriver();
    const Outcome commands =
        RunCommand({"ninja", "-C", folder_.File("driver/build"), "-t", "commands", "my_driver"});
    EXPECT_EQ(commands.code, 0) << commands.err;
    static const std::regex archive("[^ /]+\\.a\\b");
    std::set<std::string> libraries;
    for (std::sregex_iterator at(commands.out.begin(), commands.out.end(), archive), end; at != end;
         ++at) {
      libraries.insert(at->str());
    }
    return libraries;
  }

  /// Makes C++ message types in which lidar_t has one field more than in this tree. @return their
  /// folder
  std::string OtherTypes() const {
    std::ifstream in(SourceDirectory() / "lcmtypes/lidar_t.lcm");
    std::ostringstream text;
    text << in.rdbuf();
    std::string type = text.str();
    type.insert(type.rfind('}'), "  double wavelength_m;\n");
    std::ofstream(folder_.File("lidar_t.lcm")) << type;
    Must({"lcm-gen", "-x", "--cpp-std", "c++11", "--cpp-hpath", folder_.File("types"),
          folder_.File("lidar_t.lcm")});
    return folder_.File("types");
  }

  /// The path of an installed program.
  std::string Installed(const std::string& name) const {
    return folder_.File("fogline/bin/" + name);
  }
  std::string File(const std::string& name) const { return folder_.File(name); }

 private:
  void ConfigureMyDriver() const {
    Must({"cmake", "-S", folder_.File("driver"), "-B", folder_.File("driver/build"), "-G", "Ninja",
          "-DCMAKE_PREFIX_PATH=" + folder_.File("fogline")});
  }

  static void Must(const std::vector<std::string>& command) {
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 0) << testing::PrintToString(command) << "\n"
                               << outcome.out << outcome.err;
  }

  ScratchFolder folder_;
};

/// The command line of `fogline run scenario/paper.json` with an external driver.
std::vector<std::string> RunWithExternalDriver(const std::string& fogline, const std::string& url,
                                               const std::string& log) {
  return {fogline, "run", "scenario/paper.json", "--external", "driver", "--json", "--lcm-url", url,
          "--log", log};
}

/// The result of a whole run with this driver. The driver must exit with code 0 after the run.
nlohmann::json RunWith(const std::string& fogline, std::vector<std::string> driver,
                       const std::string& url, const std::string& log) {
  Background external(driver);
  const Outcome run = RunCommand(RunWithExternalDriver(fogline, url, log));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(external.Wait(), 0) << external.Err();
  return nlohmann::json::parse(run.out, nullptr, false);
}

/// A bare driver that listens for a run.
class ListeningDriver {
 public:
  ListeningDriver(const std::string& program, const std::string& url) : process_({program, url}) {
    EXPECT_TRUE(process_.WaitForOut("waiting for a run")) << process_.Err();
  }
  Background& process() { return process_; }
  std::string pid() const { return std::to_string(process_.pid()); }

 private:
  Background process_;
};

/// The messages of other processes on one channel.
template <class M>
class Heard {
 public:
  explicit Heard(runtime::Bus& bus) : bus_(bus) {
    bus.Subscribe(ChannelOf<M>().name, [this](runtime::Bytes bytes) {
      M message{};
      EXPECT_TRUE(runtime::Decode(bytes, message));
      if constexpr (std::is_same_v<M, resend_t>) {
        if (message.requester == kTest) return;
      }
      messages_.push_back(std::move(message));
    });
  }

  /// Waits for the next message. @throws std::runtime_error if none comes
  M WaitForNext() {
    const TimePoint end = Clock::now() + kPatience;
    while (messages_.empty() && Clock::now() < end) bus_.Wait(milliseconds(100));
    if (messages_.empty()) throw std::runtime_error("no message came");
    M message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }

 private:
  runtime::Bus& bus_;
  std::deque<M> messages_;
};

template <class M>
void Say(runtime::Bus& bus, const M& message) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  bus.Publish(ChannelOf<M>().name, bytes);
}

TEST(SwapTest, APartWithNothingButTheMessageTypesGivesTheSameDigestIfItDoesTheSameArithmetic) {
  const Elsewhere elsewhere;
  const std::string bare = elsewhere.BareDriver();
  const std::string fogline = Program("fogline");
  const std::string url = runtime::FreshMulticastUrl();
  // GIVEN a run with our own driver and a time gap of 1.6 s
  const Outcome outcome =
      RunCommand({fogline, "run", "scenario/paper.json", "--transport", "direct", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto ours = nlohmann::json::parse(outcome.out);
  // WHEN the bare driver replaces our driver
  const auto same = RunWith(fogline, {bare, url, "1.6"}, url, elsewhere.File("same.lcm"));
  // THEN the digest is the same
  EXPECT_EQ(same["steps"], 500);
  EXPECT_EQ(same["digest"], ours["digest"]);
  // AND a driver with another time gap gives another digest
  const auto other = RunWith(fogline, {bare, url, "1.2"}, url, elsewhere.File("other.lcm"));
  EXPECT_EQ(other["steps"], 500);
  EXPECT_NE(other["digest"], ours["digest"]);
}

TEST(SwapTest, AClassWithAStepFunctionIsARoleByFindPackageAlone) {
  const Elsewhere elsewhere;
  const std::string driver = elsewhere.MyDriver();
  const std::string url = runtime::FreshMulticastUrl();
  const std::string log = elsewhere.File("run.lcm");
  const auto run = RunWith(elsewhere.Installed("fogline"), {driver, "--lcm-url", url}, url, log);
  EXPECT_EQ(run["steps"], 500);
  // THEN every command in the log equals the command that this driver computes from the TRUTH of
  // its step
  log::RunLogReader reader(log);
  truth_t truth{};
  driver_command_t command{};
  while (const log::StepMessages* step = reader.Next()) {
    ASSERT_TRUE(runtime::Decode((*step)[IndexOf<truth_t>()], truth));
    ASSERT_TRUE(runtime::Decode((*step)[IndexOf<driver_command_t>()], command));
    const double gap_error_m = truth.host_gap_m - (2.0 + 1.2 * truth.host_speed_mps);
    const double closing_speed_mps = truth.host_speed_mps - truth.preceding_speed_mps;
    ASSERT_EQ(command.acceleration_mps2, 0.125 * gap_error_m - 0.5 * closing_speed_mps);
  }
  EXPECT_EQ(reader.run().steps, 500);
}

// The message types consist of headers only, so the program links no library of message types.
TEST(SwapTest, ARoleFromElsewhereLinksOnlyTheRuntimeAndWhatTheRuntimeUses) {
  const Elsewhere elsewhere;
  EXPECT_THAT(elsewhere.LibrariesOfMyDriver(),
              ElementsAre("libfogline_common.a", "libfogline_runtime.a", "libfogline_scenario.a",
                          "libfogline_wire.a"));
}

TEST(SwapTest, TheBareDriverAnswersRepairsAndLeavesAsARoleMust) {
  const Elsewhere elsewhere;
  runtime::Bus bus(runtime::FreshMulticastUrl());
  Heard<status_t> status(bus);
  Heard<driver_command_t> commands(bus);
  Heard<resend_t> requests(bus);
  ListeningDriver driver(elsewhere.BareDriver(), bus.url());
  const auto say_run = [&](std::int64_t run_id, std::int8_t phase) {
    run_t run = runtime::MakeRunPart(run_id, phase, 0, runtime::HashOf("{}"),
                                     runtime::SplitScenario("{}"), 0);
    run.num_external = 1;  // the run waits for a driver
    run.external = {"driver"};
    run.holder = {0};
    Say(bus, run);
  };
  const auto say_truth = [&](std::int64_t run_id, std::int64_t step) {
    truth_t truth{};
    truth.header = {.run_id = run_id, .step = step, .utime = 0};
    truth.host_gap_m = 40;
    truth.host_speed_mps = 20;
    Say(bus, truth);
  };
  const auto ask_for_command = [&](std::int64_t step) {
    resend_t resend{};
    resend.header = {.run_id = 7, .step = step, .utime = 0};
    resend.channel = "DRIVER_COMMAND";
    resend.requester = kTest;
    Say(bus, resend);
  };
  // WHEN run 7 is announced, THEN the driver is ready for it
  say_run(7, run_t::PREPARE);
  const status_t ready = status.WaitForNext();
  EXPECT_EQ(ready.header.run_id, 7);
  EXPECT_EQ(ready.state, status_t::READY);
  EXPECT_EQ(ready.scenario_hash, runtime::HashOf("{}"));
  EXPECT_EQ(ready.type_fingerprint, TypeFingerprint());
  // WHEN a step of another run comes, and a step of run 7 comes twice, THEN the driver answers once
  say_truth(8, 0);
  say_truth(7, 0);
  say_truth(7, 0);
  const driver_command_t first = commands.WaitForNext();
  EXPECT_EQ(first.header.run_id, 7);
  EXPECT_EQ(first.header.step, 0);
  say_truth(7, 1);
  EXPECT_EQ(commands.WaitForNext().header.step, 1);
  // WHEN a process asks for an answer again, THEN the driver repeats the answer
  ask_for_command(0);
  const driver_command_t again = commands.WaitForNext();
  EXPECT_EQ(again.header.step, 0);
  EXPECT_EQ(again.acceleration_mps2, first.acceleration_mps2);
  // WHEN a process asks for the driver's answer to a step, and the driver has no TRUTH of this
  // step, THEN the driver asks for this TRUTH
  ask_for_command(2);
  const resend_t request = requests.WaitForNext();
  EXPECT_EQ(request.channel, "TRUTH");
  EXPECT_EQ(request.header.step, 2);
  // WHEN another run stops, THEN the driver does not exit
  say_run(8, run_t::STOP);
  say_truth(7, 2);
  EXPECT_EQ(commands.WaitForNext().header.step, 2);
  // WHEN the driver's own run stops, THEN the driver exits
  say_run(7, run_t::STOP);
  EXPECT_EQ(driver.process().Wait(), 0);
}

TEST(SwapTest, APartThatDiesEndsTheRunByTheStallTimeoutAndByItsName) {
  const Elsewhere elsewhere;
  std::string err;
  // The error must say that the arbitrator waits for the driver. If a busy machine gave another
  // role no processor time for 1 s at the end of the run, the error may name this other role. Then
  // the test tries again.
  constexpr int kTries = 3;
  const auto names_another = [&err] {
    return err.find("is silent (last heard") != err.npos ||
           err.find("from arbitrator (last heard") != err.npos;
  };
  for (int i = 0; i < kTries && (i == 0 || names_another()); ++i) {
    runtime::Bus bus(runtime::FreshMulticastUrl());
    Heard<driver_command_t> commands(bus);
    // GIVEN a run at real speed that is under way
    ListeningDriver driver(elsewhere.BareDriver(), bus.url());
    auto command = RunWithExternalDriver(Program("fogline"), bus.url(), elsewhere.File("run.lcm"));
    command.insert(command.end(), {"--force", "--pace", "1", "--stall-timeout", "6"});
    Background run(command);
    EXPECT_TRUE(
        run.WaitForErr("waiting for the driver (60 s): start it with: fogline-driver --lcm-url "));
    while (commands.WaitForNext().header.step < 10) {
    }
    // WHEN the driver is killed
    driver.process().Signal(SIGKILL);
    // THEN the run ends and says in one line which role waited for the driver, and in which step
    EXPECT_EQ(run.Wait(), 3);
    err = run.Err();
  }
  static const std::regex kLine(
      "fogline run: error: step ([0-9]+): arbitrator waits for DRIVER_COMMAND from driver "
      "\\(last heard: step ([0-9]+), [0-9]+\\.[0-9] s ago\\)\n");
  std::smatch line;
  ASSERT_TRUE(std::regex_search(err, line, kLine)) << err;
  EXPECT_EQ(std::stoi(line[1]), std::stoi(line[2]) + 1);
  // AND the log has the complete steps
  log::RunLogReader reader(elsewhere.File("run.lcm"));
  while (reader.Next() != nullptr) {
  }
  EXPECT_EQ(reader.run().steps, std::stoi(line[1]));
}

TEST(SwapTest, OfTwoProcessesOfOneRoleOneDrivesAndTheOtherLeavesTheRunAlone) {
  const Elsewhere elsewhere;
  const std::string bare = elsewhere.BareDriver();
  const std::string url = runtime::FreshMulticastUrl();
  ListeningDriver one(bare, url);
  ListeningDriver two(bare, url);
  // The run takes 12.5 s. So the run has not ended even if a busy machine starts one of the drivers
  // late.
  auto command = RunWithExternalDriver(Program("fogline"), url, elsewhere.File("run.lcm"));
  command.insert(command.end(), {"--pace", "4"});
  const Outcome run = RunCommand(command);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, testing::AnyOf(HasSubstr("the driver has come (pid " + one.pid() + " on "),
                                      HasSubstr("the driver has come (pid " + two.pid() + " on ")));
  EXPECT_EQ(one.process().Wait(), 0);
  EXPECT_EQ(two.process().Wait(), 0);
}

TEST(SwapTest, APartThatWasBuiltWithOtherMessageTypesIsRefusedByName) {
  const Elsewhere elsewhere;
  const std::string url = runtime::FreshMulticastUrl();
  // GIVEN a driver that never reads a lidar_t, but was built with a lidar_t that has one field more
  ListeningDriver driver(elsewhere.BareDriver(elsewhere.OtherTypes()), url);
  const Outcome run =
      RunCommand(RunWithExternalDriver(Program("fogline"), url, elsewhere.File("run.lcm")));
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("error: driver (pid " + driver.pid() + " on "));
  EXPECT_THAT(run.err, HasSubstr(") was built with other message types"));
  EXPECT_EQ(driver.process().Wait(), 0) << "told to leave";
}

}  // namespace
}  // namespace fogline::test
