// All roles except the recorder are started by hand, in different orders.
#include "tests/integration/hosts/by_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

namespace fogline::test {
namespace {

/// The order in which a test starts the roles and the run: how many roles it starts before the run,
/// and whether it starts the last role of the graph first.
struct StartOrder {
  std::string name;
  std::size_t before_the_run;
  bool backwards;
};
void PrintTo(const StartOrder& order, std::ostream* out) { *out << order.name; }

class StartOrderTest : public ByHandTest, public testing::WithParamInterface<StartOrder> {};

TEST_P(StartOrderTest, DoesNotMatter) {
  const Lab lab(3);
  std::vector<std::string> roles = RolesByHand();
  if (GetParam().backwards) std::ranges::reverse(roles);
  for (std::size_t i = 0; i < GetParam().before_the_run; ++i) Start(lab, roles[i]);
  Background run(RunOfAll(lab));
  ASSERT_TRUE(run.WaitForErr("waiting for the ")) << run.Err();
  for (std::size_t i = GetParam().before_the_run; i < roles.size(); ++i) Start(lab, roles[i]);
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed());
  ExpectAllLeave();
}

INSTANTIATE_TEST_SUITE_P(OfRoles, StartOrderTest,
                         testing::Values(StartOrder{"RunFirst", 0, false},
                                         StartOrder{"RunFirstBackwards", 0, true},
                                         StartOrder{"RunInTheMiddle", 4, true},
                                         StartOrder{"RunLast", 8, true}),
                         [](const auto& order) { return order.param.name; });

TEST_F(ByHandTest, ARoleMayBeStartedAgainInTheMiddle) {
  ExpectEachMayBeStartedAgain({"arbitrator"}, "20");
}

}  // namespace
}  // namespace fogline::test
