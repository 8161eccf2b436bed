#include "services/runtime/realtime/culprit.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

template <class... M>
runtime::ChannelSet Lost() {
  runtime::ChannelSet set;
  (set.set(IndexOf<M>()), ...);
  return set;
}

std::size_t PlaceOf(Role role) { return static_cast<std::size_t>(role); }

TEST(CulpritTest, NamesNoRoleIfNothingIsLost) {
  EXPECT_EQ(runtime::FindCulprit({}, {}), std::nullopt);
}

TEST(CulpritTest, BlamesTheProducerOfEachChannelThatIsLostAlone) {
  ForEachStepChannel([]<class M>(std::size_t channel) {
    EXPECT_EQ(runtime::FindCulprit(Lost<M>(), {}),
              (runtime::Culprit{kChannels[channel].from, channel}));
  });
}

// Without a sensor there is no track, and without a track no command. So the producer of the lost
// sensor's channel is the culprit.
TEST(CulpritTest, BlamesTheMostUpstreamOfSeveral) {
  const auto lost = Lost<lidar_t, track_t, accel_command_t>();
  EXPECT_EQ(runtime::FindCulprit(lost, {}), (runtime::Culprit{Role::kLidar, IndexOf<lidar_t>()}));
}

TEST(CulpritTest, PassesTheBlameUpAsFarAsRolesReportLostInputs) {
  runtime::LostByRole reported{};
  reported[PlaceOf(Role::kAcc)] = Lost<track_t>();
  reported[PlaceOf(Role::kFusion)] = Lost<radar_t>();
  EXPECT_EQ(runtime::FindCulprit(Lost<accel_command_t>(), reported),
            (runtime::Culprit{Role::kRadar, IndexOf<radar_t>()}));
}

TEST(CulpritTest, BlamesARoleThatReportsNothing) {
  runtime::LostByRole reported{};
  reported[PlaceOf(Role::kFusion)] = Lost<radar_t>();
  EXPECT_EQ(runtime::FindCulprit(Lost<accel_command_t>(), reported),
            (runtime::Culprit{Role::kAcc, IndexOf<accel_command_t>()}));
}

TEST(CulpritTest, EndsWhereACircleCloses) {
  runtime::LostByRole reported{};
  reported[PlaceOf(Role::kArbitrator)] = Lost<ego_t>();
  reported[PlaceOf(Role::kWorld)] = Lost<arbitration_t>();
  const auto culprit = runtime::FindCulprit(Lost<arbitration_t>(), reported);
  EXPECT_EQ(culprit, (runtime::Culprit{Role::kWorld, IndexOf<ego_t>()}));
}

TEST(CulpritTest, FindsAnEndWhateverIsReported) {
  runtime::LostByRole everything{};
  for (runtime::ChannelSet& set : everything) set.set();
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    EXPECT_TRUE(runtime::FindCulprit(runtime::ChannelSet().set(i), everything))
        << kChannels[i].name;
  }
}

TEST(CulpritTest, NamesTheRoleAndTheLostChannel) {
  EXPECT_EQ(runtime::Text({Role::kLidar, IndexOf<lidar_t>()}), "lidar (LIDAR lost)");
}

}  // namespace
}  // namespace fogline
