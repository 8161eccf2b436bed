#include "services/runtime/coordination/signs_of_life.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr Duration kEvery = milliseconds(200);
// In these tests, a process counts as hanging if ChanceOfLife() is below this value.
constexpr double kUnlikely = 1e-6;

TimePoint At(std::int64_t ms) { return TimePoint(std::chrono::hours(5)) + milliseconds(ms); }

class SignsOfLifeTest : public testing::Test {
 protected:
  /// All roles except `silent` send signs of life regularly. Of every `one_of` signs, one arrives.
  void Speak(Role silent, std::int64_t from_ms, std::int64_t to_ms, std::int64_t one_of = 1) {
    for (std::int64_t ms = from_ms; ms < to_ms; ms += 200) {
      for (const RoleInfo& info : kRoles) {
        if (info.role == silent || (ms / 200) % one_of != 0) continue;
        signs_.Heard(info.role, one_of - 1, At(ms));
      }
    }
  }
  double Chance(Role role, std::int64_t silence_ms) const {
    return signs_.ChanceOfLife(role, milliseconds(silence_ms));
  }
  runtime::SignsOfLife signs_{kEvery};
};

TEST_F(SignsOfLifeTest, AProcessThatIsSilentWhileTheOthersAreHeardHangs) {
  signs_.Heard(Role::kFusion, 0, At(0));
  Speak(Role::kFusion, 10, 1010);
  EXPECT_LT(Chance(Role::kFusion, 1000), kUnlikely);
}

TEST_F(SignsOfLifeTest, WhereNoProcessIsHeardNoneHangs) {
  EXPECT_EQ(Chance(Role::kFusion, 10'000), 1);
  Speak(Role::kRunner, 0, 1000);
  EXPECT_EQ(Chance(Role::kRecorder, 10'000), 1) << "it spoke last";
}

TEST_F(SignsOfLifeTest, AProcessThatFellSilentWithAllOthersMayLive) {
  signs_.Heard(Role::kFusion, 0, At(0));
  // GIVEN a sign of life of each role; that of fusion arrives first. Then the network loses all
  // messages. THEN the silence of fusion does not show that fusion hangs
  Speak(Role::kFusion, 10, 200);
  EXPECT_GT(Chance(Role::kFusion, 1000), 0.1);
  EXPECT_GT(Chance(Role::kFusion, 3000), 0.1);
}

TEST_F(SignsOfLifeTest, OnANetworkThatLosesMuchItTakesLongerToBeSure) {
  signs_.Heard(Role::kFusion, 0, At(0));
  Speak(Role::kFusion, 200, 1000, 3);
  EXPECT_GT(Chance(Role::kFusion, 1000), 0.01);
  Speak(Role::kFusion, 1000, 12'000, 3);
  EXPECT_LT(Chance(Role::kFusion, 12'000), 10 * kUnlikely);
}

TEST_F(SignsOfLifeTest, AFewOthersThatAreSilentTooHideNoHang) {
  for (const Role role : {Role::kFusion, Role::kAcc}) signs_.Heard(role, 0, At(0));
  for (std::int64_t ms = 10; ms < 2010; ms += 200) {
    for (const Role role : {Role::kWorld, Role::kRadar, Role::kLidar})
      signs_.Heard(role, 0, At(ms));
  }
  EXPECT_LT(Chance(Role::kFusion, 2000), kUnlikely);
}

}  // namespace
}  // namespace fogline
