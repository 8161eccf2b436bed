#include "services/runtime/realtime/culprit.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

template <class... M>
ChannelSet Lost() {
  ChannelSet set;
  (set.set(IndexOf<M>()), ...);
  return set;
}

std::size_t At(Role role) { return static_cast<std::size_t>(role); }

TEST(CulpritTest, NamesNobodyWhereNothingIsLost) { EXPECT_EQ(FindCulprit({}, {}), std::nullopt); }

TEST(CulpritTest, BlamesTheProducerOfEachChannelThatIsLostAlone) {
  ForEachStepChannel([]<class M>(std::size_t channel) {
    EXPECT_EQ(FindCulprit(Lost<M>(), {}), (Culprit{kChannels[channel].from, channel}));
  });
}

// Without a sensor there is no track, and without a track no command.
TEST(CulpritTest, BlamesTheMostUpstreamOfSeveral) {
  const auto lost = Lost<lidar_t, track_t, accel_command_t>();
  EXPECT_EQ(FindCulprit(lost, {}), (Culprit{Role::kLidar, IndexOf<lidar_t>()}));
}

TEST(CulpritTest, PassesTheBlameUpAsFarAsRolesReportLostInputs) {
  LostByRole reported{};
  reported[At(Role::kAcc)] = Lost<track_t>();
  reported[At(Role::kFusion)] = Lost<radar_t>();
  EXPECT_EQ(FindCulprit(Lost<accel_command_t>(), reported),
            (Culprit{Role::kRadar, IndexOf<radar_t>()}));
}

TEST(CulpritTest, BlamesARoleThatReportsNothing) {
  LostByRole reported{};
  reported[At(Role::kFusion)] = Lost<radar_t>();
  EXPECT_EQ(FindCulprit(Lost<accel_command_t>(), reported),
            (Culprit{Role::kAcc, IndexOf<accel_command_t>()}));
}

TEST(CulpritTest, EndsWhereACircleCloses) {
  LostByRole reported{};
  reported[At(Role::kArbitrator)] = Lost<ego_t>();
  reported[At(Role::kWorld)] = Lost<arbitration_t>();
  const auto culprit = FindCulprit(Lost<arbitration_t>(), reported);
  EXPECT_EQ(culprit, (Culprit{Role::kWorld, IndexOf<ego_t>()}));
}

TEST(CulpritTest, FindsAnEndWhateverIsReported) {
  LostByRole everything{};
  for (ChannelSet& set : everything) set.set();
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    EXPECT_TRUE(FindCulprit(ChannelSet().set(i), everything)) << kChannels[i].name;
  }
}

TEST(CulpritTest, SaysWhoAndByWhatItShows) {
  EXPECT_EQ(Text({Role::kLidar, IndexOf<lidar_t>()}), "lidar (LIDAR lost)");
}

}  // namespace
}  // namespace fogline
