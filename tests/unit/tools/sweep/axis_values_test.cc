#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_errors.h"
#include "tools/sweep/plan.h"

namespace fogline {
namespace {

using test::ErrorOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(AxisValuesTest, AreAListAsItStands) {
  EXPECT_THAT(sweep::ParseAxis("/fog/bias_m=0.2,0.30").values, ElementsAre("0.2", "0.30"));
  EXPECT_THAT(sweep::ParseThresholds("0.8,0.2"), ElementsAre(0.8, 0.2));
}

TEST(AxisValuesTest, AreEvenlySpacedFromFirstToLast) {
  EXPECT_THAT(sweep::ParseAxis("/fog/bias_m=0.2:0.4:3").values, ElementsAre("0.2", "0.3", "0.4"));
  EXPECT_THAT(sweep::ParseThresholds("1:0:5"), ElementsAre(1.0, 0.75, 0.5, 0.25, 0.0));
}

TEST(AxisValuesTest, MeetTheDecimalNumbersThatAPersonMeans) {
  // The threshold identifies a published row, so 0.2 must equal the 0.2 of a scenario file exactly.
  const std::vector<double> thresholds = sweep::ParseThresholds("0.01:0.99:99");
  for (int percent = 1; percent <= 99; ++percent) {
    EXPECT_EQ(thresholds[static_cast<std::size_t>(percent - 1)], percent / 100.0) << percent;
  }
}

TEST(AxisValuesTest, AreRefusedWithTheWholeArgument) {
  EXPECT_THAT(ErrorOf([] { sweep::ParseAxis("/fog/bias_m=0:1"); }),
              StartsWith("error: --grid /fog/bias_m=0:1: not first:last:count"));
  EXPECT_THAT(ErrorOf([] { sweep::ParseAxis("/fog/bias_m=1,,2"); }), HasSubstr("an empty value"));
  EXPECT_THAT(
      ErrorOf([] { sweep::ParseAxis("/fog/bias_m=inf:1:2"); }),
      StartsWith("error: --grid /fog/bias_m=inf:1:2: not first:last:count with two finite"));
  EXPECT_THAT(ErrorOf([] { sweep::ParseThresholds("0:1:1"); }),
              StartsWith("error: --thresholds 0:1:1: not first:last:count"));
}

TEST(AxisValuesTest, AreAllDifferent) {
  for (const char* values : {"0.5,0.50", "1,0.5,5e-1", "0.5:0.5:3"}) {
    EXPECT_EQ(ErrorOf([&] { sweep::ParseAxis("/fog/bias_m=" + std::string(values)); }),
              "error: --grid /fog/bias_m=" + std::string(values) + ": 0.5 comes twice");
  }
  EXPECT_THAT(ErrorOf([] { sweep::ParseAxis("/fog/model=bias,beam,bias"); }),
              HasSubstr(": bias comes twice"));
  EXPECT_THAT(ErrorOf([] { sweep::ParseThresholds("0,-0"); }), HasSubstr(": 0 comes twice"));
}

TEST(AxisValuesTest, IgnoreSpacesAroundAValue) {
  EXPECT_THAT(sweep::ParseAxis("/fog/bias_m=0.2, 0.3 ").values, ElementsAre("0.2", "0.3"));
  EXPECT_THAT(sweep::ParseThresholds(" 0.2 : 0.8 : 2 "), ElementsAre(0.2, 0.8));
}

TEST(AxisValuesTest, OfThresholdsAreNumbersFromZeroToOne) {
  for (const char* text : {"0.5,1.1", "-0.1", "0.5,half", "nan", "0.9:1.1:3"}) {
    EXPECT_THAT(ErrorOf([&] { sweep::ParseThresholds(text); }),
                HasSubstr("is no number from 0 to 1"));
  }
}

}  // namespace
}  // namespace fogline
