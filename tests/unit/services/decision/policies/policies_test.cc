// The table of policies, and the decisions of each policy.
#include "services/decision/policies/policies.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "scenario/sections/decision.h"
#include "services/decision/policies/availability.h"
#include "tests/support/find_row.h"
#include "tests/unit/services/decision/policies/example_policy.h"

namespace fogline {
namespace {

using testing::HasSubstr;

std::string WithPolicy(std::string_view name) {
  return R"({"version": 1, "arbitrator": {"policy": ")" + std::string(name) + R"("}})";
}

/// The parts of an ArbitratorView that a test can change.
struct Situation {
  double doc = 0.6;
  double threshold = 0.5;
  double lambda_human = 0;
  ego_t ego{};
  track_t track{};
  accel_command_t automation{};
  driver_command_t driver{};
  policies::Surroundings surroundings;

  Situation() {
    ego.speed_mps = 20;
    driver.readiness = 1;
  }
  policies::ArbitratorView View() const {
    return {doc, threshold, lambda_human, ego, track, automation, driver, surroundings};
  }
};

policies::EngagementRequest Decide(std::string_view policy, const Situation& situation,
                                   const Scenario& scenario = {}) {
  return policies::RowOf(test::FindPolicy(policy).value()).make(scenario)->Decide(situation.View());
}

policies::SensorSelection SelectSensors(std::string_view policy, const policies::FusionView& view,
                                        const Scenario& scenario = {}) {
  return policies::RowOf(test::FindPolicy(policy).value()).make(scenario)->SelectSensors(view);
}

constexpr policies::SensorSelection kBoth{.radar = true, .lidar = true};
constexpr policies::SensorSelection kRadarAlone{.radar = true, .lidar = false};
constexpr policies::SensorSelection kLidarAlone{.radar = false, .lidar = true};

// ---- the table ----------------------------------------------------------------------------------

TEST(PoliciesTest, EveryRowIsAChoiceOfTheScenarioWithItsNameAndText) {
  const std::string schema = ScenarioSchema();
  const std::string explained = ExplainField("/arbitrator/policy");
  std::set<std::string_view> names;
  for (const policies::PolicyRow& row : policies::Policies()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    const Scenario scenario = ParseScenario(WithPolicy(row.name), "test");
    EXPECT_EQ(&policies::RowOf(scenario.arbitrator.policy), &row);
    EXPECT_EQ(test::FindPolicy(row.name), scenario.arbitrator.policy);
    const std::string quoted = '"' + std::string(row.name) + '"';
    EXPECT_THAT(PrintScenario(scenario), HasSubstr("\"policy\": " + quoted));
    EXPECT_THAT(schema, HasSubstr(quoted));
    const std::string doc(
        ChoiceNames<Policy>::kDocs[static_cast<std::size_t>(scenario.arbitrator.policy)]);
    EXPECT_THAT(schema, HasSubstr(doc));
    EXPECT_THAT(explained, HasSubstr(doc));
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"none", "traded", "isolate", "oracle", "blend",
                                            "adaptive", "bayes", "availability"}));
}

TEST(PoliciesTest, AMisspeltNameIsAnsweredWithTheNearestOfTheTable) {
  try {
    ParseScenario(WithPolicy("isolat"), "test");
    FAIL() << "it is no policy";
  } catch (const ScenarioError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean \"isolate\"?"));
  }
}

TEST(PoliciesTest, KnowsTheTraitsOfEachPolicy) {
  // The list has only the policies that this file tests. Each other policy has tests of its own.
  for (const std::string_view name : {"none", "traded", "isolate", "oracle", "blend", "adaptive",
                                      "bayes", "availability", "traded_isolating"}) {
    const policies::PolicyRow& row = policies::RowOf(test::FindPolicy(name).value());
    const auto is = [&](std::initializer_list<std::string_view> names) {
      return std::ranges::find(names, row.name) != names.end();
    };
    EXPECT_EQ(row.selects_sensors, is({"isolate", "oracle", "availability", "traded_isolating"}))
        << row.name;
    EXPECT_EQ(row.needs_true_gap, is({"oracle"})) << row.name;
    EXPECT_EQ(row.needs_surroundings, is({"adaptive", "bayes", "availability"})) << row.name;
    EXPECT_EQ(row.shares, is({"blend"})) << row.name;
  }
}

