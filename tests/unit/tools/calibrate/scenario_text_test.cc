#include "tools/calibrate/scenario_text.h"

#include <string>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"

namespace fogline {
namespace {

constexpr std::string_view kText = R"({
  "$schema": "scenario.schema.json",
  "version": 1,
  "title": "Braces } and \"quotes\", in a text",
  "fog": { "model": "bias",   "bias_m": 0.34 },
  "radar": {
    "bias_m": 9.54e-1
  },
  "lidar": {},
  "lead": { "breakpoints": [{ "speed_mps": 5 }, { "speed_mps": 6 }] }
}
)";

// kText with `to` instead of `from`.
std::string Edited(std::string_view from, std::string_view to) {
  std::string text(kText);
  return text.replace(text.find(from), from.size(), to);
}

TEST(ScenarioTextTest, ChangesAValueAndNothingElse) {
  EXPECT_EQ(calibrate::WithValue(kText, "/fog/bias_m", "0.3"), Edited("0.34", "0.3"));
  EXPECT_EQ(calibrate::WithValue(kText, "/radar/bias_m", "1"), Edited("9.54e-1", "1"));
  EXPECT_EQ(calibrate::WithValue(kText, "/title", "\"t\""),
            Edited(R"("Braces } and \"quotes\", in a text")", "\"t\""));
  EXPECT_EQ(calibrate::WithValue(kText, "/fog", "{}"),
            Edited(R"({ "model": "bias",   "bias_m": 0.34 })", "{}"));
}

TEST(ScenarioTextTest, ReachesTheItemsOfLists) {
  EXPECT_EQ(calibrate::WithValue(kText, "/lead/breakpoints/1/speed_mps", "8"),
            Edited(R"("speed_mps": 6)", R"("speed_mps": 8)"));
}

TEST(ScenarioTextTest, AddsAKeyLastInTheLayoutOfTheOthers) {
  EXPECT_EQ(calibrate::WithValue(kText, "/fog/start_s", "5"),
            Edited("0.34 }", "0.34,   \"start_s\": 5 }"));
  EXPECT_EQ(calibrate::WithValue(kText, "/radar/range_std_m", "0"),
            Edited("9.54e-1\n", "9.54e-1,\n    \"range_std_m\": 0\n"));
  EXPECT_EQ(calibrate::WithValue(kText, "/lidar/bias_m", "1"),
            Edited("\"lidar\": {}", "\"lidar\": { \"bias_m\": 1 }"));
}

TEST(ScenarioTextTest, AddsTheSectionsOnTheWay) {
  EXPECT_EQ(calibrate::WithValue(kText, "/follower/headway_s", "2"),
            Edited("6 }] }\n", "6 }] },\n  \"follower\": { \"headway_s\": 2 }\n"));
  EXPECT_EQ(calibrate::WithValue(kText, "/lidar/beam/beams", "3"),
            Edited("\"lidar\": {}", "\"lidar\": { \"beam\": { \"beams\": 3 } }"));
}

TEST(ScenarioTextTest, WorksOnTextWithoutBlanks) {
  EXPECT_EQ(calibrate::WithValue(R"({"version":1,"seed":2})", "/seed", "3"),
            R"({"version":1,"seed":3})");
  EXPECT_EQ(calibrate::WithValue(R"({"version":1})", "/seed", "3"), R"({"version":1,"seed": 3})");
}

TEST(ScenarioTextTest, TakesOverridesAsTheLoaderDoes) {
  for (const std::string one :
       {"/fog/model=beam", "/fog/model=\"beam\"", "/title=a = b, in {fog}", "/seed=7",
        "/fog={\"model\": \"beam\", \"visibility_m\": 50}", "/lead/breakpoints/0/speed_mps=9",
        "/lead/recorded/speeds_mps=[1, 2]", "/fusion/gating=true", "/acc/horizon_steps=20"}) {
    EXPECT_EQ(PrintScenario(ParseScenario(calibrate::WithOverride(kText, one))),
              PrintScenario(ParseScenario(kText, "f", {one})))
        << one;
  }
}

}  // namespace
}  // namespace fogline
