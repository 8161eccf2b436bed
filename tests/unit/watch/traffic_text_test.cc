#include "tools/watch/traffic_text.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using testing::HasSubstr;

std::string Joined(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) text += line.text + "\n";
  return text;
}

RunView RunWithOneRole() {
  RoleView role;
  role.status.role = "fusion";
  role.status.host = "lab\033[2J";
  role.status.pid = 17;
  role.status.state = status_t::FAILED;
  role.status.foreign = 3;
  role.status.sends_failed = 5;
  role.status.send_error = "Network is unreachable";
  role.status.error = "no track";
  role.silent = true;
  RunView run;
  run.run_id = 4711;
  run.roles.push_back(role);
  return run;
}

TEST(TrafficTextTest, TellsHowToFindRunsWhileNothingArrives) {
  EXPECT_THAT(Joined(TrafficLines({}, "udpm://")), HasSubstr("fogline doctor"));
}

TEST(TrafficTextTest, SaysWhatIsWrongWithARole) {
  TrafficView view;
  view.runs.push_back(RunWithOneRole());
  const std::vector<Line> lines = TrafficLines(view, "udpm://");
  EXPECT_EQ(lines.back().style, Line::Style::kBad);
  EXPECT_THAT(lines.back().text, HasSubstr("FAILED"));
  EXPECT_THAT(lines.back().text, HasSubstr("silent; no track; refused 3 of other runs; "));
  EXPECT_THAT(lines.back().text, HasSubstr("; could not send 5 (Network is unreachable)"));
}

TEST(TrafficTextTest, PassesNoControlCharactersFromTheNetworkOn) {
  TrafficView view;
  view.runs.push_back(RunWithOneRole());
  ChannelView channel;
  channel.channel = "\033]0;title\a\xc3\xa4";
  view.others.push_back(channel);
  for (const Line& line : TrafficLines(view, "udpm://")) {
    for (const char c : line.text) EXPECT_TRUE(c >= ' ' && c <= '~') << line.text;
  }
}

TEST(TrafficTextTest, FitsTheWindowAndSaysWhatItLeavesOut) {
  const std::vector<Line> lines(10, Line{"0123456789"});
  const std::vector<Line> fitted = Fit(lines, 60, 4);
  ASSERT_EQ(fitted.size(), 4U);
  EXPECT_EQ(fitted[2].text, "0123456789");
  EXPECT_THAT(fitted[3].text, HasSubstr("7 more lines"));
  EXPECT_EQ(Fit(lines, 5, 10)[9].text, "01234");
}

TEST(TrafficTextTest, ShowsTheLossOfAChannelWithinEightyColumns) {
  TrafficView view;
  ChannelView channel;
  channel.channel = "FOLLOWER_COMMAND";
  channel.type = "follower_command_t";
  channel.steps = StepSequence::Counts{.newest = 123'456, .lost = 9876};
  RunView run;
  run.channels.push_back(channel);
  view.runs.push_back(run);
  const std::string line = TrafficLines(view, "udpm://").back().text;
  EXPECT_THAT(line.substr(0, 80), HasSubstr("9876"));
}

}  // namespace
}  // namespace fogline