// For a policy with a simple rule (not Rule::kOwn), the arbitrator applies the rule itself. It does
// not call the policy. So the rule and the policy must decide the same.
TEST(PoliciesTest, ASimpleRuleIsWhatThePolicyDecides) {
  int simple = 0;
  for (const policies::PolicyRow& row : policies::Policies()) {
    if (row.rule == policies::Rule::kOwn) continue;
    ++simple;
    const auto policy = row.make({});
    Situation situation;
    for (const double doc : {0.0, 0.3, std::nextafter(0.5, 0), 0.5, 0.9, 1.0}) {
      situation.doc = doc;
      const policies::EngagementRequest decided = policy->Decide(situation.View());
      const policies::EngagementRequest rule = row.rule == policies::Rule::kNever
                                                   ? policies::StayAutomated(0.5)
                                                   : policies::Compare(doc, 0.5);
      EXPECT_EQ(decided.lambda_human, rule.lambda_human) << row.name << ' ' << doc;
      EXPECT_EQ(decided.threshold, rule.threshold) << row.name;
      EXPECT_EQ(decided.firm, rule.firm) << row.name;
    }
  }
  EXPECT_GE(simple, 5);
}

TEST(PoliciesTest, ThePapersIsTheDefault) {
  EXPECT_EQ(policies::RowOf(Scenario().arbitrator.policy).name, "traded");
}

// ---- each policy --------------------------------------------------------------------------------

TEST(PoliciesTest, NoneIsolateAndOracleStayAutomatedWhateverTheConflict) {
  Situation situation;
  situation.doc = 1;
  for (const char* policy : {"none", "isolate", "oracle"}) {
    const policies::EngagementRequest request = Decide(policy, situation);
    EXPECT_EQ(request.lambda_human, 0) << policy;
    EXPECT_EQ(request.threshold, 0.5) << policy;
    EXPECT_TRUE(request.firm) << policy;
  }
}

TEST(PoliciesTest, TradedHandsOverAtTheThresholdItself) {
  Situation situation;
  situation.doc = 0.5;
  EXPECT_EQ(Decide("traded", situation).lambda_human, 1);
  EXPECT_FALSE(Decide("traded", situation).firm);
  situation.doc = std::nextafter(0.5, 0);
  EXPECT_EQ(Decide("traded", situation).lambda_human, 0);
}

TEST(PoliciesTest, BlendSharesInProportionToTheConflict) {
  Situation situation;
  for (const auto& [doc, lambda] : {std::pair{0.1, 0.0}, {0.2, 0.0}, {0.5, 0.5}, {0.9, 1.0}}) {
    situation.doc = doc;
    const policies::EngagementRequest request = Decide("blend", situation);
    EXPECT_NEAR(request.lambda_human, lambda, 1e-15) << doc;
    EXPECT_EQ(request.threshold, 0.5);
    EXPECT_TRUE(request.firm);
  }
}

TEST(PoliciesTest, AdaptiveMovesTheThresholdWithEachPartOfTheSituation) {
  constexpr double kRounding = 1e-15;
  Situation calm;
  EXPECT_EQ(Decide("adaptive", calm).threshold, 0.5);
  Situation unready = calm;
  unready.driver.readiness = 0.5;
  EXPECT_NEAR(Decide("adaptive", unready).threshold, 0.5 + 0.4 * 0.5, kRounding);
  Situation fog = calm;
  fog.surroundings.visibility_m = 50;
  EXPECT_NEAR(Decide("adaptive", fog).threshold, 0.5 - 5.0 / 50, kRounding);
  Situation followed = calm;
  followed.surroundings.followed = true;
  followed.surroundings.follower_gap_m = 20;
  followed.surroundings.follower_speed_mps = 24;  // TTC 5 s
  EXPECT_NEAR(Decide("adaptive", followed).threshold, 0.5 - 0.5 / 5, kRounding);
  Situation braking = calm;
  braking.ego.acceleration_mps2 = -1;
  EXPECT_NEAR(Decide("adaptive", braking).threshold, 0.5 - 0.1, kRounding);
}

