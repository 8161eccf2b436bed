#include "tools/spy/spy_parts.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/screen.h"

namespace fogline::spy {
namespace {

TEST(WhyNoScreenTest, IsNothingIfAServerListens) {
  const test::Screen screen;
  EXPECT_EQ(WhyNoScreen(screen.display()), "");
  EXPECT_EQ(WhyNoScreen(screen.display() + ".0"), "");
  EXPECT_EQ(WhyNoScreen("unix" + screen.display()), "");
}

TEST(WhyNoScreenTest, NamesTheScreenAtWhichNoServerListens) {
  const std::string display = ":99999999";
  EXPECT_EQ(WhyNoScreen(display), "DISPLAY is \"" + display + "\": No such file or directory");
  EXPECT_EQ(WhyNoScreen(""), "DISPLAY is not set (over ssh: ssh -X)");
}

TEST(WhyNoScreenTest, IsNothingForAnotherMachineWhichIsNotTried) {
  EXPECT_EQ(WhyNoScreen("elsewhere.example:0"), "");
}

}  // namespace
}  // namespace fogline::spy
