// Every role that was started by hand is killed and started again in one run.
#include "tests/integration/hosts/by_hand.h"

#include <gtest/gtest.h>

namespace fogline::test {
namespace {

TEST_F(ByHandTest, EachRoleMayBeStartedAgainInTheMiddle) {
  ExpectEachMayBeStartedAgain(RolesByHand(), "5");
}

}  // namespace
}  // namespace fogline::test