TEST(PoliciesTest, AdaptiveKeepsItsThresholdWithinItsLimits) {
  Situation unready;
  unready.threshold = 1;
  unready.driver.readiness = 0;
  EXPECT_EQ(Decide("adaptive", unready).threshold, 0.9);
  Situation touching;
  touching.surroundings = {.followed = true, .follower_gap_m = -1, .follower_speed_mps = 60};
  EXPECT_EQ(Decide("adaptive", touching).threshold, 0.3);
}

TEST(PoliciesTest, BayesWeighsTheExpectedCosts) {
  Situation calm;  // in bayes.h: C_h = 1, C_a = 1
  EXPECT_EQ(Decide("bayes", calm).threshold, 0.5);
  Situation unready = calm;
  unready.driver.readiness = 0;  // C_h = 4
  EXPECT_EQ(Decide("bayes", unready).threshold, 4.0 / 5);
  Situation fog = calm;
  fog.surroundings.visibility_m = 80;  // C_h = 1.5
  EXPECT_EQ(Decide("bayes", fog).threshold, 1.5 / 2.5);
  fog.surroundings.visibility_m = 10;  // near_m/MOR is limited to 1: C_h = 2
  EXPECT_EQ(Decide("bayes", fog).threshold, 2.0 / 3);
  Situation followed = calm;
  followed.surroundings = {.followed = true, .follower_gap_m = 32, .follower_speed_mps = 24};
  EXPECT_EQ(Decide("bayes", followed).threshold, 1 / 3.5);  // TTC 8 s: C_a = 1 + 3/2
  followed.surroundings.follower_gap_m = 4;  // TTC 1 s, near_ttc/TTC is limited to 1: C_a = 4
  EXPECT_EQ(Decide("bayes", followed).threshold, 1.0 / 5);
}

// ---- availability -------------------------------------------------------------------------------

TEST(TimeUntilHardBrakingTest, IsThatOfHandWorkedCases) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  // The follower needs 100/6 m to brake from 10 m/s at 3 m/s2. The gap is 50 m. So the follower may
  // drive the other 33.3 m at 10 m/s before it has to brake.
  EXPECT_NEAR(policies::TimeUntilHardBraking(50, 10, 0, 3), (50 - 100.0 / 6) / 10, 1e-12);
  EXPECT_EQ(policies::TimeUntilHardBraking(10, 10, 0, 3), 0) << "too near already";
  EXPECT_EQ(policies::TimeUntilHardBraking(0, -1, 0, 3), 0) << "touching";
  EXPECT_EQ(policies::TimeUntilHardBraking(50, 0, 0, 3), kNever);
  EXPECT_EQ(policies::TimeUntilHardBraking(50, -5, 0, 3), kNever);
}

TEST(TimeUntilHardBrakingTest, SolvesItsOwnEquation) {
  for (const double gap_m : {5.0, 30.0, 80.0}) {
    for (const double closing_mps : {-8.0, -1.0, 0.0, 1.0, 4.0}) {
      for (const double braking_mps2 : {0.1, 1.0, 3.0}) {
        const double t = policies::TimeUntilHardBraking(gap_m, closing_mps, braking_mps2, 3);
        ASSERT_TRUE(std::isfinite(t));
        const double speed = closing_mps + braking_mps2 * t;
        const double gap = gap_m - closing_mps * t - braking_mps2 * t * t / 2;
        EXPECT_GE(speed, 0);
        EXPECT_NEAR(speed * speed / (2 * gap), 3, 1e-9)
            << gap_m << ' ' << closing_mps << ' ' << braking_mps2;
      }
    }
  }
}

