#include "services/models/driver/human_driver.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/property/services/models/driver/between.h"

namespace fogline {
namespace {

constexpr std::int64_t kSituations = 5'000;

models::Situation AnySituation(std::int64_t index) {
  const Random random(23, Stream::kRadar);
  const auto [v, a] = random.Uniform2(index, 0);
  const auto [s, l] = random.Uniform2(index, 1);
  const auto [lead_a, there] = random.Uniform2(index, 2);
  models::Situation any{.speed_mps = 45 * v, .acceleration_mps2 = Between(-9, 3, a)};
  if (there < 0.9) {
    any.ahead = models::CarAhead{.gap_m = Between(-1, 150, s),
                                 .speed_mps = 45 * l,
                                 .acceleration_mps2 = Between(-9, 3, lead_a)};
  }
  return any;
}

constexpr FollowingModel kModels[] = {FollowingModel::kIdm, FollowingModel::kIidm,
                                      FollowingModel::kAccIdm};

TEST(HumanDriverProperty, WithoutErrorsAndReactionTimeIsTheModelExactly) {
  for (const FollowingModel kind : kModels) {
    const models::Following model(kind, DriverSection{});
    models::HumanDriver driver({.reaction_time_s = 0, .gap_error = 0, .approach_error_ps = 0},
                               model, Random(1, Stream::kHumanErrors), 0.1);
    models::HumanDriver attentive({.reaction_time_s = 0}, model, Random(1, Stream::kHumanErrors),
                                  0.1);
    for (std::int64_t k = 0; k < kSituations; ++k) {
      const models::Situation seen = AnySituation(k);
      ASSERT_EQ(driver.Step(k, seen), model.Acceleration(seen)) << k;
      ASSERT_EQ(attentive.Step(k, seen, models::Attention{}), model.Acceleration(seen)) << k;
    }
  }
}

TEST(FollowingProperty, IsFiniteAndWithinItsLimitsEverywhere) {
  const DriverSection driver;
  for (const FollowingModel kind : kModels) {
    const models::Following model(kind, driver);
    for (std::int64_t k = 0; k < kSituations; ++k) {
      const double acceleration = model.Acceleration(AnySituation(k));
      ASSERT_TRUE(std::isfinite(acceleration)) << k;
      ASSERT_GE(acceleration, -driver.max_deceleration_mps2) << k;
      ASSERT_LE(acceleration, driver.max_acceleration_mps2) << k;
    }
  }
}

TEST(FollowingProperty, NeverBrakesHarderForMoreRoom) {
  for (const FollowingModel kind : {FollowingModel::kIdm, FollowingModel::kIidm}) {
    const models::Following model(kind, DriverSection{});
    for (std::int64_t k = 0; k < kSituations; ++k) {
      models::Situation near = AnySituation(k);
      if (!near.ahead) continue;
      models::Situation far = near;
      far.ahead->gap_m += 5;
      ASSERT_LE(model.Acceleration(near), model.Acceleration(far) + 1e-12) << k;
    }
  }
}

}  // namespace
}  // namespace fogline
