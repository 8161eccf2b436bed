// Properties of the exact integration of a car's motion, on random motions.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/models/vehicle/motion.h"

namespace fogline {
namespace {

constexpr int kCases = 20'000;

// Random motions, from a range that contains those of cars: 0 to 60 m/s, -12 to 12 m/s2, steps up
// to 2 s.
class Cases {
 public:
  double Speed() { return Between(0.0, 60.0); }
  double Acceleration() { return Between(-12.0, 12.0); }
  double Duration() { return Between(1e-3, 2.0); }
  double Between(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine_);
  }

 private:
  std::mt19937_64 engine_{20240917};
};

TEST(MotionProperty, SplittingAStepChangesNothing) {
  Cases cases;
  for (int i = 0; i < kCases; ++i) {
    const models::Motion from{cases.Between(-1e3, 1e3), cases.Speed()};
    const double a = cases.Acceleration();
    const double duration_s = cases.Duration();
    const models::Motion whole = models::Advance(from, a, duration_s);
    const models::Motion halves =
        models::Advance(models::Advance(from, a, duration_s / 2), a, duration_s / 2);
    // The tolerance covers a few roundings of numbers up to 1e3. It is 1e-12 (relative).
    EXPECT_NEAR(halves.position_m, whole.position_m, 1e-12 * 1e3);
    EXPECT_NEAR(halves.speed_mps, whole.speed_mps, 1e-12 * 60.0);
  }
}

TEST(MotionProperty, WorkEqualsTheChangeOfEnergy) {
  Cases cases;
  for (int i = 0; i < kCases; ++i) {
    const double v = cases.Speed();
    const double a = cases.Acceleration();
    const models::Motion to = models::Advance({0.0, v}, a, cases.Duration());
    EXPECT_NEAR(a * to.position_m, 0.5 * (to.speed_mps * to.speed_mps - v * v),
                1e-12 * (v * v + 1.0));
  }
}

TEST(MotionProperty, SpeedIsNeverNegativeAndCarsNeverGoBackwards) {
  Cases cases;
  for (int i = 0; i < kCases; ++i) {
    models::Motion car{0.0, cases.Speed()};
    for (int step = 0; step < 10; ++step) {
      const models::Motion next = models::Advance(car, cases.Acceleration(), cases.Duration());
      ASSERT_GE(next.speed_mps, 0.0);
      ASSERT_GE(next.position_m, car.position_m);
      car = next;
    }
  }
}

TEST(ContactProperty, IsTheFirstMomentAtWhichTheGapIsClosed) {
  Cases cases;
  int contacts = 0;
  for (int i = 0; i < kCases; ++i) {
    const double gap_m = cases.Between(0.1, 60.0);
    const double v_ahead = cases.Speed();
    const double a_ahead = cases.Acceleration();
    const double v_behind = cases.Speed();
    const double a_behind = cases.Acceleration();
    const double duration_s = cases.Between(0.1, 10.0);
    const auto gap_at = [&](double t) {
      return gap_m + models::Advance({0.0, v_ahead}, a_ahead, t).position_m -
             models::Advance({0.0, v_behind}, a_behind, t).position_m;
    };
    const auto contact_s =
        models::TimeToContact(gap_m, v_ahead, a_ahead, v_behind, a_behind, duration_s);
    const double open_until_s = contact_s.value_or(duration_s);
    if (contact_s) {
      ++contacts;
      ASSERT_LE(*contact_s, duration_s);
      // The tolerance covers a few roundings of distances up to 1e3 m.
      EXPECT_NEAR(gap_at(*contact_s), 0.0, 1e-9);
    }
    constexpr int kProbes = 50;
    for (int k = 0; k < kProbes; ++k) {
      EXPECT_GT(gap_at(open_until_s * k / kProbes), 0.0) << "case " << i << " probe " << k;
    }
  }
  EXPECT_GT(contacts, kCases / 10) << "the cases must have contacts to say something";
  EXPECT_LT(contacts, kCases - kCases / 10);
}

}  // namespace
}  // namespace fogline
