#include "services/metrics/take_over/take_over_accumulator.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "services/host_modes.h"

namespace fogline {
namespace {

using metrics::TakeOverEnd;
using metrics::TakeOverMeasures;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::int64_t kStep_us = 500'000;  // 1/2 s is a power of two: all times are exact

/// A step of the host. By default the host drives at 20 m/s, 30 m behind a car of the same speed.
struct HostStep {
  std::int8_t mode = arbitration_t::AUTOMATION;
  double speed_mps = 20;
  double acceleration_mps2 = 0;  // applied before the step
  double gap_m = 30;
  double lead_mps = 20;
  bool fog = false;
  double offer_mps2 = 0;  // of the driver
  bool without_command = false;
  bool excludes = false;  // the policy excludes the LiDAR
  bool without_track = false;
};

/// The measures of a run of these steps. @param k the first step
metrics::TakeOverAccumulator Accumulated(const std::vector<HostStep>& steps, std::int64_t k = 0) {
  metrics::TakeOverAccumulator accumulator;
  for (const HostStep& step : steps) {
    truth_t truth{};
    truth.header.step = k;
    truth.header.utime = k++ * kStep_us;
    truth.host_speed_mps = step.speed_mps;
    truth.host_acceleration_mps2 = step.acceleration_mps2;
    truth.host_gap_m = step.gap_m;
    truth.preceding_speed_mps = step.lead_mps;
    truth.fog_present = step.fog ? 1 : 0;
    arbitration_t command{};
    command.header = truth.header;
    command.mode = step.mode;
    command.lambda_human = HumanDrives(step.mode) ? 1 : 0;
    track_t track{};
    if (step.excludes) track.usage[2] = track_t::DISTRUSTED;
    accumulator.Add(truth, step.without_command ? nullptr : &command,
                    step.without_track ? nullptr : &track, step.offer_mps2);
  }
  return accumulator;
}

std::vector<TakeOverMeasures> Measured(const std::vector<HostStep>& steps) {
  return Accumulated(steps).Result();
}

std::vector<TakeOverMeasures> MeasuredModes(const std::vector<std::int8_t>& modes) {
  std::vector<HostStep> steps;
  for (const std::int8_t mode : modes) steps.push_back({.mode = mode});
  return Measured(steps);
}

TEST(TakeOverAccumulatorTest, HasNothingWithoutARequest) {
  EXPECT_THAT(MeasuredModes({arbitration_t::AUTOMATION, arbitration_t::HUMAN,
                             arbitration_t::AUTOMATION, arbitration_t::MINIMAL_RISK}),
              IsEmpty());
}

TEST(TakeOverAccumulatorTest, MeasuresTheTimesFromTheRequest) {
  const auto requests = Measured({{},
                                  {},
                                  {.mode = arbitration_t::REQUEST},
                                  {.mode = arbitration_t::REQUEST_URGENT},
                                  {.mode = arbitration_t::HANDOVER},
                                  {.mode = arbitration_t::RECOVERING},
                                  {.mode = arbitration_t::RECOVERING, .offer_mps2 = -1},
                                  {.mode = arbitration_t::RECOVERING, .offer_mps2 = -1},
                                  {.mode = arbitration_t::HUMAN, .offer_mps2 = -1},
                                  {}});
  ASSERT_THAT(requests, SizeIs(1));
  const TakeOverMeasures& request = requests[0];
  EXPECT_EQ(request.outcome, TakeOverEnd::kTakenOver);
  EXPECT_EQ(request.requested_s, 1.0);
  EXPECT_EQ(request.reaction_time_s, 1.0);
  EXPECT_EQ(request.take_over_time_s, 1.5);
  EXPECT_EQ(request.effective_input_time_s, 2.0);
  EXPECT_EQ(request.manoeuvre_time_s, std::nullopt);
  EXPECT_EQ(request.judged_s, 3.0);
  EXPECT_EQ(request.first_movement_time_s, std::nullopt);
  EXPECT_EQ(request.pedal_on_time_s, std::nullopt);
}

TEST(TakeOverAccumulatorTest, JudgesTheMotionFromTheRequestToTheRecovery) {
  // The values before the request and after the recovery are worse than all others. The measures
  // must not contain these values.
  const auto requests = Measured(
      {{},
       {.gap_m = 1, .lead_mps = 0},
       {.mode = arbitration_t::REQUEST, .speed_mps = 20, .acceleration_mps2 = 0, .lead_mps = 15},
       {.mode = arbitration_t::REQUEST, .speed_mps = 19, .acceleration_mps2 = -2},
       {.mode = arbitration_t::HANDOVER, .speed_mps = 18, .acceleration_mps2 = -2},
       {.mode = arbitration_t::RECOVERING,
        .speed_mps = 18,
        .acceleration_mps2 = -1,
        .gap_m = 9,
        .lead_mps = 15},
       {.mode = arbitration_t::RECOVERING, .speed_mps = 18, .acceleration_mps2 = 1},
       {.mode = arbitration_t::HUMAN, .speed_mps = 16, .acceleration_mps2 = -5},
       {.mode = arbitration_t::HUMAN, .acceleration_mps2 = -9, .gap_m = 1, .lead_mps = 0},
       {.mode = arbitration_t::HUMAN, .acceleration_mps2 = 9, .gap_m = 1, .lead_mps = 0}});
  ASSERT_THAT(requests, SizeIs(1));
  const TakeOverMeasures& request = requests[0];
  EXPECT_EQ(request.speed_at_request_mps, 20);
  EXPECT_EQ(request.max_deceleration_mps2, 5);
  EXPECT_EQ(request.mean_deceleration_mps2, 2.5) << "(2 + 2 + 1 + 5) / 4";
  EXPECT_EQ(request.max_abs_jerk_1s_mps3, 4) << "from -1 at 2.5 s to -5 at 3.5 s";
  EXPECT_EQ(request.min_ttc_s, 3) << "9 m at a closing speed of 3 m/s";
  EXPECT_EQ(request.min_time_gap_s, 0.5) << "9 m at 18 m/s";
}

TEST(TakeOverAccumulatorTest, KnowsHowLongEachSideDrove) {
  // GIVEN a request during which a sensor is excluded for 1 s. The sensor is also excluded before
  // the request and while the driver drives. This time does not count.
  const auto requests = Measured({{.excludes = true},
                                  {.mode = arbitration_t::REQUEST},
                                  {.mode = arbitration_t::REQUEST, .excludes = true},
                                  {.mode = arbitration_t::EMERGENCY_BRAKING, .excludes = true},
                                  {.mode = arbitration_t::MRM_COMFORT},
                                  {.without_command = true},
                                  {.mode = arbitration_t::RECOVERING, .excludes = true},
                                  {.mode = arbitration_t::HUMAN},
                                  {.mode = arbitration_t::HUMAN}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].automation_drove_s, 1.5);
  EXPECT_EQ(requests[0].sensor_excluded_s, 1.0);
  EXPECT_EQ(requests[0].manoeuvre_drove_s, 1.0);
  EXPECT_EQ(requests[0].driver_drove_s, 0.5);
  EXPECT_EQ(requests[0].judged_s, 3.0);
}

TEST(TakeOverAccumulatorTest, KeepsTheExcludedSensorIfATrackIsMissing) {
  const auto requests = Measured({{},
                                  {.mode = arbitration_t::REQUEST, .excludes = true},
                                  {.mode = arbitration_t::REQUEST, .without_track = true},
                                  {.mode = arbitration_t::REQUEST},
                                  {.mode = arbitration_t::HUMAN}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].sensor_excluded_s, 1.0);
  EXPECT_EQ(requests[0].automation_drove_s, 1.5);
}

TEST(TakeOverAccumulatorTest, CountsASecondThatBeginsBeforeTheRequestForTheJerk) {
  const auto requests = Measured({{},
                                  {.acceleration_mps2 = 3},
                                  {.mode = arbitration_t::REQUEST, .acceleration_mps2 = 3},
                                  {.mode = arbitration_t::REQUEST, .acceleration_mps2 = -3}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].max_abs_jerk_1s_mps3, 6);
}

TEST(TakeOverAccumulatorTest, HasNoMeanDecelerationOfAHostThatNeverSlowsDown) {
  const auto requests = Measured(
      {{.mode = arbitration_t::REQUEST}, {.mode = arbitration_t::REQUEST, .acceleration_mps2 = 1}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].max_deceleration_mps2, 0);
  EXPECT_EQ(requests[0].mean_deceleration_mps2, std::nullopt);
  EXPECT_EQ(requests[0].min_ttc_s, std::nullopt);
}

TEST(TakeOverAccumulatorTest, HasTheSpeedAtTheBeginOfTheFogInWhichTheRequestIs) {
  const auto requests = Measured({{.fog = true},
                                  {},
                                  {.speed_mps = 25, .fog = true},
                                  {.speed_mps = 24, .fog = true},
                                  {.mode = arbitration_t::REQUEST, .speed_mps = 23, .fog = true}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].speed_at_fog_mps, 25);
  EXPECT_EQ(requests[0].speed_at_request_mps, 23);
}

TEST(TakeOverAccumulatorTest, HasTheSpeedAtTheBeginOfTheFirstFogAfterARequestInClearAir) {
  const auto requests = Measured({{.speed_mps = 25, .fog = true},
                                  {.mode = arbitration_t::REQUEST},
                                  {.mode = arbitration_t::REQUEST, .speed_mps = 18, .fog = true},
                                  {.mode = arbitration_t::REQUEST},
                                  {.mode = arbitration_t::REQUEST, .speed_mps = 16, .fog = true}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].speed_at_fog_mps, 18);
}

TEST(TakeOverAccumulatorTest, HasNoSpeedAtAFogThatEndsBeforeTheRequestOrBeginsAfterTheEnd) {
  const auto requests = Measured(
      {{.fog = true}, {}, {.mode = arbitration_t::REQUEST}, {}, {.speed_mps = 9, .fog = true}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].speed_at_fog_mps, std::nullopt);
}

TEST(TakeOverAccumulatorTest, KnowsHowARequestEnds) {
  using enum TakeOverEnd;
  using A = arbitration_t;
  const auto outcome = [](std::vector<std::int8_t> modes) {
    modes.insert(modes.begin(), A::REQUEST);
    return MeasuredModes(modes).at(0).outcome;
  };
  EXPECT_EQ(outcome({}), kOpen);
  EXPECT_EQ(outcome({A::REQUEST_URGENT, A::HANDOVER}), kOpen);
  EXPECT_EQ(outcome({A::HANDOVER, A::RECOVERING}), kTakenOver);
  EXPECT_EQ(outcome({A::REQUEST_URGENT, A::MRM_COMFORT}), kMinimalRisk);
  EXPECT_EQ(outcome({A::MRM_EMERGENCY, A::MRM_DONE}), kMinimalRisk);
  EXPECT_EQ(outcome({A::MRM_EMERGENCY, A::MRM_FAILED}), kMinimalRisk);
  EXPECT_EQ(outcome({A::MRM_COMFORT, A::RECOVERING, A::HUMAN}), kTakenOverLate);
  EXPECT_EQ(outcome({A::MINIMAL_RISK}), kMinimalRisk);
  EXPECT_EQ(outcome({A::AUTOMATION}), kWithdrawn);
  EXPECT_EQ(outcome({A::HANDOVER, A::AUTOMATION, A::HUMAN}), kWithdrawn);
  EXPECT_EQ(outcome({A::HUMAN}), kFallback);
  EXPECT_EQ(outcome({A::HANDOVER, A::RECOVERING, A::MINIMAL_RISK}), kTakenOver);
}

TEST(TakeOverAccumulatorTest, KeepsARequestWhileEmergencyBrakingHidesIt) {
  const auto requests = MeasuredModes({arbitration_t::REQUEST, arbitration_t::EMERGENCY_BRAKING,
                                       arbitration_t::EMERGENCY_BRAKING, arbitration_t::HANDOVER});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].outcome, TakeOverEnd::kOpen);
  EXPECT_EQ(requests[0].reaction_time_s, 1.5);
  EXPECT_EQ(requests[0].judged_s, 1.5);
}

