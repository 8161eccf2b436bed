#include "tools/watch/screen/top_screen.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "services/graph.h"

namespace fogline::watch {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kColumns = 80;
constexpr std::size_t kRows = 24;

/// A run with all roles, each with a remark, and all channels of each step.
TopView View() {
  TopView view;
  view.url = "udpm://239.255.76.67:7700?ttl=0";
  RunView run;
  run.run_id = 1234567890123456789;
  run.step = 217;
  run.phase = run_t::GO;
  run.pace = 1;
  for (const RoleInfo& info : kRoles) {
    RoleView role{};
    role.status.role = info.name;
    role.status.instance = static_cast<std::int64_t>(info.role) + 1;
    role.status.state = status_t::RUNNING;
    role.status.header.step = 217;
    role.status.foreign = 1;
    role.cpu_percent = static_cast<double>(info.role);
    run.roles.push_back(role);
  }
  double rate = 100;
  for (const ChannelInfo& info : kChannels) {
    ChannelView channel;
    channel.channel = info.name;
    channel.arrivals.rate_hz = info.name == "RADAR" ? 5 : rate++;
    if (info.name == "TRACK") {
      channel.type = "track_t";
      track_t track{};
      track.header.step = 217;
      runtime::Encode(track, channel.newest);
    }
    run.channels.push_back(channel);
  }
  view.traffic.runs.push_back(run);
  view.senders.senders.push_back(
      {.address = "127.0.0.1:41234", .counts = {}, .channels = {"TRUTH"}});
  return view;
}

class TopScreenTest : public testing::Test {
 protected:
  TopScreenTest() { screen_.Show(View()); }

  std::string Text(std::size_t columns = kColumns, std::size_t rows = kRows) {
    std::string text;
    for (const Line& line : screen_.Lines(columns, rows)) text += line.text + "\n";
    return text;
  }
  /// The text of the row at the cursor.
  std::string AtCursor() {
    const std::vector<Line> lines = screen_.Lines(kColumns, kRows);
    const auto row = std::ranges::find(lines, Line::Style::kSelected, &Line::style);
    return row == lines.end() ? "" : row->text;
  }
  void Press(Key key, int times = 1) {
    for (int i = 0; i < times; ++i) EXPECT_TRUE(screen_.OnKey(key));
  }

