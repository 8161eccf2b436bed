// Tests of the driver in Python that docs/protocol.md shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"
#include "tests/support/pages.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

// This script runs a program with sockets that lose a fifth of the received packets.
constexpr const char* kLossy = R"(import random, runpy, socket, sys
class Lossy(socket.socket):
    lost = 0
    def recv(self, size):
        while True:
            packet = super().recv(size)
            if random.random() >= 0.2:
                return packet
            Lossy.lost += 1
socket.socket = Lossy
del sys.argv[0]
runpy.run_path(sys.argv[0], run_name="__main__")
print("lost", Lossy.lost)
)";

/// The Python program that docs/protocol.md shows.
std::string ProgramOfThePage() {
  return FenceOf(Content(SourceDirectory() / "docs/protocol.md"), "python");
}

/// A folder with the driver program of docs/protocol.md and the message types that it needs, and a
/// network.
class PythonDriverTest : public testing::Test {
 protected:
  PythonDriverTest() {
    std::ofstream(folder_.File("driver.py")) << ProgramOfThePage();
    std::ofstream(folder_.File("lossy.py")) << kLossy;
    Words types{"lcm-gen", "-p", "--ppath", folder_.File("types")};
    for (const auto& entry : std::filesystem::directory_iterator(SourceDirectory() / "lcmtypes")) {
      if (entry.path().extension() == ".lcm") types.push_back(entry.path());
    }
    const Outcome made = RunCommand(types);
    EXPECT_EQ(made.code, 0) << made.err;
  }

  Words Python(const Words& programs) const {
    Words command{"env", "PYTHONPATH=" + folder_.File("types"), "python3"};
    for (const std::string& program : programs) command.push_back(folder_.File(program));
    command.push_back(port_);
    return command;
  }

  /// Compiles bare_driver.cc, a driver in C++ with the same arithmetic. @return the program's path
  std::string BareDriver() const {
    const std::string program = folder_.File("bare");
    const Outcome built =
        RunCommand({"c++", "-O2", "-ffp-contract=off", "-I", FOGLINE_BINARY_DIR "/lcmtypes/cpp",
                    SourceDirectory() / "tests/integration/external_driver/bare_driver.cc", "-llcm",
                    "-o", program});
    EXPECT_EQ(built.code, 0) << built.err;
    return program;
  }

  Words Run(const Words& more = {}) const {
    Words command{Program("fogline"),
                  "run",
                  "scenario/paper.json",
                  "--external",
                  "driver",
                  "--json",
                  "--lcm-url",
                  url_,
                  "--force",
                  "--log",
                  folder_.File("run.lcm")};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }

  /// Makes a run with this driver. The driver must end with the run. @return the result of the run
  nlohmann::json RunWith(const Words& driver, const Words& more = {}) {
    Background external(driver);
    EXPECT_TRUE(external.WaitForOut("waiting for a run")) << external.Err();
    const Outcome run = RunCommand(Run(more));
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(external.Wait(), 0) << external.Err();
    said_ = external.Out();
    return nlohmann::json::parse(run.out, nullptr, false);
  }

  const ScratchFolder folder_;
  const std::string url_ = runtime::FreshMulticastUrl();
  const std::string port_ = url_.substr(url_.rfind(':') + 1, url_.find('?') - url_.rfind(':') - 1);
  std::string said_;  // what the last driver has printed
};

TEST_F(PythonDriverTest, HasTheDigestOfTheSameDriverInCppAlsoIfEveryFifthMessageIsLost) {
  const auto cpp = RunWith({BareDriver(), url_});
  EXPECT_EQ(cpp["steps"], 500);
  const auto python = RunWith(Python({"driver.py"}));
  EXPECT_EQ(python["digest"], cpp["digest"]);
  const auto lossy =
      RunWith(Python({"lossy.py", "driver.py"}), {"--faults", "loss=0.2", "--stall-timeout", "30"});
  EXPECT_EQ(lossy["digest"], cpp["digest"]);
  EXPECT_GT(lossy["repairs"], 500) << "was anything lost?";
  // The driver, too, has lost messages.
  EXPECT_GT(std::stoi(said_.substr(said_.find("lost ") + 5)), 500) << said_;
}

TEST_F(PythonDriverTest, ThatIsKilledIsReplacedInTheMiddleOfTheRun) {
  const auto whole = RunWith(Python({"driver.py"}));
  // GIVEN a run of 500 steps that takes at least 5 s
  Background run(Run({"--pace", "10", "--stall-timeout", "30"}));
  {
    Background first(Python({"driver.py"}));
    // WHEN the driver is killed after some steps were logged, and another driver is started
    ASSERT_TRUE(GrowsTo(100'000, folder_.File("run.lcm"))) << run.Err();
    first.Signal(SIGKILL);
    first.Wait();
  }
  Background second(Python({"driver.py"}));
  // THEN the run has the same result
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(nlohmann::json::parse(run.Out())["digest"], whole["digest"]);
  EXPECT_EQ(second.Wait(), 0) << second.Err();
}

}  // namespace
}  // namespace fogline::test
