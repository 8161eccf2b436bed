#include "services/log/remains.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/command.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline {
namespace {

TEST(RemainsTest, OfARunInRealtimeHaveTheMessagesOutsideOfStepsThatFollowTheLastStep) {
  const test::ScratchFolder folder;
  const std::string file = folder.File("run.lcm");
  const auto remains = [&file] { return log::ReadRemains(file, log::ReadFront(file)); };
  // The log ends with a STATUS after its last step.
  const log::LogHead whole =
      test::WriteShortLog(file, {.realtime = true, .done = test::kSteps - 1});
  EXPECT_EQ(remains().steps, test::kSteps);
  EXPECT_EQ(remains().head.bytes, whole.bytes);
  EXPECT_EQ(remains().head.events, whole.events);
  // The STATUS of a step that is not complete goes with this step.
  const log::LogHead torn = test::WriteShortLog(
      file, {.realtime = true,
             .has = [](std::string_view channel,
                       std::int64_t step) { return step < 2 || channel == "TRUTH"; },
             .done = 2});
  EXPECT_EQ(remains().steps, 2);
  EXPECT_LT(remains().head.events, torn.events - 1);
}

}  // namespace
}  // namespace fogline
