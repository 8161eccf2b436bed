#include "scenario/sections/field_text.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(FieldTextTest, NamesWhatAFieldAllows) {
  EXPECT_EQ(Allowed(NumberSpec{.min = 0, .max = 70, .unit = "m/s"}), "a number in [0, 70] m/s");
  EXPECT_EQ(Allowed(IntegerSpec{.min = 1, .max = 60, .unit = ""}), "an integer in [1, 60]");
  EXPECT_EQ(Allowed(IntegerSpec{.min = 1, .max = 1, .unit = ""}), "1");
}

}  // namespace
}  // namespace fogline
