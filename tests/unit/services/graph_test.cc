// Tests that a step can be computed in the order of the table of channels.
#include "services/graph.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "services/acc/acc.h"
#include "services/algorithm.h"
#include "services/arbitrator/arbitrator.h"
#include "services/driver/driver.h"
#include "services/follower/follower.h"
#include "services/fusion/fusion.h"
#include "services/lidar/lidar.h"
#include "services/radar/radar.h"
#include "services/world/world.h"

namespace fogline {
namespace {

TEST(GraphTest, GivesEveryRoleWhatItReadsOfTheSameStepAndTheWorldOfTheOneBefore) {
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep) continue;
    for (const RoleInfo& reader : kRoles) {
      if (!channel.to.Has(reader.role)) continue;
      EXPECT_EQ(LagOf(channel.from, reader.role), reader.role == Role::kWorld ? 1 : 0)
          << channel.name << " to " << reader.name;
    }
  }
}

TEST(GraphTest, LagsWhereTheProducerComesAfterTheReader) {
  EXPECT_EQ(LagOf(Role::kArbitrator, Role::kDriver), 1);
  EXPECT_EQ(LagOf(Role::kWorld, Role::kFusion), 0);
  EXPECT_EQ(LagOf(Role::kWorld, Role::kArbitrator), 0);
}

template <class... Algorithms>
void ExpectListsRolesWithOnDemand() {
  const auto expect = [](Role role, bool has_on_demand) {
    const bool listed = std::ranges::any_of(
        kChannels, [role](const ChannelInfo& channel) { return channel.on_demand.Has(role); });
    EXPECT_EQ(listed, has_on_demand) << NameOf(role);
  };
  (expect(AlgorithmTraits<Algorithms>::kRole, AlgorithmTraits<Algorithms>::kHasOnDemand), ...);
}

TEST(GraphTest, ListsExactlyTheRolesThatHaveAnInputOnDemand) {
  ExpectListsRolesWithOnDemand<world::World, radar::Radar, lidar::Lidar, fusion::Fusion, acc::Acc,
                               driver::Driver, arbitrator::Arbitrator, follower::Follower>();
}

TEST(GraphTest, SendsNoRoleAChannelTwice) {
  for (const ChannelInfo& channel : kChannels) {
    for (const RoleInfo& reader : kRoles) {
      if (!channel.on_demand.Has(reader.role)) continue;
      EXPECT_FALSE(channel.to.Has(reader.role)) << channel.name << " to " << reader.name;
      EXPECT_EQ(channel.pace, Pace::kStep) << channel.name;
      EXPECT_NE(channel.from, reader.role) << channel.name;
    }
  }
}

}  // namespace
}  // namespace fogline
