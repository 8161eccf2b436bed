#include "services/arbitrator/transfer.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kStep_s = 0.1;
constexpr arbitrator::Transfer::Offers kOffers{.automation_mps2 = -0.5, .human_mps2 = 1.0};
// Tolerance for the rounding of a sum of a few dozen changes of the command.
constexpr double kRounding = 1e-12;

// The states in `count` steps in which the human shall have the authority `wanted`.
std::vector<arbitrator::Transfer::State> Steps(
    arbitrator::Transfer& transfer, double wanted, int count,
    const arbitrator::Transfer::Offers& offers = kOffers) {
  std::vector<arbitrator::Transfer::State> states;
  for (int i = 0; i < count; ++i) states.push_back(transfer.Step(wanted, offers, -0.5));
  return states;
}

TEST(TransferTest, StepHandsOverAtOnceAndPassesTheOfferOnBitByBit) {
  arbitrator::Transfer transfer(TransferSection{}, kStep_s);
  EXPECT_EQ(Steps(transfer, 0, 1)[0].acceleration_mps2, -0.5);
  const arbitrator::Transfer::State state = Steps(transfer, 1, 1)[0];
  EXPECT_EQ(state.lambda_human, 1);
  EXPECT_EQ(state.acceleration_mps2, 1.0);
}

TEST(TransferTest, PassesAnOfferOnWhateverTheOtherOneIs) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  for (const TransferProfile profile : {TransferProfile::kStep, TransferProfile::kLinear,
                                        TransferProfile::kSigmoid, TransferProfile::kJerkLimited}) {
    arbitrator::Transfer transfer({.profile = profile}, kStep_s);
    EXPECT_EQ(Steps(transfer, 0, 1, {-0.5, kNone})[0].acceleration_mps2, -0.5);
  }
}

TEST(TransferTest, LinearTakesItsDurationThereAndBack) {
  arbitrator::Transfer transfer({.profile = TransferProfile::kLinear, .duration_s = 2}, kStep_s);
  const auto there = Steps(transfer, 1, 21);
  for (int i = 0; i < 20; ++i) {
    EXPECT_NEAR(there[static_cast<std::size_t>(i)].lambda_human, (i + 1) / 20.0, kRounding);
    EXPECT_NEAR(there[static_cast<std::size_t>(i)].acceleration_mps2, -0.5 + 1.5 * (i + 1) / 20.0,
                kRounding);
  }
  EXPECT_EQ(there[20].lambda_human, 1);
  EXPECT_EQ(there[20].acceleration_mps2, 1.0);
  const auto back = Steps(transfer, 0, 21);
  EXPECT_NEAR(back[9].lambda_human, 0.5, kRounding);
  EXPECT_EQ(back[20].lambda_human, 0);
  EXPECT_EQ(back[20].acceleration_mps2, -0.5);
}

TEST(TransferTest, SigmoidIsSymmetricSteepestInTheMiddleAndEndsExactly) {
  arbitrator::Transfer transfer({.profile = TransferProfile::kSigmoid, .duration_s = 2}, kStep_s);
  const auto there = Steps(transfer, 1, 21);
  for (std::size_t i = 0; i < 19; ++i) {
    EXPECT_NEAR(there[i].lambda_human + there[18 - i].lambda_human, 1, 1e-9);
  }
  EXPECT_NEAR(there[9].lambda_human, 0.5, 1e-9);
  EXPECT_GT(there[10].lambda_human - there[9].lambda_human, 2 / 20.0);
  EXPECT_LT(there[0].lambda_human, 1 / 20.0);
  EXPECT_EQ(there[20].lambda_human, 1);
}

TEST(TransferTest, RampsTurnRoundWhereTheyAre) {
  for (const TransferProfile profile : {TransferProfile::kLinear, TransferProfile::kSigmoid}) {
    arbitrator::Transfer transfer({.profile = profile, .duration_s = 1}, kStep_s);
    const double half_way = Steps(transfer, 1, 4).back().lambda_human;
    const double back = Steps(transfer, 0, 1)[0].lambda_human;
    EXPECT_LT(back, half_way);
    EXPECT_GT(back, 0);
    EXPECT_EQ(Steps(transfer, 0, 4).back().lambda_human, 0);
  }
}

