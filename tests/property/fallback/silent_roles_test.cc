// Each role stops sending at many steps of the shipped scenarios. The tests check the motion of the
// vehicle.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "tests/property/fallback/real_time_loop.h"

namespace fogline {
namespace {

using test::kRounding;
using test::Moment;
using test::RealTimeLoop;

constexpr std::int64_t kDetection = 3;  // periods from the last message until the input is LOST
constexpr std::int64_t kInForce = 1;    // periods from the detection until the fallback is in force
constexpr std::int64_t kBetweenDeaths = 13;  // steps

Scenario Shipped(const std::string& name) {
  return LoadScenario(FOGLINE_SOURCE_DIR "/scenario/" + name, {});
}

// Upper bound for the time from the first missing message until the car stands, at the speeds of
// these scenarios.
constexpr std::int64_t kManoeuvre = 260;  // steps

// Compares the motion of a car, step by step, with the limits of the minimal risk manoeuvre.
class Braking {
 public:
  explicit Braking(const Scenario& scenario)
      : limits_(scenario.minimal_risk), step_s_(scenario.step_s) {}

  /// @param in_force whether the manoeuvre is in force in the step that begins
  void Take(bool in_force, double speed_mps, double applied_mps2) {
    if (in_force_) {
      ASSERT_LE(std::abs(applied_mps2 - last_mps2_), limits_.jerk_mps3 * step_s_ + kRounding);
      // If the car braked harder before the manoeuvre than the limit of the manoeuvre, the
      // manoeuvre releases the brake gradually.
      ASSERT_GE(applied_mps2, std::min(-limits_.deceleration_mps2, last_mps2_) - kRounding);
      ASSERT_TRUE(!stands_ || speed_mps == 0) << "drives off";
      stands_ = speed_mps == 0;
    }
    in_force_ = in_force;
    last_mps2_ = applied_mps2;
  }
  bool stands() const { return stands_; }

 private:
  MinimalRiskSection limits_;
  double step_s_;
  bool in_force_ = false;
  bool stands_ = false;
  double last_mps2_ = 0;
};

class SilentRolesTest : public testing::TestWithParam<const char*> {
 protected:
  // For every kBetweenDeaths-th step, runs the scenario with these roles silent from this step on.
  // Calls check(death, moment) for each step of each run. `death` is the step from which on the
  // roles are silent.
  template <class Check>
  void ForEachDeath(std::initializer_list<Role> roles, Check&& check) {
    for (std::int64_t death = 0; death < scenario_.steps - 10; death += kBetweenDeaths) {
      SCOPED_TRACE("silent from step " + std::to_string(death));
      RealTimeLoop loop(scenario_);
      for (const Role role : roles) loop.Silence(role, death);
      double last_mps2 = 0;
      loop.Run([&](const Moment& m) {
        ASSERT_EQ(m.truth.collision, truth_t::COLLISION_NONE) << "at step " << m.truth.header.step;
        // The acceleration of the host is the command of the previous step.
        if (m.truth.host_speed_mps > 0 && m.truth.header.step > 0) {
          ASSERT_EQ(m.truth.host_acceleration_mps2, last_mps2);
        }
        last_mps2 = m.carried_out.acceleration_mps2;
        ASSERT_TRUE(std::isfinite(last_mps2));
        check(death, m);
      });
      if (HasFatalFailure()) return;
    }
  }
  // Whether the fallback must be in force in the step of `m`, if the roles are silent from step
  // `death` on.
  static bool Due(std::int64_t death, const Moment& m) {
    return m.truth.header.step >= death - 1 + kDetection + kInForce;
  }

  // Checks in each step that the host brakes within the limits of the manoeuvre. In the last step
  // the host must stand, if the run is long enough after step `death`.
  void CheckHostStops(std::int64_t death, const Moment& m) {
    CheckStops(death, m, m.truth.host_speed_mps, m.truth.host_acceleration_mps2);
  }
  void CheckFollowerStops(std::int64_t death, const Moment& m) {
    CheckStops(death, m, m.truth.follower_speed_mps.at(0),
               m.truth.follower_acceleration_mps2.at(0));
  }

  Scenario scenario_ = Shipped(GetParam());