  TopScreen screen_;
};

TEST_F(TopScreenTest, ShowsEveryRoleAndItsDiagnosisIn80By24) {
  const std::vector<Line> lines = screen_.Lines(kColumns, kRows);
  EXPECT_EQ(lines.size(), kRows);
  for (const Line& line : lines) EXPECT_LT(line.text.size(), kColumns);
  const std::string text = Text();
  for (const RoleInfo& info : kRoles) {
    EXPECT_THAT(text, testing::ContainsRegex(std::string(info.name) +
                                             " +RUNNING +217 .*refused 1 of other runs"));
  }
  EXPECT_THAT(text, HasSubstr("RUN"));
  EXPECT_THAT(text, HasSubstr("q quit"));
}

TEST_F(TopScreenTest, ScrollsToTheLastRowAndBack) {
  EXPECT_THAT(Text(), Not(HasSubstr("127.0.0.1:41234")));
  Press(Key::kEnd);
  EXPECT_THAT(Text(), HasSubstr("127.0.0.1:41234"));
  EXPECT_THAT(Text(), Not(HasSubstr("world ")));
  Press(Key::kHome);
  EXPECT_THAT(Text(), HasSubstr("run 1234567890123456789"));
  EXPECT_THAT(AtCursor(), HasSubstr("world"));
  Press(Key::kDown, 2);
  EXPECT_THAT(AtCursor(), HasSubstr("lidar"));
  Press(Key::kUp);
  EXPECT_THAT(AtCursor(), HasSubstr("radar"));
  Press(Key::kNextTable);
  EXPECT_THAT(AtCursor(), HasSubstr("RUN"));
  Press(Key::kNextTable, 2);
  EXPECT_THAT(AtCursor(), HasSubstr("world"));
}

TEST_F(TopScreenTest, StaysAtTheFirstRowUntilAKeyIsPressed) {
  // GIVEN a screen that has seen the channels of a run before its roles
  TopScreen screen;
  TopView view = View();
  view.traffic.runs[0].roles.clear();
  screen.Show(view);
  // WHEN the roles come
  screen.Show(View());
  // THEN the heading of the run and the first role are visible
  const std::vector<Line> lines = screen.Lines(kColumns, kRows);
  EXPECT_THAT(lines[1].text, HasSubstr("run 1234567890123456789"));
  EXPECT_EQ(std::ranges::find(lines, Line::Style::kSelected, &Line::style)->text.find(" world"),
            0U);
}

TEST_F(TopScreenTest, SortsTheTableOfTheCursorAndStaysOnItsRow) {
  Press(Key::kDown, 3);
  EXPECT_THAT(AtCursor(), HasSubstr("fusion"));
  Press(Key::kSort, 2);  // by processor time
  EXPECT_THAT(AtCursor(), HasSubstr("fusion"));
  EXPECT_THAT(Text(), HasSubstr("s sort: CPU"));
  EXPECT_LT(Text().find("recorder"), Text().find("world"));
  Press(Key::kReverse);
  EXPECT_GT(Text().find("recorder"), Text().find("world"));
  // The other table has an order of its own.
  Press(Key::kNextTable);
  EXPECT_THAT(Text(), HasSubstr("s sort: channel"));
  Press(Key::kSort);
  Press(Key::kReverse);
  Press(Key::kHome);
  Press(Key::kNextTable);
  EXPECT_THAT(AtCursor(), HasSubstr("RADAR")) << "the lowest rate comes first";
}

TEST_F(TopScreenTest, OpensAChannelToItsFieldsAndARoleToItsStatus) {
  Press(Key::kNextTable);
  while (AtCursor().find("TRACK") == std::string::npos) Press(Key::kDown);
  Press(Key::kOpen);
  EXPECT_THAT(Text(), HasSubstr("TRACK of run 1234567890123456789 (track_t)"));
  EXPECT_THAT(Text(), HasSubstr("header.step              217"));
  EXPECT_THAT(Text(), HasSubstr("Esc close"));
  const std::string before = Text();
  Press(Key::kDown, 3);
  EXPECT_NE(Text(), before);
  Press(Key::kClose);
  EXPECT_THAT(AtCursor(), HasSubstr("TRACK"));
  Press(Key::kHome);
  Press(Key::kOpen);
  EXPECT_THAT(Text(), HasSubstr("world of run "));
  EXPECT_THAT(Text(), HasSubstr("refused 1 of other runs"));
  for (int i = 0; i < 50 && Text().find("build_id") == std::string::npos; ++i) Press(Key::kDown);
  EXPECT_THAT(Text(), HasSubstr("build_id"));
  // WHEN the run is gone
  screen_.Show({});
  EXPECT_THAT(Text(), HasSubstr("it is gone"));
}

TEST_F(TopScreenTest, FitsEveryWindow) {
  for (std::size_t columns = 1; columns < 100; columns += 7) {
    for (std::size_t rows = 1; rows < 50; rows += 3) {
      const std::vector<Line> lines = screen_.Lines(columns, rows);
      EXPECT_LE(lines.size(), rows);
      for (const Line& line : lines) EXPECT_LE(line.text.size(), columns);
    }
    Press(Key::kDown);
  }
  EXPECT_FALSE(screen_.OnKey(Key::kQuit));
}

TEST_F(TopScreenTest, ListsTheRolesThatWaitBeforeAnyRun) {
  screen_.Show({.url = "udpm://",
                .traffic = {},
                .senders = {},
                .announced = {},
                .waiting = {{.role = "driver",
                             .host = "lab2",
                             .pid = 4711,
                             .instance = 5,
                             .version = "0.1.0",
                             .url = "udpm://239.255.76.67:7700?ttl=1",
                             .waiting_s = 12}}});
  EXPECT_THAT(Text(), HasSubstr("4711@lab2"));
  EXPECT_THAT(Text(), HasSubstr("0.1.0"));
  EXPECT_THAT(Text(), HasSubstr("udpm://239.255.76.67"));
  EXPECT_THAT(AtCursor(), HasSubstr("driver"));
}

}  // namespace
}  // namespace fogline::watch
