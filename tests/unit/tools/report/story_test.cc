#include "tools/report/story.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/report/example_runs.h"

namespace fogline {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

/// A run of 101 steps of 0.1 s. Three cars are 30 m apart; their safe distance is 25 m.
report::ReportRun CalmRun(Policy policy, double threshold = 0.5) {
  report::ReportRun run;
  run.name =
      policy == Policy::kNone ? "without traded control" : fmt::format("threshold {:g}", threshold);
  run.seed = 1;
  run.scenario.arbitrator.policy = policy;
  run.scenario.arbitrator.threshold = threshold;
  run.samples.resize(101);
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    metrics::Sample& sample = run.samples[i];
    sample.step = static_cast<std::int64_t>(i);
    sample.time_s = 0.1 * static_cast<double>(i);
    sample.host_gap_m = sample.lidar_range_m = sample.fused_distance_m = 30;
    sample.follower_gap_m = 30;
    sample.follower_safe_distance_m = 25;
  }
  run.samples.back().last = true;
  return run;
}

/// Adds fog from 2 s to 5 s. In this fog the LiDAR's range is too short by `short_m`.
void AddFog(report::ReportRun& run, double short_m) {
  for (std::size_t i = 20; i < 50; ++i) {
    run.samples[i].fog_present = true;
    run.samples[i].lidar_range_m -= short_m;
  }
}

void CollideAt(report::ReportRun& run, std::size_t step, std::int8_t who) {
  run.samples.resize(step + 1);
  run.samples.back().collision = who;
  run.samples.back().collision_time_s = run.samples.back().time_s;
}

TEST(StoryTest, TellsOfFogOfItsConsequenceAndOfEveryThreshold) {
  EXPECT_THAT(
      report::StoryOf(ExampleRuns()),
      MatchesRegex(
          "In fog from 19 s to 30 s the LiDAR read up to 0\\.[0-9]+ m short and had no echo "
          "for 0\\.2 s; without traded control the following car came [0-9.]+ [cm]?m too "
          "close \\([0-9.]+ [cm]?m on average in the fog\\) and the host slowed down by [0-9.]+ "
          "m/s; "
          "at threshold 0\\.2 the human drove all the time and 100 % of that was avoided, which "
          "leaves [0-9a-z. ]+; at threshold 0\\.5 the human drove for [0-9.]+ s and 81 % of that "
          "was avoided, which leaves (less than )?[0-9.]+ [cm]?m on average; at threshold 0\\.8 "
          "the human drove "
          "for [0-9.]+ s and 10 % of that was avoided, which leaves (less than )?[0-9.]+ [cm]?m on "
          "average\\."));
}

TEST(StoryTest, HasTheNumbersOfTheSamples) {
  std::vector<report::ReportRun> runs{CalmRun(Policy::kNone), CalmRun(Policy::kTraded)};
  for (report::ReportRun& run : runs) AddFog(run, 0.216);
  runs[0].samples[40].follower_gap_m = 25 - 0.0388;
  for (std::size_t i = 22; i < 40; ++i) runs[1].samples[i].lambda_human = 1;
  runs[1].si_pct = 80.8;
  EXPECT_EQ(
      report::StoryOf(runs),
      "In fog from 2 s to 5 s the LiDAR read up to 0.22 m short; without traded control the "
      "following car came 3.9 cm too close (1 mm on average in the fog); at threshold 0.5 the "
      "human drove for 1.8 s and 81 % of that was avoided, which leaves nothing.");
  runs[1].si_pct = -12.4;
  runs[1].samples[41].follower_gap_m = 25 - 1.5;
  runs[0].samples[19].host_speed_mps = 20;  // before the fog
  for (std::size_t i = 20; i < 50; ++i) runs[0].samples[i].host_speed_mps = 19;
  runs[0].samples[30].host_speed_mps = 18.9534;
  const std::string story = report::StoryOf(runs);
  EXPECT_THAT(story,
              HasSubstr("(1 mm on average in the fog) and the host slowed down by 0.047 m/s;"));
  EXPECT_THAT(story, HasSubstr("1.8 s and that got 12 % worse, which leaves 5.0 cm on average."));
}

TEST(StoryTest, TellsOfARunWithoutAPairByItself) {
  report::ReportRun run = CalmRun(Policy::kTraded, 0.8);
  AddFog(run, 0.05);
  EXPECT_EQ(report::StoryOf({&run, 1}),
            "In fog from 2 s to 5 s the LiDAR was never more than 0.10 m wrong; at threshold 0.8 "
            "the human never drove and the following car never came too close.");
  for (metrics::Sample& sample : run.samples) sample.lambda_human = 1;
  run.samples[30].follower_gap_m = 25 - 0.004;
  EXPECT_THAT(report::StoryOf({&run, 1}),
              HasSubstr("the human drove all the time and the following car "
                        "came 4 mm too close."));
}

