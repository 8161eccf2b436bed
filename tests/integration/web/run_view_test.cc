// `fogline run --view` shows the run, and then its log, at one address.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/integration/web/viewed.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The command line of a run with --view, without a screen, so that no browser is opened.
std::vector<std::string> RunAndView(const std::string& program, const std::string& log,
                                    std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", program, "run",
                             "scenario/paper.json", "--view", "--json", "--log", log});
  return more;
}

// The options of a run that takes 15 minutes.
const std::vector<std::string> kUntilTheTestEndsIt{"--set", "/steps=9000", "--pace", "1"};

std::uint16_t PortIn(const std::string& err) {
  constexpr std::string_view kBefore = "view: http://127.0.0.1:";
  const std::size_t at = err.find(kBefore);
  if (at == std::string::npos) return 0;
  return static_cast<std::uint16_t>(std::stoi(err.substr(at + kBefore.size())));
}

/// Waits until the server at a port shows a log. @return its frame "log"; an empty object if this
/// takes longer than kPatience
json LogAt(std::uint16_t port) {
  const TimePoint end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    try {
      WebClient page(port);
      if (ReceiveOp(page, "hello")["mode"] == "log") return ReceiveOp(page, "log");
    } catch (const std::exception&) {  // the first server has ended, and the second has not started
    }
  }
  return json::object();
}

TEST(RunViewTest, ShowsTheRunAndThenItsLogUntilCtrlC) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  Background run(RunAndView(Program("fogline"), log, {"--set", "/steps=60", "--pace", "0.5"}));
  ASSERT_TRUE(run.WaitForErr("view: http://127.0.0.1:", kPatience)) << run.Err();
  ASSERT_TRUE(run.WaitForErr("/\n", kPatience));
  const std::uint16_t port = PortIn(run.Err());
  {
    WebClient live(port);
    EXPECT_EQ(ReceiveOp(live, "hello")["mode"], "live");
    EXPECT_EQ(ReceiveOp(live, "run")["steps"], 60);
    // The server that shows the network ends with the run.
    const std::uint16_t code = CloseCodeOf(live);
    EXPECT_TRUE(code == 1001 || code == 0) << code;  // 0: the closing frame is lost
  }
  ASSERT_TRUE(run.WaitForOut("\"digest\"", kPatience));
  // THEN a page that connects again gets the log
  EXPECT_EQ(LogAt(port)["last_step"], 59);
  EXPECT_TRUE(IsAlive(run.pid()));
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(json::parse(run.Out())["steps"], 60);
}

/// Makes links to all programs except fogline-web in a folder.
void LinkProgramsTo(const ScratchFolder& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(ProgramDirectory())) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("fogline") || name == "fogline-web") continue;
    std::filesystem::create_hard_link(entry.path(), folder.path() / name);
  }
}

TEST(RunViewTest, WaitsOneSecondForAViewerThatHangs) {
  const ScratchFolder folder;
  LinkProgramsTo(folder);
  const std::string hangs = folder.File("fogline-web");
  const std::string started = folder.File("started");
  std::ofstream(hangs) << "#!/bin/sh\n: > " << started << "\nexec sleep 600\n";
  std::filesystem::permissions(hangs, std::filesystem::perms::owner_all);
  Background run(
      RunAndView(folder.File("fogline"), folder.File("run.lcm"), {"--set", "/steps=30"}));
  const TimePoint end = Clock::now() + kPatience;
  while (!std::filesystem::exists(started) && Clock::now() < end) {
    std::this_thread::sleep_for(kLookEvery);
  }
  const TimePoint began = Clock::now();
  ASSERT_TRUE(run.WaitForErr("--view: fogline-web does not listen after 1 s", kPatience));
  EXPECT_LT(Clock::now() - began, milliseconds(9000));
  EXPECT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(json::parse(run.Out())["steps"], 30);
  EXPECT_THAT(run.Err(), HasSubstr("--view: fogline-web does not listen; the run"));
}

TEST(RunViewTest, PrintsTheAddressOfAViewerThatIsSlow) {
  const ScratchFolder folder;
  LinkProgramsTo(folder);
  const std::string slow = folder.File("fogline-web");
  const std::string go = folder.File("go");
  std::ofstream(slow) << "#!/bin/sh\nwhile [ ! -e " << go << " ]; do sleep 0.1; done\nexec "
                      << Program("fogline-web") << " \"$@\"\n";
  std::filesystem::permissions(slow, std::filesystem::perms::owner_all);
  Background run(RunAndView(folder.File("fogline"), folder.File("run.lcm"), kUntilTheTestEndsIt));
  ASSERT_TRUE(run.WaitForErr("does not listen after 1 s", kPatience)) << run.Err();
  std::ofstream(go) << "now";
  ASSERT_TRUE(run.WaitForErr("view: http://127.0.0.1:", kPatience)) << run.Err();
  ASSERT_TRUE(run.WaitForErr("/\n", kPatience));
  WebClient live(PortIn(run.Err()));
  EXPECT_EQ(ReceiveOp(live, "run")["steps"], 9000);
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130) << run.Err();
}

TEST(RunViewTest, ShowsTheLogOfARunThatFails) {
  const ScratchFolder folder;
  std::vector<std::string> options = kUntilTheTestEndsIt;
  options.insert(options.end(), {"--restarts", "0"});
  Background run(RunAndView(Program("fogline"), folder.File("run.lcm"), options));
  ASSERT_TRUE(run.WaitForErr("/\n", kPatience)) << run.Err();
  const std::uint16_t port = PortIn(run.Err());
  {
    WebClient live(port);
    EXPECT_EQ(ReceiveOp(live, "run")["steps"], 9000);
    ReceiveKind(live, 1);
  }
  ASSERT_TRUE(GrowsTo(20'000, folder.File("run.lcm")));
  const pid_t radar = PidOf(run.Err(), "radar");
  ASSERT_GT(radar, 0) << run.Err();
  kill(radar, SIGKILL);
  ASSERT_TRUE(run.WaitForErr("fogline run: error: ", kPatience)) << run.Err();
  EXPECT_FALSE(LogAt(port)["complete"]);
  EXPECT_TRUE(IsAlive(run.pid()));
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 3) << run.Err();
}

TEST(RunViewTest, RunsWithoutAViewerThatCannotBeStarted) {
  // GIVEN the programs without fogline-web
  const ScratchFolder folder;
  LinkProgramsTo(folder);
  // WHEN a run gets --view
  const Outcome run = RunCommand(
      RunAndView(folder.File("fogline"), folder.File("run.lcm"), {"--set", "/steps=30"}));
  // THEN the run reports once that fogline-web cannot be started, and does not wait
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["steps"], 30);
  const std::size_t said = run.err.find("--view: cannot start");
  ASSERT_NE(said, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("--view", said + 1), std::string::npos) << run.err;
  // The folder is no build folder, so the run does not say how to build fogline-web.
  EXPECT_THAT(run.err, HasSubstr("fogline-web: No such file or directory; the run goes on"));
}

TEST(RunViewTest, RefusesARunInOneProcess) {
  for (const char* transport : {"direct", "memq"}) {
    const Outcome run = RunCommand(
        {Program("fogline"), "run", "scenario/paper.json", "--view", "--transport", transport});
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr("error: --view: no other process can see a run"));
  }
}

}  // namespace
}  // namespace fogline::test
