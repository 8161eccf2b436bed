// A few bursts in which the network loses messages. Each burst is of a different kind.
#include <gtest/gtest.h>

#include "tests/integration/realtime/loss_bursts.h"

namespace fogline::test {
namespace {

TEST_F(LossBurstInRealtimeTest, LeavesNoRoleDeaf) {
  constexpr double kClean_s = 1.5;
  const BurstPlan plan{
      .rate_hz = 50,
      .machines = 1,
      .bursts = {{70, 1, kEverywhere}, {60, 1, kEverywhere}, {100, 0.5, kEverywhere}},
      .clean_s = kClean_s};
  Judge(PlayAll({plan}, 1), kClean_s);
  Print();
}

}  // namespace
}  // namespace fogline::test