// Take-over time: mean 2.7 s, deviation 1.45 s, 95th percentile 5.44 s. If the driver is not ready,
// the driver needs 2 s more.
TEST(PoliciesTest, AvailabilityCallsOnlyADriverWhoCanBeThereInTime) {
  const auto followed = [](double time_s) {
    Situation situation;  // closing at 10 m/s
    situation.surroundings = {
        .followed = true, .follower_gap_m = 10 * time_s + 100.0 / 6, .follower_speed_mps = 30};
    return situation;
  };
  EXPECT_EQ(Decide("availability", followed(6)).lambda_human, 1);
  EXPECT_EQ(Decide("availability", followed(5)).lambda_human, 0);
  EXPECT_TRUE(Decide("availability", followed(5)).firm);
  Situation unready = followed(7);
  unready.driver.readiness = 0;
  EXPECT_EQ(Decide("availability", unready).lambda_human, 0);
  Situation driving = followed(1);
  driving.lambda_human = 1;
  EXPECT_EQ(Decide("availability", driving).lambda_human, 1) << "the driver is there";
  Situation calm = followed(20);
  calm.doc = 0.4;
  EXPECT_EQ(Decide("availability", calm).lambda_human, 0) << "DoC below the threshold";
  EXPECT_EQ(Decide("availability", Situation()).lambda_human, 1) << "no car behind";
}

TEST(PoliciesTest, AvailabilityDoesNotCountTimeBeyondItsHorizon) {
  Scenario scenario;
  scenario.arbitrator.availability.horizon_s = 5;  // shorter than the take-over time
  Situation followed;
  followed.surroundings = {.followed = true, .follower_gap_m = 200, .follower_speed_mps = 30};
  EXPECT_EQ(Decide("availability", followed).lambda_human, 1);
  EXPECT_EQ(Decide("availability", followed, scenario).lambda_human, 0);
}

// ---- in the fusion ------------------------------------------------------------------------------

constexpr conflict::Evidence kLidarShort{
    .radar = {true, 40, 0.1}, .lidar = {true, 4, 0.02}, .prediction = {true, 40.1, 0.05}};
constexpr conflict::Evidence kRadarLong{
    .radar = {true, 43, 0.1}, .lidar = {true, 40, 0.02}, .prediction = {true, 40, 0.05}};
constexpr conflict::Evidence kAgreeing{
    .radar = {true, 40.05, 0.1}, .lidar = {true, 40.01, 0.02}, .prediction = {true, 40, 0.05}};

TEST(PoliciesTest, ThreePoliciesDropTheSensorThatThePredictionBlames) {
  for (const char* policy : {"isolate", "availability", "traded_isolating"}) {
    EXPECT_EQ(SelectSensors(policy, {kLidarShort, {}}), kRadarAlone) << policy;
    EXPECT_EQ(SelectSensors(policy, {kRadarLong, {}}), kLidarAlone) << policy;
    EXPECT_EQ(SelectSensors(policy, {kAgreeing, {}}), kBoth) << policy;
  }
}

// The fusion and the arbitrator each have an instance of the policy. The fusion's instance does not
// know what the arbitrator's instance decides about the driver.
TEST(PoliciesTest, AvailabilityDropsTheSensorWhetherTheDriverIsCalledOrNot) {
  const auto policy = policies::RowOf(test::FindPolicy("availability").value()).make({});
  Situation available;
  Situation late;
  late.surroundings = {.followed = true, .follower_gap_m = 5, .follower_speed_mps = 30};
  for (const auto& [situation, called] : {std::pair{available, 1.0}, {late, 0.0}}) {
    EXPECT_EQ(policy->Decide(situation.View()).lambda_human, called);
    EXPECT_EQ(policy->SelectSensors({kLidarShort, {}}), kRadarAlone) << called;
    EXPECT_EQ(policy->SelectSensors({kAgreeing, {}}), kBoth) << called;
  }
}

