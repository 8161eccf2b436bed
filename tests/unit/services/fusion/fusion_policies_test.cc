// The policies that influence the fusion.
#include <string_view>

#include <gtest/gtest.h>

#include "services/decision/policies/policies.h"
#include "services/fusion/fusion.h"
#include "tests/support/find_row.h"
#include "tests/unit/services/fusion/fusion_messages.h"

namespace fogline::test {
namespace {

Scenario WithPolicy(std::string_view name) {
  Scenario scenario;
  scenario.arbitrator.policy = FindPolicy(name).value();
  return scenario;
}

TEST(FusionPoliciesTest, IsolateLeavesOutALidarThatRangesTheFogAndShowsItsInnovation) {
  fusion::Fusion believing(WithPolicy("traded"));
  fusion::Fusion isolating(WithPolicy("isolate"));
  int k = 0;
  for (; k < 20; ++k) {
    Step(believing, At(k));
    Step(isolating, At(k));
  }
  // WHEN the LiDAR sees the fog THEN the track follows the radar's range
  Messages fog = At(k);
  fog.lidar.range_m = 4;
  EXPECT_LT(Step(believing, fog).state[0], 29);
  const track_t& track = Step(isolating, fog);
  EXPECT_NEAR(track.state[0], 30, 1e-9);
  EXPECT_EQ(track.usage[0], track_t::USED);
  EXPECT_EQ(track.usage[1], track_t::USED);
  EXPECT_EQ(track.usage[2], track_t::DISTRUSTED);
  EXPECT_NEAR(track.innovation[2], -26, 1e-9);
  EXPECT_GT(track.innovation_variance[2], 0);
  // WHEN the LiDAR sees the car again THEN the track uses the LiDAR again
  EXPECT_EQ(Step(isolating, At(++k)).usage[2], track_t::USED);
}

TEST(FusionPoliciesTest, IsolateDoesWithoutARadarThatIsWrong) {
  fusion::Fusion fusion(WithPolicy("isolate"));
  int k = 0;
  for (; k < 20; ++k) Step(fusion, At(k));
  Messages ghost = At(k);
  ghost.radar.range_m = 60;
  ghost.radar.range_rate_mps = 15;
  const track_t& track = Step(fusion, ghost);
  EXPECT_EQ(track.usage[0], track_t::DISTRUSTED);
  EXPECT_EQ(track.usage[1], track_t::DISTRUSTED) << "the whole radar";
  EXPECT_EQ(track.usage[2], track_t::USED);
  EXPECT_NEAR(track.state[0], 30, 1e-9);
}

TEST(FusionPoliciesTest, OracleIsToldTheTruthAndStartsAndGoesOnWithTheBestSensor) {
  for (const policies::PolicyRow& row : policies::Policies()) {
    EXPECT_EQ(fusion::Fusion::UsesOnDemandInput(WithPolicy(row.name)), row.name == "oracle")
        << row.name;
  }
  fusion::Fusion fusion(WithPolicy("oracle"));
  truth_t truth{};
  truth.host_gap_m = 30;
  for (int k = 0; k < 20; ++k) {
    Messages m = At(k, 31);
    m.lidar.range_m = 29.9;
    fusion.SetOnDemandInput(truth);
    const track_t& track = Step(fusion, m);
    EXPECT_EQ(track.state[0], 29.9);
    EXPECT_EQ(track.usage[2], track_t::USED);
    EXPECT_EQ(track.usage[0], track_t::DISTRUSTED) << "step " << k;
    EXPECT_EQ(track.usage[1], track_t::DISTRUSTED) << "step " << k;
  }
}

}  // namespace
}  // namespace fogline::test
