// Tests that a step can be computed in the order of the table of channels.
#include "services/graph.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>

#include <gtest/gtest.h>

#include "services/algorithm.h"
#include "services/closed_loop/algorithms.h"

namespace fogline {
namespace {

TEST(GraphTest, GivesTheWorldWhatItReadsOfTheStepBefore) {
  int channels = 0;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep || !channel.to.Has(Role::kWorld)) continue;
    ++channels;
    EXPECT_EQ(LagOf(channel.from, Role::kWorld), 1) << channel.name;
  }
  EXPECT_GT(channels, 0);
}

TEST(GraphTest, LagsWhereTheProducerComesAfterTheReader) {
  EXPECT_EQ(LagOf(Role::kArbitrator, Role::kDriver), 1);
  EXPECT_EQ(LagOf(Role::kWorld, Role::kFusion), 0);
  EXPECT_EQ(LagOf(Role::kWorld, Role::kArbitrator), 0);
}

template <class Algorithm>
void ExpectListedIfItHasOnDemand() {
  constexpr Role kRole = AlgorithmTraits<Algorithm>::kRole;
  const bool listed = std::ranges::any_of(
      kChannels, [](const ChannelInfo& channel) { return channel.on_demand.Has(kRole); });
  EXPECT_EQ(listed, AlgorithmTraits<Algorithm>::kHasOnDemand) << NameOf(kRole);
}

TEST(GraphTest, ListsExactlyTheRolesThatHaveAnInputOnDemand) {
  []<class... A>(std::type_identity<std::tuple<A...>>) {
    (ExpectListedIfItHasOnDemand<A>(), ...);
  }(std::type_identity<closed_loop::Algorithms>{});
}

TEST(GraphTest, HasAnAlgorithmForEveryRoleThatIsAFolderInTheOrderOfEvaluation) {
  []<class... A>(std::type_identity<std::tuple<A...>>) {
    const std::array roles{AlgorithmTraits<A>::kRole...};
    ASSERT_EQ(roles.size() + 1, kRoles.size());  // the recorder has no algorithm
    EXPECT_EQ(kRoleFolders.size(), roles.size());
    for (std::size_t i = 0; i < roles.size(); ++i) EXPECT_EQ(roles[i], kRoles[i].role);
  }(std::type_identity<closed_loop::Algorithms>{});
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