TEST(StoryTest, TellsOfClearAirAndOfNoFollowingCar) {
  report::ReportRun run = CalmRun(Policy::kNone);
  EXPECT_EQ(report::StoryOf({&run, 1}),
            "There was no fog; without traded control the following car never came too close.");
  for (metrics::Sample& sample : run.samples)
    sample.follower_gap_m = sample.follower_safe_distance_m = kNone;
  EXPECT_EQ(report::StoryOf({&run, 1}),
            "There was no fog; without traded control no car collided.");
}

TEST(StoryTest, TellsOfCollisionsBeforeAllElse) {
  std::vector<report::ReportRun> runs{CalmRun(Policy::kNone), CalmRun(Policy::kTraded)};
  CollideAt(runs[0], 60, truth_t::COLLISION_HOST);
  runs[1].si_pct = 90;
  EXPECT_EQ(report::StoryOf(runs),
            "There was no fog; without traded control the host hit the preceding car at 6 s; at "
            "threshold 0.5 the human never drove and no car collided.");
  CollideAt(runs[1], 75, truth_t::COLLISION_FOLLOWER);
  EXPECT_THAT(report::StoryOf(runs), HasSubstr("and a following car hit the car ahead at 7.5 s."));
}

TEST(StoryTest, HasTheFogOfTheRunThatLastsLongest) {
  std::vector<report::ReportRun> runs{CalmRun(Policy::kNone), CalmRun(Policy::kTraded)};
  for (report::ReportRun& run : runs) AddFog(run, 12.25);
  CollideAt(runs[0], 30, truth_t::COLLISION_FOLLOWER);
  EXPECT_THAT(report::StoryOf(runs),
              StartsWith("In fog from 2 s to 5 s the LiDAR read up to 12 m short; "
                         "without traded control a following car hit the car ahead "
                         "at 3 s; "));
}

TEST(StoryTest, ComparesNoRunWhoseLogEndsEarly) {
  std::vector<report::ReportRun> runs{CalmRun(Policy::kNone), CalmRun(Policy::kTraded)};
  runs[1].si_pct = 34;
  runs[1].name = "threshold 0.5, cut.lcm";
  EXPECT_THAT(report::StoryOf(runs),
              HasSubstr("at threshold 0.5, cut.lcm, the human never drove and 34 % "
                        "of that was avoided."));
  runs[1].shortage = "ends after step 100 of 500";
  EXPECT_THAT(report::StoryOf(runs),
              HasSubstr("the human never drove and the following car never came too "
                        "close."));
}

TEST(StoryTest, SumsUpMoreRunsThanASentenceCanName) {
  std::vector<report::ReportRun> runs{CalmRun(Policy::kNone)};
  for (const double threshold : {0.1, 0.3, 0.5, 0.7}) {
    report::ReportRun& run = runs.emplace_back(CalmRun(Policy::kTraded, threshold));
    for (std::size_t i = 0; i < 10; ++i) run.samples[i].lambda_human = threshold < 0.4 ? 1 : 0;
    run.si_pct = 100 * threshold;
  }
  EXPECT_EQ(report::StoryOf(runs),
            "There was no fog; without traded control the following car never came too close; in 4 "
            "runs with traded control the human drove for 0 to 1 s and 10 to 70 % of that was "
            "avoided.");
  CollideAt(runs[4], 75, truth_t::COLLISION_FOLLOWER);
  EXPECT_THAT(report::StoryOf(runs), HasSubstr("; in 1 of them a car collided."));
}

TEST(StoryTest, HasASentenceForEachSituationUpToThreeAndOneForMore) {
  std::vector<report::ReportRun> runs;
  for (std::int64_t seed = 1; seed <= 3; ++seed) {
    report::ReportRun& run = runs.emplace_back(CalmRun(Policy::kNone));
    run.seed = run.scenario.seed = seed;
  }
  EXPECT_THAT(report::StoryOf(runs), AllOf(StartsWith("Seed 1: There was no fog; "),
                                           HasSubstr(" Seed 3: There was no fog; ")));
  runs[2].scenario_title = "Elsewhere";
  EXPECT_THAT(report::StoryOf(runs), HasSubstr(" Elsewhere, seed 3: There was no fog; "));
  report::ReportRun& run = runs.emplace_back(CalmRun(Policy::kTraded));
  run.seed = run.scenario.seed = 4;
  run.samples[10].follower_gap_m = 24.5;
  EXPECT_EQ(
      report::StoryOf(runs),
      "In 1 of 4 runs, of 4 situations, the following car came too close, by up to 0.50 m; the "
      "human drove for 0 s; in 0 runs a car collided.");
}

TEST(StoryTest, SaysThatLogsEndEarlyAndTellsNothingOfRunsWithoutSteps) {
  report::ReportRun run = CalmRun(Policy::kNone);
  run.shortage = "ends after step 100 of 500";
  EXPECT_THAT(report::StoryOf({&run, 1}), StartsWith("As far as the logs go: There was no fog"));
  run.samples.clear();
  EXPECT_EQ(report::StoryOf({&run, 1}), "");
  EXPECT_EQ(report::StoryOf({}), "");
}

}  // namespace
}  // namespace fogline