TEST(TakeOverAccumulatorTest, JudgesAManoeuvreUntilTheCarStands) {
  const auto stop = [](std::int8_t mode, double speed_mps) {
    return HostStep{.mode = mode, .speed_mps = speed_mps, .acceleration_mps2 = -4};
  };
  for (const std::int8_t last : {arbitration_t::MRM_DONE, arbitration_t::MINIMAL_RISK}) {
    const std::int8_t mode =
        last == arbitration_t::MRM_DONE ? arbitration_t::MRM_COMFORT : arbitration_t::MINIMAL_RISK;
    const auto requests = Measured({{.mode = arbitration_t::REQUEST},
                                    stop(mode, 4),
                                    stop(mode, 2),
                                    stop(last, 0),
                                    stop(last, 0),
                                    stop(last, 0)});
    ASSERT_THAT(requests, SizeIs(1));
    EXPECT_EQ(requests[0].judged_s, 1.5) << int{last};
  }
  const auto requests = MeasuredModes({arbitration_t::REQUEST, arbitration_t::MRM_COMFORT});
  EXPECT_EQ(requests.at(0).manoeuvre_time_s, 0.5);
}

TEST(TakeOverAccumulatorTest, KeepsTheMeasuresOfSeveralRequestsApart) {
  const auto requests = Measured({{.mode = arbitration_t::REQUEST, .gap_m = 10},
                                  {.mode = arbitration_t::HANDOVER, .gap_m = 10},
                                  {.mode = arbitration_t::RECOVERING, .gap_m = 10},
                                  {.mode = arbitration_t::HUMAN},
                                  {},
                                  {.mode = arbitration_t::REQUEST, .speed_mps = 15},
                                  {.mode = arbitration_t::REQUEST},
                                  {.mode = arbitration_t::HANDOVER}});
  ASSERT_THAT(requests, SizeIs(2));
  EXPECT_EQ(requests[0].outcome, TakeOverEnd::kTakenOver);
  EXPECT_EQ(requests[0].reaction_time_s, 0.5);
  EXPECT_EQ(requests[0].min_time_gap_s, 0.5);
  EXPECT_EQ(requests[1].outcome, TakeOverEnd::kOpen);
  EXPECT_EQ(requests[1].requested_s, 2.5);
  EXPECT_EQ(requests[1].reaction_time_s, 1.0);
  EXPECT_EQ(requests[1].min_time_gap_s, 1.5);
  EXPECT_EQ(requests[1].take_over_time_s, std::nullopt);
}