 private:
  void CheckStops(std::int64_t death, const Moment& m, double speed_mps, double applied_mps2) {
    if (m.truth.header.step == 0) braking_ = Braking(scenario_);
    ASSERT_NO_FATAL_FAILURE(braking_.Take(Due(death, m), speed_mps, applied_mps2))
        << "at step " << m.truth.header.step;
    if (m.truth.last && death + kManoeuvre < scenario_.steps) {
      ASSERT_TRUE(braking_.stands());
    }
  }

  Braking braking_{scenario_};
};

TEST_P(SilentRolesTest, WithoutASilentRoleIsTheLockstepRun) {
  closed_loop::ClosedLoop lockstep(scenario_);
  std::vector<double> commands;
  lockstep.Run(1, [&](const closed_loop::StepView& step) {
    commands.push_back(step.host.acceleration_mps2);
  });
  std::size_t k = 0;
  RealTimeLoop(scenario_).Run([&](const Moment& m) {
    ASSERT_LT(k, commands.size());
    ASSERT_EQ(m.carried_out.acceleration_mps2, commands[k++]);
  });
  EXPECT_EQ(k, commands.size());
}

TEST_P(SilentRolesTest, TheHumanDrivesWithoutASensorTheTrackOrTheAutomation) {
  for (const Role role : {Role::kRadar, Role::kLidar, Role::kFusion, Role::kAcc}) {
    SCOPED_TRACE(NameOf(role));
    ForEachDeath({role}, [&](std::int64_t death, const Moment& m) {
      if (!Due(death, m)) return;
      ASSERT_EQ(m.carried_out.mode, arbitration_t::HUMAN);
      ASSERT_EQ(m.carried_out.acceleration_mps2, m.human->acceleration_mps2);
    });
  }
}

TEST_P(SilentRolesTest, WithoutTheHumanTheAutomationDrivesUntilTheConflictAsksForHim) {
  bool asked = false;
  ForEachDeath({Role::kDriver}, [&](std::int64_t death, const Moment& m) {
    if (m.truth.header.step == 0) asked = false;
    if (!Due(death, m)) return;
    asked = asked || m.carried_out.doc >= m.carried_out.threshold ||
            m.carried_out.mode == arbitration_t::MINIMAL_RISK;
    if (asked) {
      ASSERT_EQ(m.carried_out.mode, arbitration_t::MINIMAL_RISK);
      ASSERT_GE(m.carried_out.acceleration_mps2, std::min(-scenario_.minimal_risk.deceleration_mps2,
                                                          m.truth.host_acceleration_mps2) -
                                                     kRounding);
    } else {
      ASSERT_EQ(m.carried_out.mode, arbitration_t::AUTOMATION);
      ASSERT_EQ(m.carried_out.acceleration_mps2, m.automation->acceleration_mps2);
    }
  });
}

TEST_P(SilentRolesTest, TheHostStopsWithoutHumanAndAutomation) {
  ForEachDeath({Role::kDriver, Role::kAcc}, [&](std::int64_t death, const Moment& m) {
    CheckHostStops(death, m);
    if (!Due(death, m)) return;
    ASSERT_EQ(m.carried_out.mode, arbitration_t::MINIMAL_RISK);
    ASSERT_FALSE(m.vehicle.host_stops_by_itself());
  });
}

TEST_P(SilentRolesTest, TheVehicleStopsByItselfWithoutTheArbitrator) {
  ForEachDeath({Role::kArbitrator}, [&](std::int64_t death, const Moment& m) {
    CheckHostStops(death, m);
    if (!Due(death, m)) return;
    ASSERT_EQ(m.carried_out.mode, arbitration_t::MINIMAL_RISK);
    ASSERT_TRUE(m.vehicle.host_stops_by_itself());
  });
}

TEST_P(SilentRolesTest, TheFollowingCarStopsByItselfWithoutItsDriver) {
  ForEachDeath({Role::kFollower}, [&](std::int64_t death, const Moment& m) {
    CheckFollowerStops(death, m);
    if (!Due(death, m)) return;
    ASSERT_TRUE(m.vehicle.follower_in_minimal_risk());
    ASSERT_NE(m.carried_out.mode, arbitration_t::MINIMAL_RISK);
    ASSERT_EQ(m.carried_out.acceleration_mps2, m.sent->acceleration_mps2);
  });
}

INSTANTIATE_TEST_SUITE_P(Shipped, SilentRolesTest, testing::Values("paper.json", "dense_fog.json"),
                         [](const auto& shipped) {
                           const std::string name = shipped.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace fogline
