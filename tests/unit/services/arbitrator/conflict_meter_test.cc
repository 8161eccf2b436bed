#include "services/arbitrator/conflict_meter.h"

#include <string>

#include <gtest/gtest.h>

#include "services/decision/conflict/conflict_measures.h"
#include "services/decision/conflict/over_time/lidar_modes.h"
#include "tests/support/find_row.h"
#include "tests/support/input_errors.h"

namespace fogline {
namespace {

struct SensorMessages {
  radar_t radar{};
  lidar_t lidar{};
  track_t track{};
};

// Radar 40 m and LiDAR 38 m, with standard deviations of 0.1 m; prediction 39.9 m, with 0.05 m.
SensorMessages DifferingSensors() {
  SensorMessages m;
  m.radar.valid = m.lidar.valid = 1;
  m.radar.range_m = 40;
  m.lidar.range_m = 38;
  m.radar.range_std_m = m.lidar.range_std_m = 0.1;
  m.track.valid = 1;
  m.track.usage[0] = m.track.usage[2] = track_t::USED;
  m.track.innovation[0] = 0.1;
  m.track.innovation_variance[0] = 0.05 * 0.05 + 0.4 * 0.4;
  return m;
}

Scenario With(std::string_view measure) {
  Scenario scenario;
  scenario.fusion.radar_range_std_m = 0.4;
  scenario.arbitrator.measure = static_cast<MeasureChoice>(test::FindConflictMeasure(measure) -
                                                           conflict::ConflictMeasures().data());
  return scenario;
}

TEST(ConflictMeterTest, GivesEachMeasureTheEvidenceOfTheMessages) {
  const SensorMessages m = DifferingSensors();
  const conflict::Evidence evidence{
      .radar = {true, 40, 0.1}, .lidar = {true, 38, 0.1}, .prediction = {true, 39.9, 0.05}};
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    if (row.name == "doc") continue;
    const Scenario scenario = With(row.name);
    arbitrator::ConflictMeter meter(scenario);
    meter.Observe(m.radar, m.lidar, m.track);
    const auto measure = row.make(policies::ConflictParametersOf(scenario.arbitrator));
    // The meter adds a variance and subtracts it again, which causes rounding.
    EXPECT_NEAR(meter.conflict(), measure->Step(evidence), 1e-9 * (1 + meter.conflict()))
        << row.name;
  }
}

TEST(ConflictMeterTest, MakesADegreeOfConflictOfAnyScore) {
  Scenario scenario = With("nis");
  scenario.arbitrator.measure_slope = 0.5;
  scenario.arbitrator.measure_centre = 10;
  const SensorMessages m = DifferingSensors();
  arbitrator::ConflictMeter meter(scenario);
  meter.Observe(m.radar, m.lidar, m.track);
  EXPECT_NEAR(meter.conflict(), 200, 1e-9);  // 2^2/(0.1^2 + 0.1^2)
  EXPECT_EQ(meter.DocOf(10), 0.5);
  EXPECT_EQ(meter.DocOf(12), conflict::DegreeOfConflict(12, 0.5, 10));
}

TEST(ConflictMeterTest, TakesNoWitnessOfAnotherStep) {
  SensorMessages m = DifferingSensors();
  arbitrator::ConflictMeter meter(With("witness_nis"));
  m.radar.header.step = m.lidar.header.step = 5;
  m.track.header.step = 4;
  meter.Observe(m.radar, m.lidar, m.track);
  EXPECT_EQ(meter.conflict(), 0);
  m.track.header.step = 5;
  meter.Observe(m.radar, m.lidar, m.track);
  EXPECT_GT(meter.conflict(), 100);
}

TEST(ConflictMeterTest, TakesTheKnownOffsetOffAllMeasuresButThePapers) {
  Scenario scenario = With("nis");
  scenario.arbitrator.measure_offset_m = 2;
  const SensorMessages m = DifferingSensors();
  arbitrator::ConflictMeter meter(scenario);
  meter.Observe(m.radar, m.lidar, m.track);
  EXPECT_EQ(meter.conflict(), 0);
  scenario.arbitrator.measure = MeasureChoice::kDoc;
  arbitrator::ConflictMeter paper(scenario);
  paper.Observe(m.radar, m.lidar, m.track);
  EXPECT_EQ(paper.conflict(), 2);
}

TEST(ConflictMeterTest, TakesAPosteriorForTheDegreeOfConflictItself) {
  Scenario scenario = With("lidar_modes");
  scenario.arbitrator.measure_scale = MeasureScale::kProbability;
  SensorMessages m = DifferingSensors();
  arbitrator::ConflictMeter meter(scenario);
  conflict::LidarModeConflict posterior(policies::ConflictParametersOf(scenario.arbitrator));
  for (const double lidar_m : {40.0, 39.8, 4.0, 40.0}) {
    m.lidar.range_m = lidar_m;
    meter.Observe(m.radar, m.lidar, m.track);
    const double score =
        posterior.Step({policies::StatedBy(m.radar), policies::StatedBy(m.lidar), {}});
    EXPECT_EQ(meter.DocOf(meter.conflict()), score) << lidar_m;
  }
  EXPECT_TRUE(meter.is_posterior());
  scenario.arbitrator.measure_scale = MeasureScale::kLogistic;
  EXPECT_FALSE(arbitrator::ConflictMeter(scenario).is_posterior());
}

TEST(ConflictMeterTest, RefusesToTakeAnyOtherScoreForAProbability) {
  for (const conflict::ConflictMeasureRow& row : conflict::ConflictMeasures()) {
    Scenario scenario = With(row.name);
    scenario.arbitrator.measure_scale = MeasureScale::kProbability;
    if (row.name == "lidar_modes") {
      EXPECT_NO_THROW(arbitrator::ConflictMeter{scenario});
      continue;
    }
    EXPECT_EQ(test::ErrorOf([&] { const arbitrator::ConflictMeter meter(scenario); }),
              "/arbitrator/measure_scale: \"probability\" needs a measure whose score is a "
              "probability, such as \"lidar_modes\"; /arbitrator/measure is \"" +
                  std::string(row.name) + "\"");
  }
}

}  // namespace
}  // namespace fogline
