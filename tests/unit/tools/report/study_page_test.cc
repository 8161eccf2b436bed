#include "tools/report/study_page.h"

#include <array>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fogline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

report::StudySection Hostile() {
  const std::string evil = "</script><script>alert(1)</script>|\"&";
  report::StudySection section{.name = "evil", .title = evil, .question = evil};
  section.answer = section.would_change = evil;
  section.claims = {{.says = evil, .compared = evil, .expected = evil, .found = evil}};
  section.method = evil;
  section.figures = {{.id = "evil-1",
                      .title = evil,
                      .caption = evil,
                      .x_label = evil,
                      .y_label = evil,
                      .categories = {evil},
                      .series = {{.name = evil, .x = {0}, .y = {1}, .low = {0}, .high = {2}}}}};
  section.tables = {{.caption = evil, .columns = {evil}, .rows = {{evil}}}};
  return section;
}

nlohmann::json DataOf(const std::string& page) {
  const std::string begin = "id=\"study-data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST(StudyPageTest, LetsNoTextBecomeMarkup) {
  const std::string page = report::MakeStudyPage("fogline study <evil>", std::array{Hostile()});
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("fogline study &lt;evil&gt;"));
  EXPECT_EQ(DataOf(page)[0]["series"][0]["name"], Hostile().title);
}

TEST(StudyPageTest, HasValuesThatAreNotThereAsNullAndRoundsTheOthers) {
  report::StudySection section = Hostile();
  section.figures[0].series[0].y = {1.23456789, std::numeric_limits<double>::quiet_NaN()};
  const nlohmann::json y =
      DataOf(report::MakeStudyPage("", std::array{section}))[0]["series"][0]["y"];
  EXPECT_EQ(y[0], 1.23457);
  EXPECT_TRUE(y[1].is_null());
}

TEST(StudyPageTest, SaysOfAnAxisThatItIsLogarithmicOrWhereItEnds) {
  report::StudySection section = Hostile();
  EXPECT_EQ(DataOf(report::MakeStudyPage("", std::array{section}))[0]["most"], nullptr);
  section.figures[0].log_y = true;
  std::string page = report::MakeStudyPage("", std::array{section});
  EXPECT_THAT(page, HasSubstr("<span class=\"unit\">(logarithmic)</span></p>"));
  EXPECT_EQ(DataOf(page)[0]["logY"], true);
  section.figures[0].log_y = false;
  section.figures[0].most = 12.5;
  page = report::MakeStudyPage("", std::array{section});
  EXPECT_THAT(page, HasSubstr("(▸ beyond 12.5)</span></p>"));
  EXPECT_EQ(DataOf(page)[0]["most"], 12.5);
}

TEST(StudyTextTest, KeepsBarsOutOfItsTables) {
  const std::string text = report::MakeStudyText("fogline study evil", std::array{Hostile()});
  EXPECT_THAT(text, HasSubstr("Made by `fogline study evil`."));
  EXPECT_THAT(text, HasSubstr("| </script><script>alert(1)</script>\\|\"& |"));
}

}  // namespace
}  // namespace fogline
