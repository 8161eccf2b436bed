// The arbitrator in real time with a driver whom it must ask, and with all its inputs.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include "tests/unit/services/arbitrator/failsafe_inputs.h"

namespace fogline::test {

class FailsafeTakeOverTest : public FailsafeInputsTest {
 public:
  static Scenario Asking() {
    Scenario scenario;
    scenario.arbitrator.window_steps = 1;
    scenario.arbitrator.take_over = {.mode = TakeOverMode::kRequested,
                                     .lead_s = 10,
                                     .escalation_s = 1,
                                     .time = {.mean_s = 2, .std_s = 1e-3},
                                     .recovery_s = 1};
    return scenario;
  }

  /// The scenario of Asking(), with a person as the driver.
  static Scenario AskingAPerson() {
    Scenario scenario = Asking();
    scenario.person.drives = true;
    return scenario;
  }

 protected:
  explicit FailsafeTakeOverTest(const Scenario& scenario = Asking()) : arbitrator_(scenario) {
    radar_.valid = lidar_.valid = 1;
    radar_.range_m = 37;
    lidar_.range_m = 32;  // radar and LiDAR disagree
    ego_.speed_mps = 20;
    automation_.acceleration_mps2 = 0.2;
    driver_.acceleration_mps2 = -0.4;
    driver_.readiness = 1;
    inputs_ = {.ego = {InputState::kOk, &ego_},
               .radar = {InputState::kOk, &radar_},
               .lidar = {InputState::kOk, &lidar_},
               .track = {InputState::kOk, &track_},
               .automation = {InputState::kOk, &automation_},
               .driver = {InputState::kOk, &driver_}};
  }

  const arbitration_t& Step() {
    const header_t header{.run_id = 7, .step = step_, .utime = step_ * 100'000};
    ++step_;
    ego_.header = radar_.header = lidar_.header = header;
    return last_ = arbitrator_.Step(header, inputs_);
  }
  /// Makes steps until the mode is reached, for at most a minute.
  void StepUntil(std::int8_t mode) {
    for (int k = 0; k < 600 && Step().mode != mode; ++k) {
    }
    ASSERT_EQ(last_.mode, mode);
  }
  void Agree() { radar_.range_m = lidar_.range_m; }

  arbitrator::FailsafeArbitrator arbitrator_;
  arbitration_t last_{};
};

}  // namespace fogline::test