TEST(TransferTest, RampsFollowSharedAuthorityToItsValue) {
  for (const TransferProfile profile : {TransferProfile::kLinear, TransferProfile::kSigmoid}) {
    arbitrator::Transfer transfer({.profile = profile, .duration_s = 1}, kStep_s);
    EXPECT_EQ(Steps(transfer, 0.3, 20).back().lambda_human, 0.3);
  }
}

TEST(TransferTest, JerkLimitedGivesAuthorityAtOnceAndLetsTheCommandCatchUp) {
  arbitrator::Transfer transfer({.profile = TransferProfile::kJerkLimited, .jerk_mps3 = 2},
                                kStep_s);
  Steps(transfer, 0, 3);
  const auto states = Steps(transfer, 1, 10);
  EXPECT_EQ(states[0].lambda_human, 1);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(states[i].acceleration_mps2, -0.5 + 0.2 * static_cast<double>(i + 1), kRounding);
  }
  EXPECT_EQ(states[7].acceleration_mps2, 1.0);
  // WHEN the command has reached the offer THEN the jerk limit has ended
  EXPECT_EQ(Steps(transfer, 1, 1, {-0.5, -3.0})[0].acceleration_mps2, -3.0);
}

TEST(TransferTest, TheFirstCommandGoesOnFromWhatTheHostDoes) {
  arbitrator::Transfer transfer({.profile = TransferProfile::kJerkLimited, .jerk_mps3 = 2},
                                kStep_s);
  EXPECT_NEAR(transfer.Step(1, kOffers, 0.1).acceleration_mps2, 0.3, kRounding);
}

TEST(TransferTest, EmergencyBrakingIsObeyedAtOnce) {
  for (const bool gate : {false, true}) {
    arbitrator::Transfer transfer(
        {.profile = TransferProfile::kJerkLimited, .yield_mps2 = 3.5, .gate = gate}, kStep_s);
    Steps(transfer, 0, 3);
    Steps(transfer, 1, 2);
    EXPECT_EQ(Steps(transfer, 1, 1, {-0.5, -4.0})[0].acceleration_mps2, -4.0);
    EXPECT_EQ(Steps(transfer, 1, 1, {-0.5, 0.0})[0].acceleration_mps2, 0.0)
        << "nothing lingers of it";
  }
}

TEST(TransferTest, GateLimitsAccelerationForItsTimeAndJerkUntilTheCommandHasCaughtUp) {
  arbitrator::Transfer transfer(
      {.gate = true, .gate_s = 3, .gate_acceleration_mps2 = 0.5, .gate_jerk_mps3 = 0.5}, kStep_s);
  Steps(transfer, 0, 3);
  const auto gated = Steps(transfer, 1, 30);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(gated[i].acceleration_mps2, -0.5 + 0.05 * static_cast<double>(i + 1), kRounding);
  }
  for (std::size_t i = 20; i < 30; ++i) EXPECT_NEAR(gated[i].acceleration_mps2, 0.5, kRounding);
  const auto free = Steps(transfer, 1, 11);
  EXPECT_NEAR(free[0].acceleration_mps2, 0.55, kRounding);
  EXPECT_EQ(free[10].acceleration_mps2, 1.0);
}

TEST(TransferTest, GoesOnFromWhatWasDecidedElsewhere) {
  arbitrator::Transfer ramp({.profile = TransferProfile::kLinear, .duration_s = 1}, kStep_s);
  ramp.Overrule({.lambda_human = 1, .acceleration_mps2 = 1});
  EXPECT_NEAR(Steps(ramp, 0, 1)[0].lambda_human, 0.9, kRounding);

  arbitrator::Transfer limited({.profile = TransferProfile::kJerkLimited, .jerk_mps3 = 2}, kStep_s);
  Steps(limited, 0, 1);
  limited.Overrule({.lambda_human = 0, .acceleration_mps2 = -3});
  EXPECT_NEAR(Steps(limited, 1, 1)[0].acceleration_mps2, -2.8, kRounding);
}

}  // namespace
}  // namespace fogline
