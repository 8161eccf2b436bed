#include "services/runtime/seat/seat_instance.h"

#include <cstdint>
#include <set>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(SeatInstanceTest, IsANumberThatNoOtherSeatHasAndNotZero) {
  std::set<std::int64_t> instances;
  for (int i = 0; i < 1000; ++i) instances.insert(runtime::DrawSeatInstance());
  EXPECT_EQ(instances.size(), 1000U);
  EXPECT_FALSE(instances.contains(0));
}

}  // namespace
}  // namespace fogline