TEST(TakeOverAccumulatorTest, GoesWithoutTheCommandsOfAStepThatHasNone) {
  const auto requests = Measured({{.mode = arbitration_t::REQUEST},
                                  {.gap_m = 10, .without_command = true},
                                  {.mode = arbitration_t::HANDOVER}});
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].reaction_time_s, 1.0);
  EXPECT_EQ(requests[0].min_time_gap_s, 0.5) << "the situation of this step counts";
}

TEST(TakeOverAccumulatorTest, ALogThatIsCutOffLeavesTheEndOfItsLastRequestOpen) {
  using A = arbitration_t;
  const auto cut = [](const std::vector<std::int8_t>& modes) {
    std::vector<HostStep> steps;
    for (const std::int8_t mode : modes) steps.push_back({.mode = mode});
    const metrics::TakeOverAccumulator accumulated = Accumulated(steps);
    std::vector<TakeOverMeasures> requests = accumulated.Result();
    accumulated.CutOff(requests);
    return requests.back();
  };
  EXPECT_EQ(cut({A::REQUEST, A::HANDOVER}).outcome, TakeOverEnd::kUnknown);
  EXPECT_EQ(cut({A::REQUEST, A::MRM_COMFORT}).outcome, TakeOverEnd::kUnknown);
  EXPECT_EQ(cut({A::REQUEST, A::MRM_COMFORT, A::MRM_DONE}).outcome, TakeOverEnd::kMinimalRisk);
  EXPECT_EQ(cut({A::REQUEST, A::MINIMAL_RISK}).outcome, TakeOverEnd::kMinimalRisk) << "it lasts";
  EXPECT_EQ(cut({A::REQUEST, A::HANDOVER, A::RECOVERING}).outcome, TakeOverEnd::kTakenOver);
  EXPECT_EQ(cut({A::REQUEST, A::AUTOMATION}).outcome, TakeOverEnd::kWithdrawn);
  // The judged interval ends when the driver has recovered, which is after the end of the log. So
  // the measures of this interval are unknown.
  EXPECT_EQ(cut({A::REQUEST, A::HANDOVER, A::RECOVERING}).judged_s, std::nullopt);
  EXPECT_EQ(cut({A::REQUEST, A::HANDOVER, A::RECOVERING}).driver_drove_s, std::nullopt);
  EXPECT_EQ(cut({A::REQUEST, A::HANDOVER, A::RECOVERING}).reaction_time_s, 0.5);
  EXPECT_EQ(cut({A::REQUEST, A::RECOVERING, A::HUMAN}).judged_s, 1.0);
  EXPECT_EQ(metrics::NameOf(TakeOverEnd::kUnknown), "unknown");
}

