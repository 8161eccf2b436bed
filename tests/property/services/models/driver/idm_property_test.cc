#include "services/models/driver/idm.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "common/random.h"
#include "tests/property/services/models/driver/between.h"

namespace fogline {
namespace {

constexpr std::int64_t kDrivers = 200;
constexpr std::uint32_t kSituationsPerDriver = 100;

// A driver with parameters from the model's usual range.
DriverSection AnyDriver(const Random& random, std::int64_t number) {
  DriverSection driver;
  driver.max_acceleration_mps2 = Between(0.3, 3, random.Uniform2(number, 1000)[0]);
  driver.comfortable_deceleration_mps2 = Between(0.5, 4, random.Uniform2(number, 1000)[1]);
  driver.desired_speed_mps = Between(15, 50, random.Uniform2(number, 1001)[0]);
  driver.headway_s = Between(0.5, 3, random.Uniform2(number, 1001)[1]);
  driver.standstill_m = Between(0.5, 5, random.Uniform2(number, 1002)[0]);
  driver.exponent = Between(1, 8, random.Uniform2(number, 1002)[1]);
  driver.max_deceleration_mps2 = 9;
  return driver;
}

struct Situation {
  double speed_mps;
  double preceding_speed_mps;
  double gap_m;
};

Situation AnySituation(const Random& random, std::int64_t driver, std::uint32_t number) {
  const auto [v, vp] = random.Uniform2(driver, 2 * number);
  const auto [s, unused] = random.Uniform2(driver, 2 * number + 1);
  return {60 * v, 60 * vp, 200 * s};
}

// Calls check(driver, situation, u) with u uniform in (0, 1).
template <class Check>
void ForManySituations(Check&& check) {
  const Random random(1, Stream::kLidar);
  for (std::int64_t d = 0; d < kDrivers; ++d) {
    const DriverSection driver = AnyDriver(random, d);
    for (std::uint32_t i = 0; i < kSituationsPerDriver; ++i) {
      check(driver, AnySituation(random, d, i), random.Uniform2(d, 2000 + i)[0]);
    }
  }
}

TEST(IdmPropertyTest, EquilibriumGapNeedsNoAcceleration) {
  ForManySituations([](const DriverSection& driver, const Situation&, double u) {
    const double v = 0.99 * driver.desired_speed_mps * u;
    const double ratio = std::pow(v / driver.desired_speed_mps, driver.exponent);
    const double gap = (driver.standstill_m + v * driver.headway_s) / std::sqrt(1 - ratio);
    // The tolerance is the rounding of terms of size 1, which cancel and are then multiplied by the
    // maximum acceleration.
    ASSERT_NEAR(models::Idm(driver).Acceleration(v, v, gap), 0, 1e-14);
  });
}

TEST(IdmPropertyTest, AccelerationIsFiniteAndBounded) {
  ForManySituations([](const DriverSection& driver, Situation s, double u) {
    const double extreme = std::pow(10.0, Between(-300, 300, u));
    const models::Idm idm(driver);
    for (const Situation& x :
         {s, Situation{extreme, s.preceding_speed_mps, s.gap_m},
          Situation{s.speed_mps, extreme, s.gap_m}, Situation{s.speed_mps, -extreme, s.gap_m},
          Situation{s.speed_mps, s.preceding_speed_mps, extreme},
          Situation{s.speed_mps, s.preceding_speed_mps, -extreme},
          Situation{extreme, -extreme, 1 / extreme}}) {
      const double a = idm.Acceleration(x.speed_mps, x.preceding_speed_mps, x.gap_m);
      ASSERT_GE(a, -driver.max_deceleration_mps2);
      ASSERT_LE(a, driver.max_acceleration_mps2);
    }
  });
}

TEST(IdmPropertyTest, LargerGapNeverMeansLessAcceleration) {
  ForManySituations([](const DriverSection& driver, Situation s, double u) {
    const models::Idm idm(driver);
    const double before = idm.Acceleration(s.speed_mps, s.preceding_speed_mps, s.gap_m);
    const double after = idm.Acceleration(s.speed_mps, s.preceding_speed_mps, s.gap_m * (1.1 + u));
    ASSERT_GE(after, before);
    if (before > -driver.max_deceleration_mps2) {
      ASSERT_GT(after, before);
    }
  });
}

TEST(IdmPropertyTest, FasterDriverNeverAcceleratesMore) {
  // Where v T + v dv / (2 sqrt(a b)) is negative, the IDM's desired gap s* does not depend on the
  // speed v. Then only the free-road term (v/v0)^exponent depends on v. At low speeds rounding may
  // hide its change, so the strict comparison needs more than 5 m/s.
  ForManySituations([](const DriverSection& driver, Situation s, double u) {
    const models::Idm idm(driver);
    const double slow = idm.Acceleration(s.speed_mps, s.preceding_speed_mps, s.gap_m);
    const double fast = idm.Acceleration(s.speed_mps + 0.1 + u, s.preceding_speed_mps, s.gap_m);
    ASSERT_LE(fast, slow);
    if (s.speed_mps > 5 && fast > -driver.max_deceleration_mps2) {
      ASSERT_LT(fast, slow);
    }
  });
}

TEST(IdmPropertyTest, FasterClosingNeverMeansMoreAcceleration) {
  ForManySituations([](const DriverSection& driver, Situation s, double u) {
    const models::Idm idm(driver);
    ASSERT_LE(idm.Acceleration(s.speed_mps, s.preceding_speed_mps - 10 * u, s.gap_m),
              idm.Acceleration(s.speed_mps, s.preceding_speed_mps, s.gap_m));
  });
}

}  // namespace
}  // namespace fogline
