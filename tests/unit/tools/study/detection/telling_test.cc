#include "tools/study/detection/telling.h"

#include <array>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using ::testing::ElementsAre;

constexpr double kNone = -1;
constexpr double kShortest_s = 0.8;

TEST(OneOfEqualAlarmsTest, DetectorsWithTheSameAlarmsAreTheFirstOfThem) {
  const std::array<study::AlarmTimes, 4> detectors{
      {{{3, kNone, 5}, {}}, {{3, kNone, 6}, {}}, {{3, kNone, 5}, {}}, {{3, kNone, 6}, {}}}};
  EXPECT_THAT(study::OneOfEqualAlarms(detectors), ElementsAre(0, 1, 0, 1));
}

TEST(OneOfEqualAlarmsTest, FurtherRunsCanTellDetectorsApart) {
  const std::array<study::AlarmTimes, 3> detectors{
      {{{3, 5}, {7, 8}}, {{3, 5}, {7, kNone}}, {{3, 5}, {7, 8}}}};
  EXPECT_THAT(study::OneOfEqualAlarms(detectors), ElementsAre(0, 1, 0));
}

TEST(OneOfEqualAlarmsTest, OneWithFurtherRunsStandsForThoseWithout) {
  const std::array<study::AlarmTimes, 3> detectors{
      {{{3, 5}, {}}, {{3, 5}, {7, 8}}, {{4, 5}, {7, 8}}}};
  EXPECT_THAT(study::OneOfEqualAlarms(detectors), ElementsAre(1, 1, 2));
}

/// Ten detectors, of which `slow` are slower than the others by about `slower_s`.
std::vector<study::DelayAndShare> Ten(int slow, double slower_s) {
  std::vector<study::DelayAndShare> detectors;
  for (int i = 0; i < 10; ++i) {
    detectors.push_back({.delay_s = 2 + (i < slow ? slower_s : 0.01 * i), .share = 1});
  }
  return detectors;
}

TEST(TellingTest, RanksNothingIfNineOfTenDetectorsAlarmAtOnce) {
  EXPECT_EQ(study::TellingOf(Ten(0, 0), kShortest_s), study::Telling::kAllAtOnce);
  EXPECT_EQ(study::TellingOf(Ten(1, 8), kShortest_s), study::Telling::kAllAtOnce);
  EXPECT_EQ(study::TellingOf(Ten(2, 8), kShortest_s), study::Telling::kRanks);
  EXPECT_EQ(study::TellingOf(Ten(5, 0.7), kShortest_s), study::Telling::kAllAtOnce);
}

TEST(TellingTest, RanksNothingIfHardlyAnyDetectorFindsTheFog) {
  std::vector<study::DelayAndShare> detectors(10, {.delay_s = 10.9, .share = 0.02});
  EXPECT_EQ(study::TellingOf(detectors, kShortest_s), study::Telling::kHardlyAny);
  detectors[3] = {.delay_s = 9, .share = 0.2};
  detectors[4] = {.delay_s = 8.5, .share = 0.3};
  EXPECT_EQ(study::TellingOf(detectors, kShortest_s), study::Telling::kRanks);
}

TEST(TellingTest, IsOpenWithoutDetectors) {
  EXPECT_EQ(study::TellingOf({}, kShortest_s), study::Telling::kRanks);
}

}  // namespace
}  // namespace fogline
