#include "scenario/io/overrides.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"

namespace fogline {
namespace {

constexpr std::string_view kText = R"({"version": 1, "steps": 7, "fog": {"model": "bias"},
  "lead": {"breakpoints": [{"speed_mps": 5}, {"speed_mps": 6}]}})";

Scenario With(const std::vector<std::string>& overrides) {
  return ParseScenario(kText, "f", overrides);
}

// The first line of the error text for an override.
std::string OverrideErrorOf(const std::string& override_text, std::string_view text = kText) {
  try {
    ParseScenario(text, "f", {override_text});
    return "";
  } catch (const ScenarioError& error) {
    const std::string what = error.what();
    return what.substr(0, what.find('\n'));
  }
}

TEST(OverrideTest, ReplacesWhatTheFileSays) { EXPECT_EQ(With({"/steps=9"}).steps, 9); }

TEST(OverrideTest, MakesTheSectionsOnTheWay) {
  EXPECT_EQ(With({"/lidar/beam/beams=3"}).lidar.beam.beams, 3);
}

TEST(OverrideTest, ReachesTheItemsOfLists) {
  const Scenario scenario = With({"/lead/breakpoints/1/speed_mps=8"});
  EXPECT_EQ(scenario.lead.breakpoints[0].speed_mps, 5);
  EXPECT_EQ(scenario.lead.breakpoints[1].speed_mps, 8);
}

TEST(OverrideTest, TakesJsonOrElseAPlainText) {
  EXPECT_EQ(With({"/fog/model=beam"}).fog.model, FogModel::kBeam);
  EXPECT_EQ(With({"/fog/model=\"beam\""}).fog.model, FogModel::kBeam);
  EXPECT_EQ(With({"/title=a = b, in {fog}"}).title, "a = b, in {fog}");
  EXPECT_EQ(With({"/fog={\"model\": \"beam\", \"visibility_m\": 50}"}).fog.visibility_m, 50);
  EXPECT_THAT(With({"/lead/recorded/speeds_mps=[1, 2]"}).lead.recorded.speeds_mps,
              testing::ElementsAre(1, 2));
}

TEST(OverrideTest, LetsTheLastOfTwoWin) { EXPECT_EQ(With({"/steps=8", "/steps=9"}).steps, 9); }

TEST(OverrideTest, ComesBeforeTheCheckOfTheFile) {
  EXPECT_EQ(ParseScenario(R"({"steps": "x"})", "f", {"/version=1", "/steps=3"}).steps, 3);
}

TEST(OverrideTest, IsNamedWithFieldRangeAndSuggestion) {
  EXPECT_EQ(OverrideErrorOf("/arbitrator/threshold=1.5"),
            "--set /arbitrator/threshold=1.5: error: /arbitrator/threshold: 1.5 is outside [0, 1]");
  EXPECT_EQ(OverrideErrorOf("/step_s=fast"),
            "--set /step_s=fast: error: /step_s: must be a number in [0.001, 1] s, not the text "
            "\"fast\"");
  EXPECT_EQ(OverrideErrorOf("/fog/model=beem"),
            "--set /fog/model=beem: error: /fog/model: \"beem\" is not one of \"none\", \"bias\", "
            "\"beam\", \"modes\"; did you mean \"beam\"?");
}

TEST(OverrideTest, SuggestsTheFieldThatIsMeant) {
  EXPECT_EQ(OverrideErrorOf("/arbitrator/treshold=1"),
            "--set /arbitrator/treshold=1: error: /arbitrator/treshold: no such field; did you "
            "mean \"/arbitrator/threshold\"?");
  EXPECT_EQ(OverrideErrorOf("/visibility_m=50"),
            "--set /visibility_m=50: error: /visibility_m: no such field; did you mean "
            "\"/fog/visibility_m\"?");
  EXPECT_THAT(OverrideErrorOf("/lead/breakpoints/1/sped_mps=8"),
              testing::HasSubstr("did you mean \"/lead/breakpoints/1/speed_mps\"?"));
  EXPECT_EQ(OverrideErrorOf("fog.model=beam"),
            "--set fog.model=beam: error: must be /pointer=value, such as "
            "/arbitrator/threshold=0.8; did you mean \"/fog/model\"?");
}

TEST(OverrideTest, RefusesAnItemThatIsNotThere) {
  EXPECT_EQ(OverrideErrorOf("/lead/breakpoints/2/speed_mps=8"),
            "--set /lead/breakpoints/2/speed_mps=8: error: /lead/breakpoints/2/speed_mps: no such "
            "item: /lead/breakpoints has 2 items, counted from 0");
  EXPECT_THAT(OverrideErrorOf("/published/0/threshold=1"),
              testing::HasSubstr("/published has 0 items"));
  EXPECT_THAT(OverrideErrorOf("/published/99999999999999999999/threshold=1"),
              testing::HasSubstr("/published has 0 items"));
  EXPECT_THAT(OverrideErrorOf("/lead/breakpoints/*/speed_mps=1"),
              testing::HasSubstr("no such item"));
  // "00" is not another name of item 0.
  EXPECT_NE(OverrideErrorOf("/lead/breakpoints/00/speed_mps=1"), "");
}

TEST(OverrideTest, RefusesWhatIsNoOverride) {
  for (const char* text : {"", "=", "/", "/=1", "steps", "/steps", "steps=1", "\xff=1"}) {
    EXPECT_THAT(OverrideErrorOf(text), testing::HasSubstr("must be /pointer=value")) << text;
  }
}

TEST(OverrideTest, ShowsNoControlCharacterOfItsText) {
  EXPECT_EQ(OverrideErrorOf("/title=\x1b[31m").find('\x1b'), std::string::npos);
  EXPECT_EQ(OverrideErrorOf("/\x1b=1").find('\x1b'), std::string::npos);
}

TEST(OverrideTest, ReportsDuplicateKeysOfItsValueWithTheirPointer) {
  EXPECT_THAT(OverrideErrorOf(R"(/fog={"bias_m": 1, "bias_m": 2})"),
              testing::HasSubstr(": error: /fog/bias_m: duplicate key"));
}

TEST(OverrideTest, LeavesAMistakeOfTheFileToTheFile) {
  EXPECT_EQ(OverrideErrorOf("/fog/model=beam", R"({"version": 1, "fog": 5})"),
            "f:1:23: error: /fog: must be an object, not the number 5");
  EXPECT_EQ(OverrideErrorOf("/published/0/threshold=1", R"({"version": 1, "published": 5})"),
            "f:1:29: error: /published: must be a list of 0 to 100 items, not the number 5");
}

TEST(OverrideTest, ComesAfterTheFilesMistakes) {
  try {
    ParseScenario(R"({"version": 1, "seed": -1})", "f", {"/steps=0", "/nothing=0"});
    FAIL();
  } catch (const ScenarioError& error) {
    ASSERT_EQ(error.diagnostics().size(), 3U);
    EXPECT_EQ(error.diagnostics()[0].file, "f");
    EXPECT_EQ(error.diagnostics()[1].file, "--set /steps=0");
    EXPECT_EQ(error.diagnostics()[1].line, 0);
    EXPECT_EQ(error.diagnostics()[2].file, "--set /nothing=0");
  }
}

}  // namespace
}  // namespace fogline
