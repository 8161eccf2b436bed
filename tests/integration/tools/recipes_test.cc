// The recipes of docs/network.md, executed as the page shows them, do what the page says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "services/graph.h"
#include "services/log/event_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"
#include "tests/support/pages.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_THAT(text, HasSubstr(from));
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The messages of a channel by step.
std::map<std::int64_t, std::vector<std::uint8_t>> MessagesOf(const std::string& log,
                                                             std::string_view channel) {
  std::map<std::int64_t, std::vector<std::uint8_t>> messages;
  log::EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    if (event->channel != channel) continue;
    messages[runtime::ReadInt64(event->data, runtime::kStepOffset)].assign(event->data.begin(),
                                                                           event->data.end());
  }
  return messages;
}

class RecipesTest : public testing::Test {
 protected:
  RecipesTest() {
    std::filesystem::create_directory_symlink(SourceDirectory() / "scenario",
                                              folder_.path() / "scenario");
  }

  /// The recipe that contains the text `with`. Its run has 60 steps and a log, and uses the port of
  /// this test.
  std::string Recipe(const std::string& with) const {
    const std::string page = Content(SourceDirectory() / "docs/network.md");
    for (const Block& block : BlocksOf(page.substr(page.find("\n## Recipes\n")))) {
      if (block.text.find(with) == std::string::npos) continue;
      static const std::regex kPort("\\b770[0-9]\\b");
      const std::string lines = std::regex_replace(block.text, kPort, port_);
      const std::string run = "fogline run scenario/paper.json";
      const bool names_log = lines.find("--log ") != std::string::npos;
      return Replaced(lines, run, run + " --set /steps=60" + (names_log ? "" : " --log run.lcm"));
    }
    ADD_FAILURE() << "no recipe with " << with;
    return "false";
  }

  Outcome Shell(const std::string& script) const {
    return RunCommand({"bash", "-c",
                       "cd " + folder_.path().string() +
                           " && export PATH=" + ProgramDirectory().string() + ":$PATH\n" + script});
  }

  const ScratchFolder folder_;
  const std::string url_ = runtime::FreshMulticastUrl();
  const std::string port_ = url_.substr(url_.rfind(':') + 1, url_.find('?') - url_.rfind(':') - 1);
};

TEST_F(RecipesTest, RecordedSensorsDriveFusionAndAccWhichComputeTheSameAgain) {
  // GIVEN the lines of the page, and a player that waits until three programs listen. Then the port
  // has four sockets, because this test has a socket on the port, too
  std::string lines = Recipe("lcm-logplayer");
  char port[8];
  std::snprintf(port, sizeof(port), "%04X", std::stoi(port_));
  lines = Replaced(lines, "\nlcm-logplayer",
                   "\nuntil [ $(grep -c ':" + std::string(port) +
                       " ' /proc/net/udp) -ge 4 ]; do sleep 0.02; done\nlcm-logplayer");
  // AND a speed at which lcm-logger loses fewer messages on a busy machine
  lines = Replaced(lines, "--speed=4", "--speed=1");
  // AND a wait for the whole log. lcm-logger writes messages some time after they arrive. When it
  // ends, it drops the messages that it has not written yet
  lines = Replaced(lines, "kill $(jobs -p)",
                   "for i in $(seq 200); do"
                   " [ $(grep -ao ACC_COMMAND open.lcm | wc -l) -lt 60 ] || break; sleep 0.02;"
                   " done\nkill $(jobs -p)");
  const Outcome shell = Shell(lines);
  // THEN lcm-logger has logged messages of the running roles. These messages equal those of the run
  for (const std::string_view channel : {"TRACK", "ACC_COMMAND"}) {
    const auto recorded = MessagesOf(folder_.File("run.lcm"), channel);
    const auto again = MessagesOf(folder_.File("open.lcm"), channel);
    EXPECT_EQ(recorded.size(), 60U);
    // lcm-logger may lose messages: if more than 30 messages wait for it, it loses the newest of
    // them. So its log may have fewer than 60 messages of a channel.
    EXPECT_GT(again.size(), 10U) << shell.out << shell.err;
    for (const auto& [step, message] : again) EXPECT_EQ(message, recorded.at(step)) << step;
  }
}

TEST_F(RecipesTest, AProgramThatAsksAPersonDrivesInLockstepAtThePaceOfTheWallClock) {
  std::ofstream(folder_.File("driver.py"))
      << FenceOf(Content(SourceDirectory() / "docs/protocol.md"), "python");
  const Outcome shell = Shell("lcm-gen -p --ppath types " + SourceDirectory().string() +
                              "/lcmtypes/*.lcm\n" + Recipe("--pace 1") + "\nwait");
  EXPECT_EQ(shell.code, 0) << shell.out << shell.err;
  // 60 steps take 5.9 s of simulated time, and at least as long on the wall clock.
  std::smatch took;
  ASSERT_TRUE(std::regex_search(shell.out, took, std::regex("60 steps in ([0-9.]+) s")))
      << shell.out << shell.err;
  EXPECT_GE(std::stod(took[1]), 5.8);
}

TEST_F(RecipesTest, AllRolesButTheRecorderAreStartedByHand) {
  const Outcome shell = Shell(Recipe("$external"));
  EXPECT_EQ(shell.code, 0) << shell.out << shell.err;
  EXPECT_THAT(shell.out, HasSubstr("scenario/paper.json: 60 steps"));
  for (const RoleInfo& info : kRoles) {
    if (info.role == Role::kRecorder) continue;
    EXPECT_THAT(shell.err, HasSubstr("fogline-" + std::string(info.name) + ": waiting for a run"));
  }
}

}  // namespace
}  // namespace fogline::test
