#include "tools/web/server/page.h"

#include <gtest/gtest.h>

#include "tools/web/server/assets.h"

namespace fogline::web {
namespace {

TEST(WhyNoPageTest, IsEmptyIfTheBuildHasTheFilesOfThePage) {
  EXPECT_EQ(WhyNoPage().empty(), !Assets().empty());
}

}  // namespace
}  // namespace fogline::web
