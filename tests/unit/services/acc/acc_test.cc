#include "services/acc/acc.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

ego_t Ego(double speed_mps, double acceleration_mps2) {
  ego_t ego{};
  ego.header = {.run_id = 7, .step = 42, .utime = 4'200'000};
  ego.speed_mps = speed_mps;
  ego.acceleration_mps2 = acceleration_mps2;
  return ego;
}

track_t Track(double distance_m, double relative_speed_mps) {
  track_t track{};
  track.valid = 1;
  track.state[0] = distance_m;
  track.state[1] = relative_speed_mps;
  return track;
}

TEST(AccTest, AnswersWithWhatTheControllerSays) {
  const Scenario scenario;
  acc::Acc acc(scenario);
  acc::AccController controller(scenario.acc, scenario.step_s);
  const accel_command_t& command = acc.Step(Ego(21, 0.2), Track(30, -1.5));
  const acc::AccController::Output output = controller.Step({.distance_m = 30,
                                                             .relative_speed_mps = -1.5,
                                                             .speed_mps = 21,
                                                             .acceleration_mps2 = 0.2,
                                                             .has_target = true});
  EXPECT_EQ(command.acceleration_mps2, output.acceleration_mps2);
  EXPECT_EQ(command.control, output.control);
  EXPECT_EQ(command.safe_distance_m, output.safe_distance_m);
  EXPECT_EQ(command.iterations, output.iterations);
  EXPECT_LT(command.acceleration_mps2, 0.2);
}

TEST(AccTest, CopiesTheHeaderOfItsInput) {
  acc::Acc acc(Scenario{});
  const accel_command_t& command = acc.Step(Ego(20, 0), Track(33, 0));
  EXPECT_EQ(command.header.run_id, 7);
  EXPECT_EQ(command.header.step, 42);
  EXPECT_EQ(command.header.utime, 4'200'000);
}

TEST(AccTest, NamesItsSolverAsTheMessageDoes) {
  EXPECT_EQ(acc::Acc(Scenario{}).Step(Ego(20, 0), Track(33, 0)).solver,
            accel_command_t::UNCONSTRAINED);
  EXPECT_EQ(acc::Acc(Scenario{}).Step(Ego(20, 0), Track(5, -9)).solver,
            accel_command_t::ACTIVE_SET);
}

TEST(AccTest, FallsBackWithoutATrack) {
  acc::Acc acc(Scenario{});
  track_t track = Track(33, 0);
  track.valid = 0;
  const accel_command_t& command = acc.Step(Ego(20, 0), track);
  EXPECT_EQ(command.solver, accel_command_t::FALLBACK);
  EXPECT_LT(command.acceleration_mps2, 0);
  EXPECT_EQ(command.safe_distance_m, 33);
}

TEST(AccTest, FallsBackOnceTheTrackIsTooUncertain) {
  Scenario scenario;
  scenario.acc.max_track_std_m = 5;
  track_t track = Track(33, 0);
  track.covariance[0][0] = 24.9;
  EXPECT_EQ(acc::Acc(scenario).Step(Ego(20, 0), track).solver, accel_command_t::UNCONSTRAINED);
  track.covariance[0][0] = 25.1;
  EXPECT_EQ(acc::Acc(scenario).Step(Ego(20, 0), track).solver, accel_command_t::FALLBACK);
}

}  // namespace
}  // namespace fogline
