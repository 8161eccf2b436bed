#include "services/arbitrator/arbitrator.h"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "services/decision/policies/policies.h"
#include "tests/support/find_row.h"
#include "tests/unit/services/arbitrator/step_messages.h"

namespace fogline {
namespace {

Messages WithoutLidar() {
  Messages m = Differing(0);
  m.lidar = {};
  return m;
}

Messages WithoutRadar() {
  Messages m = Differing(0);
  m.radar = {};
  return m;
}

Scenario Missing(MissingLidar missing) {
  Scenario scenario;
  scenario.arbitrator.missing_lidar = missing;
  scenario.arbitrator.missing_conflict_m = 5;
  scenario.arbitrator.window_steps = 4;
  return scenario;
}

// The tolerance for a difference between radar and LiDAR. The radar's range is the sum
// 32 + difference. The rounding of this sum loses the last bits of the difference.
constexpr double kRoundingOfRange_m = 1e-14;

TEST(ArbitratorTest, CopiesTheHeader) {
  arbitrator::Arbitrator arbitrator{Scenario()};
  Messages m = Differing(0);
  m.ego.header = {.run_id = 5, .step = 6, .utime = 600'000};
  const arbitration_t& out = Step(arbitrator, m);
  EXPECT_EQ(out.header.run_id, 5);
  EXPECT_EQ(out.header.step, 6);
  EXPECT_EQ(out.header.utime, 600'000);
}

TEST(ArbitratorTest, LetsTheAutomationDriveWhileTheSensorsAgree) {
  arbitrator::Arbitrator arbitrator{Scenario()};
  const arbitration_t& out = Step(arbitrator, Differing(0.1));
  EXPECT_EQ(out.acceleration_mps2, kAutomation_mps2);
  EXPECT_EQ(out.lambda_automation, 1);
  EXPECT_EQ(out.lambda_human, 0);
  EXPECT_EQ(out.mode, arbitration_t::AUTOMATION);
}

TEST(ArbitratorTest, LetsTheHumanDriveWhileTheSensorsDisagree) {
  arbitrator::Arbitrator arbitrator{Scenario()};
  const arbitration_t& out = Step(arbitrator, Differing(2));
  EXPECT_EQ(out.acceleration_mps2, kHuman_mps2);
  EXPECT_EQ(out.lambda_automation, 0);
  EXPECT_EQ(out.lambda_human, 1);
  EXPECT_EQ(out.mode, arbitration_t::HUMAN);
}

TEST(ArbitratorTest, StatesConflictDegreeAndThreshold) {
  Scenario scenario;
  scenario.arbitrator.threshold = 0.8;
  arbitrator::Arbitrator arbitrator(scenario);
  const arbitration_t& out = Step(arbitrator, Differing(-0.75));
  EXPECT_EQ(out.conflict_m, 0.75);
  EXPECT_EQ(out.doc, conflict::DegreeOfConflict(0.75, 10, 1));
  EXPECT_EQ(out.threshold, 0.8);
}

// The automation drives while 0 <= DoC < threshold, so at the threshold the human drives. The
// ranges represent a difference of 1 m exactly, and the DoC of 1 m is exactly 1/2.
TEST(ArbitratorTest, HandsOverExactlyAtTheThreshold) {
  Scenario scenario;
  scenario.arbitrator.threshold = 0.5;
  arbitrator::Arbitrator at(scenario);
  EXPECT_EQ(Step(at, Differing(1)).lambda_human, 1);
  scenario.arbitrator.threshold = std::nextafter(0.5, 1.0);
  arbitrator::Arbitrator above(scenario);
  EXPECT_EQ(Step(above, Differing(1)).lambda_human, 0);
}

TEST(ArbitratorTest, ThresholdZeroAlwaysCallsTheHuman) {
  Scenario scenario;
  scenario.arbitrator.threshold = 0;
  arbitrator::Arbitrator arbitrator(scenario);
  EXPECT_EQ(Step(arbitrator, Differing(0)).lambda_human, 1);
}

TEST(ArbitratorTest, ThresholdOneCallsTheHumanOnlyWhereDocRoundsToOne) {
  Scenario scenario;
  scenario.arbitrator.threshold = 1;
  scenario.arbitrator.window_steps = 1;
  arbitrator::Arbitrator arbitrator(scenario);
  EXPECT_EQ(Step(arbitrator, Differing(4)).lambda_human, 0);
  EXPECT_EQ(Step(arbitrator, Differing(5)).lambda_human, 1);
}

TEST(ArbitratorTest, PolicyNoneNeverCallsTheHumanAndStillMeasures) {
  Scenario scenario;
  scenario.arbitrator.policy = Policy::kNone;
  scenario.arbitrator.threshold = 0;
  arbitrator::Arbitrator arbitrator(scenario);
  const arbitration_t& out = Step(arbitrator, Differing(2));
  EXPECT_EQ(out.lambda_automation, 1);
  EXPECT_EQ(out.acceleration_mps2, kAutomation_mps2);
  EXPECT_EQ(out.mode, arbitration_t::AUTOMATION);
  EXPECT_EQ(out.conflict_m, 2);
  EXPECT_GT(out.doc, 0.99);
}

TEST(ArbitratorTest, PassesAnOfferOnWhateverTheOtherOneIs) {
  arbitrator::Arbitrator arbitrator{Scenario()};
  Messages m = Differing(0);
  m.driver.acceleration_mps2 = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Step(arbitrator, m).acceleration_mps2, kAutomation_mps2);
}

TEST(ArbitratorTest, ReadsTheConflictAsTheScenarioSays) {
  for (const auto& [reading, conflict] : {std::pair{ConflictReading::kMeanOfAbsolute, 1.5},
                                          {ConflictReading::kAbsoluteOfMean, 0.5}}) {
    Scenario scenario;
    scenario.arbitrator.conflict = reading;
    arbitrator::Arbitrator arbitrator(scenario);
    Step(arbitrator, Differing(1));
    EXPECT_EQ(Step(arbitrator, Differing(-2)).conflict_m, conflict);
  }
}

TEST(ArbitratorTest, HoldRepeatsTheLastDifferenceThroughTheSilence) {
  arbitrator::Arbitrator arbitrator(Missing(MissingLidar::kHold));
  Step(arbitrator, Differing(3));
  Step(arbitrator, Differing(1));
  EXPECT_EQ(Step(arbitrator, WithoutLidar()).conflict_m, 5.0 / 3);
  EXPECT_EQ(Step(arbitrator, WithoutRadar()).conflict_m, 1.5);
  // The difference of 3 m has left the window. The window has only the last difference of 1 m and
  // its repetitions.
  EXPECT_EQ(Step(arbitrator, WithoutLidar()).conflict_m, 1.0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(Step(arbitrator, WithoutLidar()).conflict_m, 1.0);
}

TEST(ArbitratorTest, HoldHasNothingToRepeatBeforeTheFirstDifference) {
  arbitrator::Arbitrator arbitrator(Missing(MissingLidar::kHold));
  EXPECT_EQ(Step(arbitrator, WithoutLidar()).conflict_m, 0);
  EXPECT_EQ(Step(arbitrator, WithoutRadar()).conflict_m, 0);
  EXPECT_EQ(Step(arbitrator, Differing(3)).conflict_m, 3);
}

TEST(ArbitratorTest, SkipLetsConflictAgeOutInSilence) {
  arbitrator::Arbitrator arbitrator(Missing(MissingLidar::kSkip));
  Step(arbitrator, Differing(3));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Step(arbitrator, WithoutLidar()).conflict_m, 3);
  const arbitration_t& out = Step(arbitrator, WithoutRadar());
  EXPECT_EQ(out.conflict_m, 0);
  EXPECT_EQ(out.mode, arbitration_t::AUTOMATION);
}

TEST(ArbitratorTest, ConflictTakesSilenceForDisagreement) {
  arbitrator::Arbitrator arbitrator(Missing(MissingLidar::kConflict));
  EXPECT_EQ(Step(arbitrator, WithoutLidar()).conflict_m, 5);
  EXPECT_EQ(Step(arbitrator, Differing(1)).conflict_m, 3);
  const arbitration_t& out = Step(arbitrator, WithoutRadar());
  EXPECT_NEAR(out.conflict_m, 11.0 / 3, kRoundingOfRange_m);
  EXPECT_EQ(out.mode, arbitration_t::HUMAN);
}

// ---- the effect of policies and transfers -------------------------------------------------------

Scenario WithPolicy(std::string_view name) {
  Scenario scenario;
  scenario.arbitrator.policy = test::FindPolicy(name).value();
  scenario.arbitrator.window_steps = 1;
  return scenario;
}

TEST(ArbitratorTest, SharesTheCommandAsThePolicyBlendSays) {
  arbitrator::Arbitrator arbitrator(WithPolicy("blend"));
  const arbitration_t& out = Step(arbitrator, Differing(1));  // half-way in blend's band [0.2, 0.8]
  EXPECT_EQ(out.lambda_human, 0.5);
  EXPECT_EQ(out.lambda_automation, 0.5);
  EXPECT_NEAR(out.acceleration_mps2, (kAutomation_mps2 + kHuman_mps2) / 2, 1e-15);
  EXPECT_EQ(out.threshold, 0.5);
  EXPECT_EQ(out.mode, arbitration_t::HUMAN) << "both have half: the mode is the driver's";
}

TEST(ArbitratorTest, ModeNamesTheSideWithMoreAuthorityDuringATransfer) {
  Scenario scenario = WithPolicy("traded");
  scenario.arbitrator.transfer.profile = TransferProfile::kLinear;
  scenario.arbitrator.transfer.duration_s = 1;
  arbitrator::Arbitrator arbitrator(scenario);
  for (int k = 1; k <= 10; ++k) {
    const arbitration_t& out = Step(arbitrator, Differing(2));
    EXPECT_NEAR(out.lambda_human, k / 10.0, 1e-12);
    EXPECT_EQ(out.mode, k < 5 ? arbitration_t::AUTOMATION : arbitration_t::HUMAN);
    EXPECT_TRUE(arbitrator.wants_human());
  }
}

TEST(ArbitratorTest, LooksAroundForThePoliciesThatWantItAndForNoOther) {
  for (const policies::PolicyRow& row : policies::Policies()) {
    EXPECT_EQ(arbitrator::Arbitrator::UsesOnDemandInput(WithPolicy(row.name)),
              row.needs_surroundings)
        << row.name;
  }
  // GIVEN dense fog and a follower that closes in
  truth_t truth{};
  truth.fog_visibility_m = 50;
  truth.num_followers = 1;
  truth.follower_gap_m = {20};
  truth.follower_speed_mps = {24};
  Messages m = Differing(0);
  m.ego.speed_mps = 20;
  m.driver.readiness = 1;
  arbitrator::Arbitrator arbitrator(WithPolicy("adaptive"));
  EXPECT_EQ(Step(arbitrator, m).threshold, 0.5);
  // WHEN the arbitrator gets this TRUTH THEN its threshold is lower by 0.2. The fog lowers it by
  // 5 m/50 m = 0.1 (gain/visibility), and the follower by 0.5 s/5 s = 0.1 (gain/TTC).
  arbitrator.SetOnDemandInput(truth);
  EXPECT_NEAR(Step(arbitrator, m).threshold, 0.3, 1e-15);
}

TEST(ArbitratorTest, ADegreeOfConflictCanBeMadeOfAnyMeasure) {
  Scenario scenario = WithPolicy("traded");
  scenario.arbitrator.measure = static_cast<MeasureChoice>(test::FindConflictMeasure("nis") -
                                                           conflict::ConflictMeasures().data());
  scenario.arbitrator.measure_slope = 1;
  scenario.arbitrator.measure_centre = 6.63;
  arbitrator::Arbitrator arbitrator(scenario);
  Messages m = Differing(0.5);
  m.radar.range_std_m = m.lidar.range_std_m = 0.1;
  const arbitration_t& out = Step(arbitrator, m);
  EXPECT_NEAR(out.conflict_m, 12.5, 1e-9);  // 0.5^2/(0.1^2 + 0.1^2)
  EXPECT_EQ(out.doc, conflict::DegreeOfConflict(out.conflict_m, 1, 6.63));
  EXPECT_EQ(out.mode, arbitration_t::HUMAN);
}

TEST(ArbitratorTest, GoesOnFromACommandThatWasNotItsOwn) {
  Scenario scenario = WithPolicy("traded");
  scenario.arbitrator.transfer.profile = TransferProfile::kJerkLimited;
  scenario.arbitrator.transfer.jerk_mps3 = 2;
  arbitrator::Arbitrator arbitrator(scenario);
  arbitration_t sent = Step(arbitrator, Differing(0));
  sent.acceleration_mps2 = -3;
  arbitrator.Overrule(sent);
  EXPECT_NEAR(Step(arbitrator, Differing(2)).acceleration_mps2, -2.8, 1e-12);
}

// ---- a policy that shares authority, and a driver that the car must ask -------------------------

class SharedWithTheAskedTest : public testing::Test {
 protected:
  static Scenario Sharing() {
    Scenario scenario;
    scenario.arbitrator.policy = test::FindPolicy("blend").value();
    scenario.arbitrator.window_steps = 1;
    scenario.arbitrator.take_over = {
        .mode = TakeOverMode::kRequested, .time = {.mean_s = 1, .std_s = 1e-3}, .recovery_s = 1};
    return scenario;
  }
  /// One step in which the policy requests this share for the human. @pre share > 0
  const arbitration_t& Requesting(double share) {
    const double doc = 0.2 + 0.6 * share;
    Messages m = Differing(1 + std::log(doc / (1 - doc)) / 10);
    return StepOf(m);
  }
  const arbitration_t& RequestingNothing() {
    Messages m = Differing(0.1);
    return StepOf(m);
  }
  const arbitration_t& StepOf(Messages& m) {
    m.ego.header.step = m.radar.header.step = m.lidar.header.step = step_++;
    m.ego.speed_mps = 20;
    m.driver.readiness = readiness_;
    return Step(arbitrator_, m);
  }

  arbitrator::Arbitrator arbitrator_{Sharing()};
  double readiness_ = 1;
  std::int64_t step_ = 0;
};

TEST_F(SharedWithTheAskedTest, TheDriverIsAskedForAnyShareAndHasItAfterComing) {
  EXPECT_EQ(RequestingNothing().mode, arbitration_t::AUTOMATION);
  EXPECT_EQ(Requesting(0.1).mode, arbitration_t::REQUEST);
  for (int k = 0; k < 11; ++k) {
    EXPECT_EQ(Requesting(0.1).lambda_human, 0) << "the driver has not come";
    EXPECT_TRUE(arbitrator_.must_ask());
  }
  for (const double share : {0.1, 0.3, 0.7, 0.95, 0.4}) {
    const arbitration_t& out = Requesting(share);
    EXPECT_NEAR(out.lambda_human, share, 1e-12);
    EXPECT_NEAR(out.acceleration_mps2, share * kHuman_mps2 + (1 - share) * kAutomation_mps2, 1e-12);
    EXPECT_FALSE(arbitrator_.must_ask());
  }
  // A driver in state RECOVERING is available, so the driver gets each requested share immediately.
  // Here the share is 0.
  EXPECT_EQ(RequestingNothing().lambda_human, 0);
  EXPECT_NEAR(Requesting(0.6).lambda_human, 0.6, 1e-12) << "without being asked again";
}

TEST_F(SharedWithTheAskedTest, TheAutomationHasTheWheelBackWhenNoShareIsRequested) {
  for (int k = 0; k < 40; ++k) Requesting(0.2);
  EXPECT_EQ(Requesting(0.2).mode, arbitration_t::HUMAN) << "recovered, and with a share";
  EXPECT_EQ(RequestingNothing().mode, arbitration_t::AUTOMATION);
  EXPECT_EQ(Requesting(0.2).mode, arbitration_t::REQUEST) << "and the driver must be asked again";
}

TEST_F(SharedWithTheAskedTest, TheDriverDrivesAloneWhileTheAutomationIsGone) {
  for (int k = 0; k < 20; ++k) Requesting(0.2);
  arbitrator_.SetAutomationThere(false);
  EXPECT_EQ(Requesting(0.2).lambda_human, 1);
  arbitrator_.SetAutomationThere(true);
  EXPECT_NEAR(Requesting(0.2).lambda_human, 0.2, 1e-12);
}

TEST_F(SharedWithTheAskedTest, ALateDriverDrivesAloneForTheRestOfTheRun) {
  readiness_ = 0;
  while (Requesting(0.2).mode != arbitration_t::MRM_COMFORT && step_ < 200) {
  }
  readiness_ = 1;
  EXPECT_EQ(Requesting(0.2).mode, arbitration_t::RECOVERING);
  for (int k = 0; k < 50; ++k) ASSERT_EQ(Requesting(0.2).lambda_human, 1);
  EXPECT_EQ(RequestingNothing().lambda_human, 1);
}

}  // namespace
}  // namespace fogline
