// The requests that a role sends.
#include "services/runtime/node/requests.h"

#include <gtest/gtest.h>

#include "tests/unit/services/runtime/node/fake_role.h"

namespace fogline {
namespace {

using test::Script;
using RequestsTest = test::FakeRoleInRun;

TEST_F(RequestsTest, NameTheStepsAndWhoAsks) {
  Join();
  parts_.requests.Ask("TRUTH", {.first = 5, .count = 3});
  script_.bus().Drain();
  const resend_t& request = requests_.back();
  EXPECT_EQ(request.channel, "TRUTH");
  EXPECT_EQ(request.header.run_id, Script::kRunId);
  EXPECT_EQ(request.header.step, 5);
  EXPECT_EQ(request.count, 3);
  EXPECT_EQ(request.requester, "driver");
  EXPECT_EQ(request.instance, parts_.own.message().instance);
}

TEST_F(RequestsTest, MayGoToAnotherRun) {
  parts_.requests.AskIn(Script::kRunId + 1, "RUN", {.first = 0, .count = 1});
  script_.bus().Drain();
  EXPECT_EQ(requests_.back().header.run_id, Script::kRunId + 1);
}

}  // namespace
}  // namespace fogline
