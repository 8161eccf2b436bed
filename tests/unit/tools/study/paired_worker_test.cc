#include "tools/study/paired_worker.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/command.h"
#include "tools/study/comparison.h"

namespace fogline {
namespace {

TEST(PairedWorkerTest, TheRunWithoutTradedControlHasTheMeasuresOfAnotherRunOfItsScenario) {
  for (const char* file : {"paper.json", "dense_fog.json"}) {
    const Scenario none =
        LoadScenario(test::SourceDirectory() / "scenario" / file, {"/arbitrator/policy=none"});
    study::PairedWorker worker;
    const auto runs = worker.Compute(std::array{none, none}, 7);
    const study::RunValues of_baseline = worker.OfBaseline(none);
    ASSERT_EQ(runs.size(), 1U);
    ASSERT_EQ(runs[0].size(), of_baseline.size());
    for (std::size_t i = 0; i < of_baseline.size(); ++i) {
      const bool both_missing = std::isnan(runs[0][i]) && std::isnan(of_baseline[i]);
      EXPECT_TRUE(both_missing || runs[0][i] == of_baseline[i]) << file << ", measure " << i;
    }
  }
}

TEST(PairedWorkerTest, ACarThatNeverClosesInHasAnInfiniteTimeToCollision) {
  // GIVEN a few steps of cars of which each is slower than the car ahead
  const Scenario apart = LoadScenario(
      test::SourceDirectory() / "scenario/paper.json",
      {"/arbitrator/policy=none", "/steps=5", "/lead/profile=constant", "/lead/speed_mps=30",
       "/world/host_speed_mps=20", "/world/follower_speed_mps=10"});
  study::PairedWorker worker;
  const study::RunValues run = worker.Compute(std::array{apart, apart}, 1).front();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(run[study::PlaceOfMetric("min_host_ttc_s")], kInfinite);
  EXPECT_EQ(run[study::PlaceOfMetric("min_follower_ttc_s")], kInfinite);
}

}  // namespace
}  // namespace fogline