TEST(TakeOverAccumulatorTest, LeavesOutARequestThatBeganBeforeTheLog) {
  const auto late = Accumulated({{.mode = arbitration_t::REQUEST},
                                 {.mode = arbitration_t::HANDOVER},
                                 {.mode = arbitration_t::RECOVERING},
                                 {.mode = arbitration_t::HUMAN},
                                 {},
                                 {.mode = arbitration_t::REQUEST},
                                 {.mode = arbitration_t::HANDOVER}},
                                4);
  EXPECT_TRUE(late.BeganInRequest());
  ASSERT_THAT(late.Result(), SizeIs(1));
  EXPECT_EQ(late.Result()[0].requested_s, 4.5);
  EXPECT_EQ(late.Result()[0].reaction_time_s, 0.5);
}

TEST(TakeOverAccumulatorTest, DoesNotKnowTheSpeedAtTheBeginningOfAFogThatTheLogLacks) {
  const std::vector<HostStep> steps{{.speed_mps = 21, .fog = true},
                                    {.mode = arbitration_t::REQUEST, .speed_mps = 22, .fog = true},
                                    {.mode = arbitration_t::REQUEST},
                                    {.mode = arbitration_t::REQUEST, .speed_mps = 23, .fog = true},
                                    {},
                                    {.mode = arbitration_t::REQUEST, .speed_mps = 24, .fog = true}};
  const auto speeds = [&](std::int64_t first) {
    std::vector<std::optional<double>> found;
    for (const TakeOverMeasures& request : Accumulated(steps, first).Result()) {
      found.push_back(request.speed_at_fog_mps);
    }
    return found;
  };
  EXPECT_EQ(speeds(0), (std::vector<std::optional<double>>{21, 24}));
  EXPECT_EQ(speeds(7), (std::vector<std::optional<double>>{std::nullopt, 24}));
}

TEST(TakeOverMeasuresTest, AreNamedWithTheirUnits) {
  std::set<std::string> names;
  metrics::VisitTakeOver(TakeOverMeasures(), [&](std::string_view name, const auto&,
                                                 std::string_view unit, std::string_view what) {
    EXPECT_FALSE(what.empty()) << name;
    std::string end = "_" + std::string(unit);
    std::erase_if(end, [](char c) { return c == '/'; });
    const auto per = end.find("ms");
    if (per != std::string::npos) end.replace(per, 2, "mps");
    EXPECT_TRUE(name.ends_with(end)) << name << " in " << unit;
    names.emplace(name);
  });
  EXPECT_THAT(names, SizeIs(19));
}

TEST(TakeOverMeasuresTest, HaveADistinctNameForEachOutcome) {
  using enum TakeOverEnd;
  std::set<std::string_view> names;
  for (const TakeOverEnd end :
       {kOpen, kTakenOver, kTakenOverLate, kMinimalRisk, kWithdrawn, kFallback, kUnknown}) {
    names.insert(metrics::NameOf(end));
  }
  EXPECT_THAT(names, SizeIs(7));
  EXPECT_FALSE(names.contains(""));
}

}  // namespace
}  // namespace fogline