TEST(PoliciesTest, IsolateDropsNoSensorWithoutAWitnessAndNeverBoth) {
  conflict::Evidence alone = kLidarShort;
  alone.prediction = {};
  EXPECT_EQ(SelectSensors("isolate", {alone, {}}), kBoth);
  ASSERT_EQ(Scenario{}.arbitrator.measure_offset_m, 0);
  conflict::Evidence both_off{
      .radar = {true, 60, 0.02}, .lidar = {true, 20, 0.02}, .prediction = {true, 40, 0.05}};
  EXPECT_EQ(SelectSensors("isolate", {both_off, {}}), kBoth) << "both are equally wrong";
  both_off.lidar.range_m = 15;
  EXPECT_EQ(SelectSensors("isolate", {both_off, {}}), kRadarAlone)
      << "the LiDAR is more wrong, although both blames round to 1";
}

TEST(PoliciesTest, IsolateTakesTheMeasureOfBlameThatTheScenarioNames) {
  for (const conflict::BlameMeasureRow& row : conflict::BlameMeasures()) {
    Scenario scenario;
    scenario.arbitrator.blame = static_cast<BlameChoice>(&row - conflict::BlameMeasures().data());
    scenario.arbitrator.blame_threshold = 0.6;
    const auto policy = policies::RowOf(test::FindPolicy("isolate").value()).make(scenario);
    policies::SensorSelection selection;
    for (int i = 0; i < 5; ++i) selection = policy->SelectSensors({kLidarShort, {}});
    EXPECT_EQ(selection, kRadarAlone) << row.name;
  }
}

TEST(PoliciesTest, OracleTakesTheNearerToTheTruth) {
  EXPECT_EQ(SelectSensors("oracle", {kLidarShort, 40}), kRadarAlone);
  EXPECT_EQ(SelectSensors("oracle", {kLidarShort, 5}), kLidarAlone);
  conflict::Evidence no_lidar = kLidarShort;
  no_lidar.lidar.valid = false;
  EXPECT_EQ(SelectSensors("oracle", {no_lidar, 5}), kBoth) << "there is no choice";
  EXPECT_EQ(SelectSensors("oracle", {kLidarShort, {}}), kBoth) << "nothing was heard";
}

// ---- the example of the README ------------------------------------------------------------------

constexpr policies::PolicyRow kExample = policies::RowFor<policies::Cautious>("cautious");

TEST(ExamplePolicyTest, IsAPolicyLikeAnyOther) {
  const auto policy = kExample.make({});
  EXPECT_FALSE(kExample.selects_sensors);
  Situation situation;
  situation.doc = 0.1;
  EXPECT_EQ(policy->Decide(situation.View()).lambda_human, 1) << "no track";
  situation.track.valid = 1;
  EXPECT_EQ(policy->Decide(situation.View()).lambda_human, 0);
  situation.doc = 0.6;
  EXPECT_EQ(policy->Decide(situation.View()).lambda_human, 1);
}

TEST(ExamplePolicyTest, StandsInTheReadmeAsItIsBuiltHere) {
  const auto read = [](const std::string& path) {
    std::ifstream file(std::string(FOGLINE_SOURCE_DIR) + path);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string readme = read("/services/decision/policies/README.md");
  EXPECT_THAT(readme, HasSubstr(read("/tests/unit/services/decision/policies/example_policy.h")));
  EXPECT_THAT(readme, HasSubstr(R"({"cautious", "as traded, and while the track is uncertain"})"));
  EXPECT_THAT(readme, HasSubstr(R"(RowFor<Cautious>("cautious"))"));
}

}  // namespace
}  // namespace fogline
