#include "services/runtime/coordination/send_trouble.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(SendTroubleTest, IsToldByReason) {
  EXPECT_EQ(runtime::Text(std::vector<runtime::SendTrouble>{}), "");
  EXPECT_EQ(runtime::Text({{"world", 3, "Operation not permitted"},
                           {"lidar", 1, "Network is unreachable"},
                           {"runner", 12, "Operation not permitted"}}),
            "world 3, runner 12 (Operation not permitted); lidar 1 (Network is unreachable)");
}

}  // namespace
}  // namespace fogline
