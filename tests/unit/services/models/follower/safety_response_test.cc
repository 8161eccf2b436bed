#include "services/models/follower/safety_response.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kStep_s = 0.1;
const models::Situation kSafe{.speed_mps = 20,
                              .ahead = models::CarAhead{.gap_m = 100, .speed_mps = 20}};
const models::Situation kCutIn{.speed_mps = 20,
                               .ahead = models::CarAhead{.gap_m = 15, .speed_mps = 10}};

TEST(SafetyResponseTest, ReferenceHumanPerceivesLiftsOffAndRampsUp) {
  models::SafetyResponse human(models::SafetyModel::kReferenceHuman, kStep_s);
  EXPECT_EQ(human.Step(kSafe), 0);
  EXPECT_FALSE(human.alarmed());
  // The TTC is 1.5 s. After 0.4 s of perception the throttle is released for 0.75 s: in the steps
  // from 0.4 s to 1.1 s.
  for (int k = 0; k < 4; ++k) EXPECT_EQ(human.Step(kCutIn), 0) << k;
  EXPECT_TRUE(human.alarmed());
  for (int k = 4; k < 12; ++k) EXPECT_EQ(human.Step(kCutIn), 0.4) << k;
  double last = 0.4;
  for (int k = 12; k < 17; ++k) {
    const double now = human.Step(kCutIn);
    EXPECT_NEAR(now - last, 1.265, 1e-9) << k;
    last = now;
  }
  EXPECT_EQ(human.Step(kCutIn), 7.59);
  // The situation is not critical, but the gap still closes, so the driver continues to brake. As
  // soon as the gap is constant or opens, the driver releases the brake.
  models::Situation clearing = kCutIn;
  clearing.ahead->gap_m = 50;
  EXPECT_EQ(human.Step(clearing), 7.59);
  clearing.speed_mps = 10;
  EXPECT_EQ(human.Step(clearing), 0);
}

TEST(SafetyResponseTest, ReferenceHumanFearsAHardBrakeAheadOnlyWhenClose) {
  models::Situation braking{
      .speed_mps = 20,
      .ahead = models::CarAhead{.gap_m = 39, .speed_mps = 20, .acceleration_mps2 = -6}};
  models::SafetyResponse human(models::SafetyModel::kReferenceHuman, kStep_s);
  human.Step(braking);
  EXPECT_TRUE(human.alarmed());
  braking.ahead->gap_m = 41;
  human.Step(braking);
  EXPECT_FALSE(human.alarmed());
}

TEST(SafetyResponseTest, RssAnswersAfterItsResponseTime) {
  models::SafetyResponse rss(models::SafetyModel::kRss, kStep_s);
  const models::Situation close{.speed_mps = 20,
                                .ahead = models::CarAhead{.gap_m = 65, .speed_mps = 20}};
  for (int k = 0; k < 10; ++k) EXPECT_EQ(rss.Step(close), 0) << k;
  EXPECT_NEAR(rss.Step(close), 1.265, 1e-9);
  const models::Situation far{.speed_mps = 20,
                              .ahead = models::CarAhead{.gap_m = 66, .speed_mps = 20}};
  EXPECT_EQ(rss.Step(far), 0);
}

TEST(SafetyResponseTest, FuzzyModelBrakesNoHarderThanItsSurrogatesSay) {
  models::SafetyResponse fuzzy(models::SafetyModel::kFuzzy, kStep_s);
  models::Situation near{.speed_mps = 20, .ahead = models::CarAhead{.gap_m = 31, .speed_mps = 20}};
  double braking = 0;
  for (int k = 0; k < 20; ++k) braking = fuzzy.Step(near);
  EXPECT_GT(braking, 0);
  EXPECT_EQ(braking, models::FuzzyDeceleration({}, near));
}

TEST(SafetyResponseTest, RefusesAFuzzyModelWithoutFuzz) {
  EXPECT_THROW(models::SafetyResponse(models::SafetyModel::kFuzzy, kStep_s, {}, {},
                                      {.hard_braking_mps2 = 4}),
               std::invalid_argument);
}

}  // namespace
}  // namespace fogline
