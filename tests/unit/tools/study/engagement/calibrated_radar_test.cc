#include "tools/study/engagement/calibrated_radar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

using ::testing::ElementsAre;

Scenario Load(const char* file, const std::vector<std::string>& overrides = {}) {
  return LoadScenario(test::SourceDirectory() / "scenario" / file, overrides);
}

TEST(CalibratedRadarTest, SubtractsTheOffsetOfPaperJson) {
  EXPECT_THAT(study::CalibratedRadar(Load("paper.json")),
              ElementsAre("/radar/bias_m=0", "/arbitrator/doc_centre_m=0.0540000",
                          "/acc/standstill_m=4.4445"));
}

TEST(CalibratedRadarTest, KeepsTheGapOfStepZero) {
  EXPECT_DOUBLE_EQ(study::StandstillWithoutOffset(Load("dense_fog.json")), 3);
  EXPECT_DOUBLE_EQ(study::StandstillWithoutOffset(Load("paper.json", {"/acc/headway_s=2"})), 0)
      << "no gap below 0";
}

}  // namespace
}  // namespace fogline
