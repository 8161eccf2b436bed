// The state machine of a request to take over, and a car that carries out its commands.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "services/decision/take_over/take_over.h"

namespace fogline::test {

/// The state machine, and a car that carries out its commands.
class TakeOverTest : public testing::Test {
 protected:
  using enum take_over::TakeOverState;

  static constexpr double kStep_s = 0.1;

  /// A scenario in which the driver's take-over time differs from `time_s` by less than a
  /// millisecond.
  static Scenario Answering(double time_s) {
    Scenario scenario;
    scenario.step_s = kStep_s;
    scenario.arbitrator.take_over.mode = TakeOverMode::kRequested;
    scenario.arbitrator.take_over.time = {
        .model = TakeOverModel::kLogNormal, .mean_s = time_s, .std_s = 1e-4};
    return scenario;
  }

  static Scenario Absent() {
    Scenario scenario = Answering(2);
    scenario.arbitrator.take_over.absent_probability = 1;
    return scenario;
  }

  /// A scenario with a person as the driver. The take-over time of the modelled driver is 2 s.
  static Scenario WithPerson() {
    Scenario scenario = Answering(2);
    scenario.person.drives = true;
    return scenario;
  }

  static track_t Ahead(double distance_m, double closing_mps) {
    track_t track{};
    track.valid = true;
    track.state[0] = distance_m;
    track.state[1] = -closing_mps;
    return track;
  }

  void Begin(const Scenario& scenario) { take_over_.emplace(scenario); }

  const take_over::TakeOverOutcome& Step() {
    inputs_.track = &track_;
    const take_over::TakeOverOutcome& out = take_over_->Step(Header(step_++), inputs_);
    inputs_.applied_mps2 = out.acceleration_mps2;
    if (brakes_) {
      inputs_.speed_mps = std::max(0.0, inputs_.speed_mps + kStep_s * out.acceleration_mps2);
    }
    return out;
  }

  /// Makes steps until the state changes, or until `limit_s`. @return seconds since the start of
  /// the run
  double StepWhile(take_over::TakeOverState state, double limit_s = 100) {
    while (take_over_->outcome().state == state && Now() < limit_s) Step();
    return Now();
  }

  take_over::TakeOverState state() const { return take_over_->outcome().state; }
  double Now() const { return static_cast<double>(step_ - 1) * kStep_s; }

  static header_t Header(std::int64_t step) {
    header_t header{};
    header.step = step;
    return header;
  }

  std::optional<take_over::TakeOver> take_over_;
  take_over::TakeOverInputs inputs_{.human_wanted = true,
                                    .automation_mps2 = 0.5,
                                    .human_mps2 = -0.7,
                                    .readiness = 1,
                                    .speed_mps = 20};
  track_t track_ = Ahead(50, 0);
  bool brakes_ = true;
  std::int64_t step_ = 0;
};

}  // namespace fogline::test
