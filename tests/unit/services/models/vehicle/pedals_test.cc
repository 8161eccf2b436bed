#include "services/models/vehicle/pedals.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(PedalsTest, GivesADemandToOnePedalOnly) {
  models::Pedals pedals(10);
  EXPECT_EQ(pedals.Split(50).traction_n, 50);
  EXPECT_EQ(pedals.Split(50).brake_n, 0);
  EXPECT_EQ(pedals.Split(-50).traction_n, 0);
  EXPECT_EQ(pedals.Split(-50).brake_n, 50);
}

TEST(PedalsTest, ChangesPedalsOnlyBeyondTheBand) {
  models::Pedals pedals(10);
  pedals.Split(-10);
  EXPECT_EQ(pedals.pedal(), models::Pedal::kThrottle);
  pedals.Split(-10.1);
  EXPECT_EQ(pedals.pedal(), models::Pedal::kBrake);
  pedals.Split(10);
  EXPECT_EQ(pedals.pedal(), models::Pedal::kBrake);
  pedals.Split(10.1);
  EXPECT_EQ(pedals.pedal(), models::Pedal::kThrottle);
}

TEST(PedalsTest, CoastsWithinTheBandOnTheOtherPedalsSide) {
  models::Pedals pedals(10);
  EXPECT_EQ(pedals.Split(-5).brake_n, 0);
  pedals.Split(-20);
  EXPECT_EQ(pedals.Split(5).traction_n, 0);
  EXPECT_EQ(pedals.Split(-5).brake_n, 5);
}

}  // namespace
}  // namespace fogline
