#include "tools/watch/traffic_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fogline {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string Joined(const std::vector<watch::Line>& lines) {
  std::string text;
  for (const watch::Line& line : lines) text += line.text + "\n";
  return text;
}

watch::RunView RunWithOneRole() {
  watch::RoleView role;
  role.status.role = "fusion";
  role.status.host = "lab\033[2J";
  role.status.pid = 17;
  role.status.state = status_t::FAILED;
  role.status.foreign = 3;
  role.status.sends_failed = 5;
  role.status.send_error = "Network is unreachable";
  role.status.error = "no track";
  role.silent = true;
  role.age_s = 2.5;
  watch::RunView run;
  run.run_id = 4711;
  run.roles.push_back(role);
  return run;
}

TEST(TrafficTextTest, TellsHowToFindRunsWhileNothingArrives) {
  EXPECT_THAT(Joined(watch::TrafficLines({}, "udpm://")), HasSubstr("fogline doctor"));
}

TEST(TrafficTextTest, SaysWhatIsWrongWithARole) {
  watch::TrafficView view;
  view.runs.push_back(RunWithOneRole());
  const std::vector<watch::Line> lines = watch::TrafficLines(view, "udpm://");
  EXPECT_EQ(lines.back().style, watch::Line::Style::kBad);
  EXPECT_THAT(lines.back().text, HasSubstr("FAILED"));
  EXPECT_THAT(lines.back().text,
              HasSubstr("silent for 2.5 s; no track; refused 3 of other runs; "));
  EXPECT_THAT(lines.back().text, HasSubstr("; could not send 5 (Network is unreachable)"));
}

TEST(TrafficTextTest, SaysOfARunInRealTimeWhichInputsAreLostAndNotThatARoleWaits) {
  watch::RoleView role{};
  role.status.role = "arbitrator";
  role.status.state = status_t::RUNNING;
  role.status.waiting_for = "DRIVER_COMMAND";
  role.status.fallback = "the automation drives alone";
  role.status.input = {"DRIVER_COMMAND"};
  role.status.input_state = {status_t::INPUT_LOST};
  role.status.input_age_us = {12'000'000};
  role.status.input_late = {0};
  role.status.num_inputs = 1;
  watch::TrafficView view;
  watch::RunView& run = view.runs.emplace_back();
  run.phase = run_t::GO;
  run.pace = 1;
  run.realtime = true;
  run.roles.push_back(role);
  const std::vector<watch::Line> lines = watch::TrafficLines(view, "udpm://");
  EXPECT_THAT(Joined(lines), HasSubstr("  GO  real time x1  "));
  EXPECT_EQ(lines.back().style, watch::Line::Style::kBad);
  EXPECT_THAT(lines.back().text,
              HasSubstr("the automation drives alone; LOST DRIVER_COMMAND 12.0 s"));
  EXPECT_THAT(lines.back().text, Not(HasSubstr("waits")));
  const auto json = watch::TrafficJson(view, "udpm://")["runs"][0];
  EXPECT_EQ(json["realtime"], true);
  EXPECT_EQ(json["roles"][0]["fallback"], "the automation drives alone");
  EXPECT_EQ(json["roles"][0]["inputs"]["DRIVER_COMMAND"], "lost");
}

TEST(TrafficTextTest, PassesNoControlCharactersFromTheNetworkOn) {
  watch::TrafficView view;
  view.runs.push_back(RunWithOneRole());
  watch::ChannelView channel;
  channel.channel = "\033]0;title\a\xc3\xa4";
  view.others.push_back(channel);
  for (const watch::Line& line : watch::TrafficLines(view, "udpm://")) {
    for (const char c : line.text) EXPECT_TRUE(c >= ' ' && c <= '~') << line.text;
  }
}

TEST(TrafficTextTest, ShowsTheLossOfAChannelWithinEightyColumns) {
  watch::TrafficView view;
  watch::ChannelView channel;
  channel.channel = "FOLLOWER_COMMAND";
  channel.type = "follower_command_t";
  channel.steps = watch::StepSequence::Counts{.newest = 123'456, .lost = 9876};
  watch::RunView run;
  run.channels.push_back(channel);
  view.runs.push_back(run);
  const std::string line = watch::TrafficLines(view, "udpm://").back().text;
  EXPECT_THAT(line.substr(0, 80), HasSubstr("9876"));
}

}  // namespace
}  // namespace fogline
