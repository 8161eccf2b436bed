// Tests that the name of a role determines a stream of random numbers for this role alone.
#include "common/random.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace fogline {
namespace {

TEST(StreamOfTest, DiffersForEachNameAndFromEveryStreamWithANumber) {
  std::set<Stream> streams;
  for (const std::string_view role : {"", "a", "b", "ab", "ba", "thermal", "camera", "radar"}) {
    EXPECT_TRUE(streams.insert(StreamOf(role)).second) << role;
    EXPECT_GT(StreamOf(role), FollowerErrors(1'000'000)) << role;
  }
}

TEST(StreamOfTest, IsTheSameInEveryBuildSoThatDigestsStay) {
  EXPECT_EQ(static_cast<std::uint32_t>(StreamOf("a")), 0xe40c292c);  // FNV-1a of "a"
  EXPECT_NE(Random(1, StreamOf("a")).Uniform2(0, 0), Random(1, StreamOf("b")).Uniform2(0, 0));
}

}  // namespace
}  // namespace fogline
