// `fogline spy` starts LCM's lcm-spy with all files that it needs, on the network of the run.
// lcm_tools_test.cc tests the contents of lcm-spy's window.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "common/process/this_process.h"
#include "services/runtime/discovery/beacon.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"
#include "tests/support/screen.h"

namespace fogline::test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

/// A simulated installation of Java and of jars. Its program `java` prints the arguments of the
/// call.
class Parts {
 public:
  Parts() {
    for (const char* name : {"jdk/bin", "jdk/lib", "jars"}) {
      std::filesystem::create_directories(folder_.path() / name);
    }
    for (const char* file : {"jars/lcm.jar", "jars/jchart2d.jar", "jdk/lib/libawt_xawt.so"}) {
      Touch(file);
    }
    std::ofstream(File("jdk/bin/java")) << "#!/bin/sh\necho \"$@\"\n";
    MakeExecutable("jdk/bin/java");
  }

  void Touch(const std::string& file) const { std::ofstream(File(file)) << ""; }
  void Remove(const std::string& file) const { std::filesystem::remove(File(file)); }
  void MakeExecutable(const std::string& file) const {
    std::filesystem::permissions(File(file), std::filesystem::perms::owner_all);
  }
  std::string File(const std::string& name) const { return folder_.File(name); }

  std::vector<std::string> Command(const std::string& program,
                                   const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{"env",
                                     "JAVA_HOME=" + File("jdk"),
                                     "DISPLAY=" + screen_.display(),
                                     program,
                                     "spy",
                                     "--jars",
                                     File("jars")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
  }

 private:
  ScratchFolder folder_;
  Screen screen_;
};

TEST(SpyTest, StartsLcmsOwnWithTheTypesOfItsBuildAndTheUrl) {
  const Parts parts;
  const Outcome spy = RunCommand(
      parts.Command(Program("fogline"), {"--lcm-url", "udpm://239.255.76.67:7700?ttl=0"}));
  EXPECT_EQ(spy.code, 0) << spy.err;
  EXPECT_EQ(spy.out, "-Djava.net.preferIPv4Stack=true -cp " + parts.File("jars/lcm.jar") + ":" +
                         parts.File("jars/jchart2d.jar") +
                         ":" FOGLINE_BINARY_DIR
                         "/lib/fogline_lcmtypes.jar lcm.spy.Spy "
                         "--lcm-url=udpm://239.255.76.67:7700?ttl=0\n");
}

TEST(SpyTest, HasTheTypesOfItsInstallationToo) {
  const Parts parts;
  const ScratchFolder folder;
  const Outcome install =
      RunCommand({"cmake", "--install", FOGLINE_BINARY_DIR, "--prefix", folder.path().string()});
  ASSERT_EQ(install.code, 0) << install.err;
  const Outcome spy = RunCommand(
      parts.Command(folder.File("bin/fogline"), {"--lcm-url", runtime::FreshMulticastUrl()}));
  EXPECT_EQ(spy.code, 0) << spy.err;
  EXPECT_THAT(spy.out, HasSubstr(":" + folder.File("share/fogline/fogline_lcmtypes.jar") + " "));
}

TEST(SpyTest, RefusesFilesThatAreNotThere) {
  const Parts parts;
  const auto error = [&](const std::vector<std::string>& more) {
    const Outcome spy = RunCommand(parts.Command(Program("fogline"), more));
    EXPECT_EQ(spy.code, 2);
    return spy.err;
  };
  const std::string none = ": cannot be read: No such file or directory\n";
  EXPECT_EQ(error({"--types", parts.File("none.jar")}),
            parts.File("none.jar") + ": error: --types" + none);
  parts.Remove("jars/jchart2d.jar");
  EXPECT_EQ(error({}), parts.File("jars/jchart2d.jar") + ": error: --jars" + none);
  parts.Remove("jars/lcm.jar");
  EXPECT_EQ(error({}), parts.File("jars/lcm.jar") + ": error: --jars" + none);
}

TEST(SpyTest, NamesWhatTheMachineLacks) {
  const Parts parts;
  const auto error = [&](std::vector<std::string> more, const std::string& setting = "X=") {
    std::vector<std::string> command = parts.Command(Program("fogline"), more);
    command.insert(command.begin() + 3, setting);
    const Outcome spy = RunCommand(command);
    EXPECT_EQ(spy.code, 3) << spy.err;
    EXPECT_EQ(spy.out, "");
    EXPECT_EQ(std::ranges::count(spy.err, '\n'), 1) << spy.err;
    EXPECT_THAT(spy.err, testing::StartsWith("fogline spy: error: "));
    return spy.err;
  };
  EXPECT_THAT(error({}, "DISPLAY="), HasSubstr("no screen: DISPLAY is not set"));
  EXPECT_THAT(error({}, "DISPLAY=:99999999"), HasSubstr("no screen: DISPLAY is \":99999999\""));
  parts.Remove("jdk/lib/libawt_xawt.so");
  EXPECT_THAT(error({}), HasSubstr("cannot open windows (default-jre-headless?): apt-get install "
                                   "default-jre\n"));
  parts.Remove("jdk/bin/java");
  EXPECT_THAT(error({}), HasSubstr("there is no java: apt-get install default-jre"));
}

TEST(SpyTest, SaysHowTheTypesAreMadeWhereThereAreNone) {
  const Parts parts;
  std::filesystem::create_directory(parts.File("bin"));
  std::filesystem::copy_file(Program("fogline"), parts.File("bin/fogline"));
  std::filesystem::create_directory(parts.File("compiler"));
  const std::string build =
      "cmake -S . -B build -G Ninja && ninja -C build fogline_lcmtypes_java\n";
  const auto error = [&] {
    std::vector<std::string> command = parts.Command(parts.File("bin/fogline"), {});
    command.insert(command.begin() + 1, "PATH=" + parts.File("compiler"));
    command.front() = "/usr/bin/env";
    const Outcome spy = RunCommand(command);
    EXPECT_EQ(spy.code, 3);
    return spy.err;
  };
  EXPECT_THAT(error(), HasSubstr(": apt-get install default-jdk, then " + build));
  parts.Touch("compiler/javac");
  parts.MakeExecutable("compiler/javac");
  EXPECT_THAT(error(), HasSubstr(": " + build));
}

TEST(LogplayerTest, StartsLcmsOwnOnTheNetworkWithTheLog) {
  const Parts parts;
  std::vector<std::string> command =
      parts.Command(Program("fogline"), {"tests/integration/logs/kept/0.1.0.lcm", "--paused",
                                         "--lcm-url", "udpm://239.255.76.67:7700?ttl=0"});
  std::ranges::replace(command, std::string("spy"), std::string("logplayer"));
  const Outcome player = RunCommand(command);
  EXPECT_EQ(player.code, 0) << player.err;
  EXPECT_EQ(player.out, "-Djava.net.preferIPv4Stack=true -cp " + parts.File("jars/lcm.jar") +
                            " lcm.logging.LogPlayer --lcm-url=udpm://239.255.76.67:7700?ttl=0 "
                            "--paused tests/integration/logs/kept/0.1.0.lcm\n");
  // AND without --lcm-url the verb uses LCM_DEFAULT_URL
  command.resize(command.size() - 2);
  command.insert(command.begin() + 1, "LCM_DEFAULT_URL=udpm://239.255.76.67:7701?ttl=0");
  EXPECT_THAT(RunCommand(command).out,
              HasSubstr(" --lcm-url=udpm://239.255.76.67:7701?ttl=0 --paused "));
}

TEST(LogplayerTest, RefusesWhatItCannotPlay) {
  const auto error = [](const std::vector<std::string>& arguments) {
    std::vector<std::string> command{Program("fogline"), "logplayer"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Outcome player = RunCommand(command);
    EXPECT_EQ(player.code, 2);
    EXPECT_EQ(player.out, "");
    return player.err;
  };
  EXPECT_THAT(error({"scenario/paper.json"}), testing::StartsWith("scenario/paper.json: error: "));
  EXPECT_THAT(error({"none.lcm"}), testing::StartsWith("none.lcm: error: "));
  EXPECT_THAT(error({"none.lcm", "--lcm-url", "file://x"}),
              HasSubstr("error: --lcm-url file://x: no LCM URL such as"));
}

/// In these tests LCM_DEFAULT_URL is an address that only the test uses. Programs that get no URL
/// use this address.
class SpyAtMeetingTest : public testing::Test {
 protected:
  SpyAtMeetingTest() { EXPECT_EQ(setenv("LCM_DEFAULT_URL", url_.c_str(), 1), 0); }
  ~SpyAtMeetingTest() override { unsetenv("LCM_DEFAULT_URL"); }

  const std::string url_ = runtime::FreshMulticastUrl();
  const Parts parts_;
};

TEST_F(SpyAtMeetingTest, WaitsForARunAndLooksWhereItIs) {
  Background spy(parts_.Command(Program("fogline"), {}));
  ASSERT_TRUE(spy.WaitForErr("waiting for a run on " + url_, kPatience)) << spy.Err();
  EXPECT_THAT(spy.Err(), HasSubstr("; start one with: fogline run SCENARIO --pace 1\n"));
  const ScratchFolder folder;
  Background run({Program("fogline"), "run", "scenario/paper.json", "--transport", "udpm", "--pace",
                  "1", "--log", folder.File("run.lcm")});
  ASSERT_EQ(spy.Wait(), 0) << spy.Err();
  ASSERT_TRUE(run.WaitForErr("processes: ", kPatience));
  const std::string err = run.Err();
  const std::size_t at = err.find(" on ") + 4;
  EXPECT_THAT(
      spy.Out(),
      testing::EndsWith(" lcm.spy.Spy --lcm-url=" + err.substr(at, err.find('\n') - at) + "\n"));
}

TEST_F(SpyAtMeetingTest, LooksAtTheNewestOfSeveralRuns) {
  runtime::Bus bus(url_);
  const auto announce = [&bus](std::int64_t run_id) {
    beacon_t beacon{};
    beacon.header.run_id = run_id;
    beacon.began_us = run_id;
    beacon.url = "udpm://239.255.76.67:" + std::to_string(7700 + run_id) + "?ttl=0";
    beacon.host = HostName();
    beacon.pid = getpid();
    std::vector<std::uint8_t> bytes;
    runtime::Encode(beacon, bytes);
    bus.Publish(runtime::kBeaconChannel, bytes);
  };
  // The announcement of the older run comes first.
  Background spy(parts_.Command(Program("fogline"), {}));
  const TimePoint end = Clock::now() + kPatience;
  while (IsAlive(spy.pid()) && Clock::now() < end) {
    for (const std::int64_t run_id : {1, 2}) announce(run_id);
    bus.Wait(milliseconds(20));
  }
  EXPECT_EQ(spy.Wait(), 0) << spy.Err();
  EXPECT_THAT(spy.Out(), HasSubstr(" --lcm-url=udpm://239.255.76.67:7702?ttl=0\n"));
}

TEST_F(SpyAtMeetingTest, LooksAtTheMeetingAddressWhereThereIsTraffic) {
  runtime::Bus bus(url_);
  Background spy(parts_.Command(Program("fogline"), {}));
  const TimePoint end = Clock::now() + kPatience;
  while (IsAlive(spy.pid()) && Clock::now() < end) {
    bus.Publish("SOMETHING", std::vector<std::uint8_t>{1});
    bus.Wait(milliseconds(20));
  }
  EXPECT_EQ(spy.Wait(), 0) << spy.Err();
  EXPECT_THAT(spy.Out(), HasSubstr(" --lcm-url=" + url_));
}

TEST_F(SpyAtMeetingTest, EndsWhenNoRunComes) {
  const Outcome spy = RunCommand(parts_.Command(Program("fogline"), {"--wait", "0.5"}));
  EXPECT_EQ(spy.code, 3);
  EXPECT_EQ(spy.out, "");
  EXPECT_THAT(spy.err, HasSubstr("fogline spy: error: waited 0.5 s for a run on " + url_));
  Background interrupted(parts_.Command(Program("fogline"), {}));
  ASSERT_TRUE(interrupted.WaitForErr("waiting for a run", kPatience));
  interrupted.Signal(SIGINT);
  EXPECT_EQ(interrupted.Wait(), 130);
}

}  // namespace
}  // namespace fogline::test
