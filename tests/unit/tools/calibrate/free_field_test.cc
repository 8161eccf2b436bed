#include "tools/calibrate/free_field.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/input_errors.h"

namespace fogline {
namespace {

// The error text for a --free; "" if there is no error.
std::string ErrorOf(const std::string& text) {
  return test::ErrorOf([&text] { const calibrate::FreeField field(text); });
}

TEST(FreeFieldTest, KnowsItsBoundsUnitAndScale) {
  const calibrate::FreeField field("/follower/weight_distance=0.001:10:log");
  EXPECT_EQ(field.pointer(), "/follower/weight_distance");
  EXPECT_EQ(field.lowest(), 0.001);
  EXPECT_EQ(field.highest(), 10);
  EXPECT_TRUE(field.is_logarithmic());
  EXPECT_FALSE(field.is_integer());
  EXPECT_EQ(calibrate::FreeField("/fog/bias_m=0.2:0.4").unit(), "m");
}

TEST(FreeFieldTest, RunsFromBoundToBound) {
  for (const char* text : {"/fog/bias_m=0.2:0.4", "/follower/weight_distance=0.001:10:log",
                           "/radar/bias_m=-0.123456789:0.3", "/arbitrator/window_steps=3:11"}) {
    const calibrate::FreeField field(text);
    EXPECT_EQ(field.ValueAt(0), field.lowest()) << text;
    EXPECT_EQ(field.ValueAt(1), field.highest()) << text;
    EXPECT_EQ(field.ValueAt(-0.5), field.lowest()) << text;
    EXPECT_EQ(field.ValueAt(1.5), field.highest()) << text;
  }
}

TEST(FreeFieldTest, ReturnsToTheShareOfAValue) {
  for (const char* text : {"/fog/bias_m=0.2:0.4", "/follower/weight_distance=0.001:10:log"}) {
    const calibrate::FreeField field(text);
    for (const double share : {0.0, 0.123, 0.5, 0.999}) {
      // A value is rounded to 1e-5 of the range, or more finely.
      EXPECT_NEAR(field.ShareOf(field.ValueAt(share)), share, 1e-5) << text;
    }
  }
}

TEST(FreeFieldTest, GoesInEqualFactorsOnALogarithmicScale) {
  EXPECT_DOUBLE_EQ(calibrate::FreeField("/follower/weight_distance=0.01:100:log").ValueAt(0.5), 1);
  EXPECT_DOUBLE_EQ(calibrate::FreeField("/follower/weight_distance=0.01:100").ValueAt(0.5), 50.005);
}

TEST(FreeFieldTest, HasValuesWithFewDigits) {
  EXPECT_EQ(calibrate::FreeField("/fog/bias_m=0.2:0.4").ValueAt(1.0 / 3), 0.266667);
  EXPECT_EQ(calibrate::FreeField("/fog/bias_m=0:100").ValueAt(1.0 / 3), 33.333);
  EXPECT_EQ(calibrate::FreeField("/follower/weight_distance=0.001:10:log").ValueAt(1.0 / 3),
            0.0215443);
}

TEST(FreeFieldTest, RoundsIntegers) {
  const calibrate::FreeField field("/arbitrator/window_steps=3:11");
  EXPECT_EQ(field.ValueAt(0.49), 7);
  EXPECT_EQ(field.ValueAt(0.57), 8);
}

TEST(FreeFieldTest, ReadsAndSetsTheScenario) {
  Scenario scenario;
  const calibrate::FreeField field("/lidar/beam/pulse_half_width_ns=1:20");
  EXPECT_EQ(field.Get(scenario), scenario.lidar.beam.pulse_half_width_ns);
  field.Set(scenario, 7);
  EXPECT_EQ(scenario.lidar.beam.pulse_half_width_ns, 7);
  EXPECT_EQ(field.Get(scenario), 7);
}

TEST(FreeFieldTest, RefusesAnotherForm) {
  constexpr const char* kForm = "neither /pointer=lowest:highest nor /pointer=lowest:highest:log";
  for (const std::string text : {"", "/fog/bias_m", "fog/bias_m=0:1", "/fog/bias_m=1",
                                 "/fog/bias_m=0:x", "/fog/bias_m=0:1:2", "/fog/bias_m=nan:1",
                                 "/fog/bias_m=0:inf", "/fog/bias_m=0:1:logarithmic"}) {
    EXPECT_EQ(ErrorOf(text), "error: --free " + text + ": " + kForm);
  }
}

TEST(FreeFieldTest, SuggestsTheFieldThatIsMeant) {
  EXPECT_EQ(ErrorOf("/fog/bias=0:1"),
            "error: --free /fog/bias=0:1: no such field; did you mean \"/fog/bias_m\"?");
  EXPECT_EQ(ErrorOf("/x=0:1"), "error: --free /x=0:1: no such field");
}

TEST(FreeFieldTest, RefusesWhatIsNoNumber) {
  for (const std::string text : {"/fog/model=0:1", "/fog=0:1", "/fusion/gating=0:1", "/title=0:1",
                                 "/published/0/si_pct=0:1", "/lead/recorded/speeds_mps/0=0:1"}) {
    EXPECT_EQ(ErrorOf(text),
              "error: --free " + text + ": neither a number nor an integer outside lists");
  }
}

TEST(FreeFieldTest, RefusesBoundsOutsideTheFieldsRange) {
  EXPECT_EQ(ErrorOf("/fog/bias_m=-1:1"),
            "error: --free /fog/bias_m=-1:1: -1 is outside [0, 100] m");
  EXPECT_EQ(ErrorOf("/fog/bias_m=0:100.5"),
            "error: --free /fog/bias_m=0:100.5: 100.5 is outside [0, 100] m");
}

TEST(FreeFieldTest, RefusesBoundsThatLeaveNoRange) {
  EXPECT_EQ(ErrorOf("/fog/bias_m=0.5:0.5"),
            "error: --free /fog/bias_m=0.5:0.5: 0.5 is not below 0.5");
  EXPECT_EQ(ErrorOf("/fog/bias_m=0.5:0.4"),
            "error: --free /fog/bias_m=0.5:0.4: 0.5 is not below 0.4");
  EXPECT_EQ(ErrorOf("/fog/bias_m=0:1:log"),
            "error: --free /fog/bias_m=0:1:log: a logarithmic scale needs bounds above 0");
  EXPECT_EQ(ErrorOf("/arbitrator/window_steps=3.5:8"),
            "error: --free /arbitrator/window_steps=3.5:8: 3.5 is no integer");
}

TEST(FreeFieldTest, LeavesSeedsAndThresholdsToOtherOptions) {
  EXPECT_EQ(ErrorOf("/seed=0:9"), "error: --free /seed=0:9: seeds are given by --seeds");
  EXPECT_EQ(ErrorOf("/arbitrator/threshold=0:1"),
            "error: --free /arbitrator/threshold=0:1: the thresholds are the target's");
}

TEST(FreeFieldTest, IsGivenOnce) {
  EXPECT_EQ(calibrate::ParseFreeFields({"/fog/bias_m=0:1", "/radar/bias_m=0:1"}).size(), 2U);
  EXPECT_EQ(
      test::ErrorOf([] {
        calibrate::ParseFreeFields({"/fog/bias_m=0:1", "/radar/bias_m=0:1", "/fog/bias_m=0:2"});
      }),
      "error: --free /fog/bias_m=0:2: given twice");
}

}  // namespace
}  // namespace fogline
