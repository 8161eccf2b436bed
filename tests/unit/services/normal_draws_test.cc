#include "services/normal_draws.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

namespace fogline {
namespace {

constexpr std::uint32_t kDraw = 3;

/// Expects that the draws are those of this seed, in any order of steps.
void ExpectNumbersOf(std::int64_t seed, NormalDraws& draws) {
  const Random random(seed, Stream::kRadar);
  for (const std::int64_t step : {2, 0, 1, 7, 2, 9, 10, 100'000, 0}) {
    EXPECT_EQ(draws.At(step), random.Normal2(step, kDraw)) << "seed " << seed << " step " << step;
  }
}

NormalDraws DrawsOf(std::int64_t seed, std::int64_t steps = 10) {
  return {Random(seed, Stream::kRadar), kDraw, steps};
}

TEST(NormalDrawsTest, AreTheNumbersOfRandomInEachStepAlsoAfterTheLastOne) {
  for (const std::int64_t steps : {0, 1, 10, 100'000}) {
    NormalDraws draws = DrawsOf(1, steps);
    ExpectNumbersOf(1, draws);
    ExpectNumbersOf(1, draws);
  }
}

TEST(NormalDrawsTest, KeepTheNumbersOfAnotherRunOnlyIfTheyAreTheSame) {
  for (const std::int64_t seed : {1, 2}) {
    for (const std::int64_t steps : {5, 10, 20}) {
      NormalDraws before = DrawsOf(1);
      ExpectNumbersOf(1, before);
      NormalDraws draws = DrawsOf(seed, steps);
      draws.Keep(before);
      ExpectNumbersOf(seed, draws);
    }
  }
  NormalDraws before = DrawsOf(1);
  ExpectNumbersOf(1, before);
  NormalDraws other(Random(1, Stream::kLidar), kDraw, 10);
  other.Keep(before);
  EXPECT_EQ(other.At(0), Random(1, Stream::kLidar).Normal2(0, kDraw));
}

TEST(NormalDrawsTest, OfACopyAreTheSameWhicheverDrawsFirst) {
  NormalDraws draws = DrawsOf(1);
  draws.At(3);
  NormalDraws copy = draws;
  copy.At(5);
  ExpectNumbersOf(1, draws);
  ExpectNumbersOf(1, copy);
  NormalDraws next = DrawsOf(1);
  next.Keep(copy);
  ExpectNumbersOf(1, next);
  ExpectNumbersOf(1, copy);
}

}  // namespace
}  // namespace fogline
