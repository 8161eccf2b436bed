#include "tools/study/paired_worker.h"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/command.h"

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

}  // namespace
}  // namespace fogline
