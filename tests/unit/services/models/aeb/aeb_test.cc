#include "services/models/aeb/aeb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "services/models/vehicle/longitudinal_vehicle.h"
#include "services/models/vehicle/motion.h"
#include "services/models/vehicle/vehicle_parameters.h"

namespace fogline {
namespace {

using models::AebState;

constexpr double kStep_s = 0.1;

AebSection On(AebTrigger trigger = AebTrigger::kTtc) {
  return {.enabled = true, .trigger = trigger};
}

models::Situation Closing(double gap_m, double closing_mps, double speed_mps = 20) {
  return {.speed_mps = speed_mps,
          .ahead = models::CarAhead{.gap_m = gap_m, .speed_mps = speed_mps - closing_mps}};
}

/// The state after one step of a system that is ready at first.
AebState StateOf(const AebSection& section, const models::Situation& seen) {
  return models::Aeb(section).Step(seen);
}

TEST(AebTest, WarnsBeforeItBrakesAtATimeToCollision) {
  EXPECT_EQ(StateOf(On(), Closing(18.1, 10)), AebState::kReady);
  EXPECT_EQ(StateOf(On(), Closing(18, 10)), AebState::kWarning) << "1.0 s and 0.8 s";
  EXPECT_EQ(StateOf(On(), Closing(10.1, 10)), AebState::kWarning);
  EXPECT_EQ(StateOf(On(), Closing(10, 10)), AebState::kBraking);
}

TEST(AebTest, BrakesByTheDecelerationThatIsRequired) {
  const AebSection section = On(AebTrigger::kDeceleration);
  EXPECT_EQ(StateOf(section, Closing(10, 10)), AebState::kBraking) << "100 / 20 = 5 m/s2";
  EXPECT_EQ(StateOf(section, Closing(10.1, 10)), AebState::kWarning);
  EXPECT_EQ(StateOf(section, Closing(18.1, 10)), AebState::kReady);
}

TEST(AebTest, CombinesBothTriggers) {
  // At a closing speed of 4 m/s, a TTC of 1 s is a gap of 4 m, and braking by 5 m/s2 needs 1.6 m.
  // At 16 m/s these distances are 16 m and 25.6 m.
  for (const auto& [closing_mps, gap_m] : {std::pair{4.0, 3.0}, {16.0, 20.0}}) {
    EXPECT_EQ(StateOf(On(AebTrigger::kEither), Closing(gap_m, closing_mps)), AebState::kBraking);
    EXPECT_NE(StateOf(On(AebTrigger::kBoth), Closing(gap_m, closing_mps)), AebState::kBraking);
  }
  EXPECT_EQ(StateOf(On(AebTrigger::kBoth), Closing(1.5, 4)), AebState::kBraking);
  EXPECT_EQ(StateOf(On(AebTrigger::kBoth), Closing(15, 16)), AebState::kBraking);
}

TEST(AebTest, IsReadyWhereNoCollisionThreatens) {
  EXPECT_EQ(StateOf(On(), {.speed_mps = 20}), AebState::kReady) << "no car ahead";
  EXPECT_EQ(StateOf(On(), Closing(1, 0)), AebState::kReady);
  EXPECT_EQ(StateOf(On(), Closing(1, -5)), AebState::kReady);
}

TEST(AebTest, BeginsOnlyInItsRangeOfSpeeds) {
  EXPECT_EQ(StateOf(On(), Closing(1, 2.7, 2.7)), AebState::kReady);
  EXPECT_EQ(StateOf(On(), Closing(1, 2.78, 2.78)), AebState::kBraking) << "10 km/h";
  EXPECT_EQ(StateOf(On(), Closing(1, 60, 60)), AebState::kBraking);
  AebSection section = On();
  section.max_speed_mps = 60 / 3.6;
  EXPECT_EQ(StateOf(section, Closing(1, 10, 16.6)), AebState::kBraking);
  EXPECT_EQ(StateOf(section, Closing(1, 10, 16.7)), AebState::kReady);
}

TEST(AebTest, BrakesOnUntilTheCarAheadIsNoSlower) {
  models::Aeb aeb(On());
  EXPECT_EQ(aeb.Step(Closing(10, 10)), AebState::kBraking);
  EXPECT_EQ(aeb.Step(Closing(30, 2)), AebState::kBraking) << "the time to collision is 15 s";
  EXPECT_EQ(aeb.Step(Closing(3, 1, 1)), AebState::kBraking) << "below the range of speeds";
  EXPECT_EQ(aeb.Step(Closing(3, 0, 1)), AebState::kReady);
  EXPECT_EQ(aeb.Step(Closing(3, 1, 1)), AebState::kReady) << "it begins only in its range";
}

TEST(AebTest, EndsWithoutACarAheadAndAtAStandstill) {
  models::Aeb aeb(On());
  aeb.Step(Closing(10, 10));
  EXPECT_EQ(aeb.Step({.speed_mps = 19}), AebState::kReady);
  aeb.Step(Closing(10, 10));
  EXPECT_EQ(aeb.Step(Closing(3, 1, 0)), AebState::kReady) << "a car that rolls backwards";
}

TEST(AebTest, EndsAtTheClosingSpeedThatTheScenarioSays) {
  AebSection section = On();
  section.release_closing_mps = 2;
  models::Aeb aeb(section);
  aeb.Step(Closing(10, 10));
  EXPECT_EQ(aeb.Step(Closing(5, 2.1)), AebState::kBraking);
  EXPECT_EQ(aeb.Step(Closing(5, 2)), AebState::kReady);
  EXPECT_EQ(aeb.Step(Closing(1, 2)), AebState::kReady) << "and does not begin at once again";
}

TEST(AebTest, WeakensNoHarderBraking) {
  models::Aeb aeb(On());
  EXPECT_EQ(aeb.Applied(1.5), 1.5);
  aeb.Step(Closing(10, 10));
  EXPECT_EQ(aeb.Applied(1.5), -9);
  EXPECT_EQ(aeb.Applied(-9.5), -9.5);
}

// ---- UN R152, 5.2.1.4 ---------------------------------------------------------------------------

struct Approach {
  double impact_mps = 0;  // relative; 0 without a collision
  double warned_s = 0;    // time of warnings before the braking
};

// The time to collision at the beginning of an approach. With this value, no step has a time to
// collision that equals a limit exactly. At an exact limit, rounding would decide.
constexpr double kFarAway_s = 6.05;

/// An approach at this relative speed, in which the driver does not brake.
/// @param vehicle nullptr: a point mass
Approach Approaching(double relative_kmph, double ahead_kmph,
                     models::LongitudinalVehicle* vehicle) {
  const double ahead_mps = ahead_kmph / 3.6;
  const double relative_mps = relative_kmph / 3.6;
  models::Aeb aeb(On());
  models::Motion own{0, ahead_mps + relative_mps};
  models::Motion ahead{kFarAway_s * relative_mps, ahead_mps};
  if (vehicle != nullptr) vehicle->Begin(own, 0);
  Approach approach;
  for (int k = 0; k < 300; ++k) {
    const double gap_m = ahead.position_m - own.position_m;
    const AebState state =
        aeb.Step({.speed_mps = own.speed_mps,
                  .ahead = models::CarAhead{.gap_m = gap_m, .speed_mps = ahead.speed_mps}});
    if (state == AebState::kWarning) approach.warned_s += kStep_s;
    const double command_mps2 = aeb.Applied(0);
    const double applied_mps2 =
        vehicle == nullptr ? command_mps2 : vehicle->Step(command_mps2, own);
    const auto contact_s =
        models::TimeToContact(gap_m, ahead.speed_mps, 0, own.speed_mps, applied_mps2, kStep_s);
    if (contact_s) {
      approach.impact_mps = own.speed_mps + applied_mps2 * *contact_s - ahead.speed_mps;
      return approach;
    }
    own = models::Advance(own, applied_mps2, kStep_s);
    ahead = models::Advance(ahead, 0, kStep_s);
  }
  return approach;
}

struct Demand {
  double relative_kmph;
  double impact_kmph;  // highest allowed; category M1, mass in running order
};

constexpr std::array kDemands{Demand{10, 0},  Demand{15, 0},  Demand{20, 0},  Demand{25, 0},
                              Demand{30, 0},  Demand{35, 0},  Demand{40, 0},  Demand{42, 0},
                              Demand{45, 15}, Demand{50, 25}, Demand{55, 30}, Demand{60, 35}};

TEST(AebTest, KeepsTheImpactSpeedsOfTheRegulationOnADryRoad) {
  for (const Demand& demand : kDemands) {
    for (const double ahead_kmph : {0.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << demand.relative_kmph << " behind " << ahead_kmph);
      models::LongitudinalVehicle sedan(models::kSedan, models::FrictionOf(Surface::kDry), {},
                                        kStep_s);
      for (models::LongitudinalVehicle* vehicle :
           {static_cast<models::LongitudinalVehicle*>(nullptr), &sedan}) {
        const Approach approach = Approaching(demand.relative_kmph, ahead_kmph, vehicle);
        EXPECT_LE(approach.impact_mps * 3.6, demand.impact_kmph) << (vehicle ? "sedan" : "point");
        EXPECT_GE(approach.warned_s, 0.8 - 1e-9) << "5.2.1.1";
      }
    }
  }
}

TEST(AebTest, CannotKeepThemOnIce) {
  models::LongitudinalVehicle sedan(models::kSedan, models::FrictionOf(Surface::kIce), {}, kStep_s);
  EXPECT_GT(Approaching(40, 0, &sedan).impact_mps * 3.6, 30) << "the tyres hold 1.47 m/s2";
}

}  // namespace
}  // namespace fogline
