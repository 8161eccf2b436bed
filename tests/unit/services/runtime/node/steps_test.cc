// The steps that a role computes.
#include "services/runtime/node/steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/services/runtime/node/fake_role.h"

namespace fogline {
namespace {

using testing::ElementsAre;

class StepsTest : public test::FakeRoleInRun {
 protected:
  StepsTest() { Join(); }
};

TEST_F(StepsTest, AreComputedInOrderAndReported) {
  EXPECT_EQ(parts_.own.message().state, status_t::READY);
  EXPECT_TRUE(parts_.steps.Compute(0));
  EXPECT_TRUE(parts_.steps.Compute(1));
  EXPECT_THAT(role_.computed, ElementsAre(0, 1));
  EXPECT_EQ(parts_.steps.next(), 2);
  EXPECT_EQ(parts_.own.message().header.step, 1);
  EXPECT_EQ(parts_.own.message().state, status_t::RUNNING);
}

TEST_F(StepsTest, MayBeLeftOut) {
  EXPECT_TRUE(parts_.steps.Compute(3));
  EXPECT_EQ(parts_.steps.next(), 4);
}

TEST_F(StepsTest, GoOnBehindThoseOfAPredecessor) {
  parts_.steps.StartAt(5);
  EXPECT_EQ(parts_.steps.next(), 5);
  EXPECT_EQ(parts_.own.message().header.step, 4);
}

TEST_F(StepsTest, EndWithTheFirstThatFails) {
  role_.compute_error = "step 0: no number";
  EXPECT_FALSE(parts_.steps.Compute(0));
  EXPECT_EQ(parts_.steps.next(), 0);
  EXPECT_TRUE(parts_.own.left());
  EXPECT_EQ(parts_.own.message().error, "step 0: no number");
}

}  // namespace
}  // namespace fogline
