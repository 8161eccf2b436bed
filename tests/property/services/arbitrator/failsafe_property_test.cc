#include "services/arbitrator/failsafe_arbitrator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "common/random.h"
#include "services/models/vehicle/motion.h"

namespace fogline {
namespace {

constexpr double kRounding = 1e-9;

// The newest messages of all inputs, with arbitrary plausible values.
struct Messages {
  ego_t ego{};
  radar_t radar{};
  lidar_t lidar{};
  track_t track{};
  accel_command_t automation{};
  driver_command_t driver{};
};

void Refresh(Messages& m, const Random& random, const header_t& header) {
  const auto [radar_noise, lidar_noise] = random.Normal2(header.step, 0);
  const auto [automation, driver] = random.Uniform2(header.step, 1);
  m.ego.header = m.radar.header = m.lidar.header = m.track.header = header;
  m.automation.header = m.driver.header = header;
  m.radar.valid = m.lidar.valid = random.Uniform2(header.step, 2)[0] < 0.9;
  m.radar.range_m = 32 + radar_noise;  // so the conflict z is about 1.1 m, where the DoC is steep
  m.lidar.range_m = 32 + lidar_noise;
  m.automation.acceleration_mps2 = -3 + 5 * automation;
  m.driver.acceleration_mps2 = -9 + 10 * driver;
}

TEST(FailsafePropertyTest, IsTheArbitratorBitByBitWhileAllInputsAreThere) {
  for (const auto missing : {MissingLidar::kHold, MissingLidar::kSkip, MissingLidar::kConflict}) {
    Scenario scenario;
    scenario.arbitrator.missing_lidar = missing;
    arbitrator::Arbitrator regular(scenario);
    arbitrator::FailsafeArbitrator failsafe(scenario);
    const Random random(1, Stream::kRadar);
    Messages m;
    for (std::int64_t k = 0; k < 2000; ++k) {
      Refresh(m, random, {.run_id = 1, .step = k, .utime = k * 100'000});
      constexpr InputState kOk = InputState::kOk;
      const arbitration_t& a =
          regular.Step(m.ego, m.radar, m.lidar, m.track, m.automation, m.driver);
      const arbitration_t& b = failsafe.Step(m.ego.header, {{kOk, &m.ego},
                                                            {kOk, &m.radar},
                                                            {kOk, &m.lidar},
                                                            {kOk, &m.track},
                                                            {kOk, &m.automation},
                                                            {kOk, &m.driver}});
      ASSERT_EQ(a.header.step, b.header.step);
      ASSERT_EQ(a.header.utime, b.header.utime);
      ASSERT_EQ(a.acceleration_mps2, b.acceleration_mps2);
      ASSERT_EQ(a.lambda_automation, b.lambda_automation);
      ASSERT_EQ(a.lambda_human, b.lambda_human);
      ASSERT_EQ(a.doc, b.doc);
      ASSERT_EQ(a.conflict_m, b.conflict_m);
      ASSERT_EQ(a.threshold, b.threshold);
      ASSERT_EQ(a.mode, b.mode);
      ASSERT_EQ(failsafe.decision(), arbitrator::Decision::kRegular);
    }
  }
}

// An input that fails and recovers at random. The input is AWAITED until its first message comes.
template <class M>
class Flickering {
 public:
  Flickering(const Random& random, std::uint32_t index) : random_(random), index_(index) {}

  Heard<M> At(std::int64_t step, const M& message) {
    const auto [change, which] = random_.Uniform2(step, index_);
    if (change < 0.05) {
      constexpr InputState kStates[] = {InputState::kOk, InputState::kOk, InputState::kStale,
                                        InputState::kLost};
      state_ = kStates[static_cast<std::size_t>(which * 4)];
      if (state_ == InputState::kStale && !held_) state_ = InputState::kLost;
    }
    if (state_ == InputState::kOk) held_ = message;
    return {state_, held_ ? &*held_ : nullptr};
  }

 private:
  const Random& random_;
  std::uint32_t index_;
  InputState state_ = InputState::kAwaited;
  std::optional<M> held_;
};

struct Previous {
  double command_mps2 = 0;
  std::int8_t mode = arbitration_t::AUTOMATION;
};

// Checks the rules that every command must obey.
void Check(const arbitration_t& out, const arbitrator::ArbitratorInputs& inputs, const ego_t& ego,
           const MinimalRiskSection& limits, double step_s, const Previous& previous) {
  ASSERT_TRUE(std::isfinite(out.acceleration_mps2));
  if (previous.mode == arbitration_t::MINIMAL_RISK) {
    ASSERT_EQ(out.mode, arbitration_t::MINIMAL_RISK);
  }
  if (out.mode != arbitration_t::MINIMAL_RISK) {
    ASSERT_EQ(out.lambda_automation + out.lambda_human, 1);
    // The command is one of the offers, unchanged, or the last command.
    const bool is_offer = (inputs.automation.newest != nullptr &&
                           out.acceleration_mps2 == inputs.automation.newest->acceleration_mps2) ||
                          (inputs.driver.newest != nullptr &&
                           out.acceleration_mps2 == inputs.driver.newest->acceleration_mps2);
    ASSERT_TRUE(is_offer || out.acceleration_mps2 == previous.command_mps2);
    return;
  }
  ASSERT_EQ(out.lambda_automation, 0);
  ASSERT_EQ(out.lambda_human, 0);
  ASSERT_GE(out.acceleration_mps2,
            std::min(-limits.deceleration_mps2, previous.command_mps2) - kRounding);
  if (ego.speed_mps > 0) {
    ASSERT_LE(std::abs(out.acceleration_mps2 - previous.command_mps2),
              limits.jerk_mps3 * step_s + kRounding);
  }
}

TEST(FailsafePropertyTest, CommandsNothingUndefinedWhateverFails) {
  std::map<arbitrator::Decision, int> taken;
  for (std::int64_t run = 0; run < 300; ++run) {
    Scenario scenario;
    const Random random(run, Stream::kLidar);
    arbitrator::FailsafeArbitrator arbitrator(scenario);
    Flickering<radar_t> radar(random, 10);
    Flickering<lidar_t> lidar(random, 11);
    Flickering<track_t> track(random, 12);
    Flickering<accel_command_t> automation(random, 13);
    Flickering<driver_command_t> driver(random, 14);
    Messages m;
    m.ego.speed_mps = 20;
    Previous previous;
    for (std::int64_t k = 0; k < 400; ++k) {
      Refresh(m, random, {.run_id = 1, .step = k, .utime = k * 100'000});
      const arbitrator::ArbitratorInputs inputs{
          {InputState::kOk, &m.ego}, radar.At(k, m.radar),           lidar.At(k, m.lidar),
          track.At(k, m.track),      automation.At(k, m.automation), driver.At(k, m.driver)};
      const arbitration_t& out = arbitrator.Step(m.ego.header, inputs);
      ASSERT_NO_FATAL_FAILURE(
          Check(out, inputs, m.ego, scenario.minimal_risk, scenario.step_s, previous))
          << "run " << run << " step " << k;
      const models::Motion next =
          models::Advance({0, m.ego.speed_mps}, out.acceleration_mps2, scenario.step_s);
      m.ego.speed_mps = next.speed_mps;
      m.ego.acceleration_mps2 = out.acceleration_mps2;
      previous = {out.acceleration_mps2, out.mode};
      ++taken[arbitrator.decision()];
    }
  }
  // Every decision must be frequent. Otherwise the test would prove little about this decision.
  for (const arbitrator::Decision decision :
       {arbitrator::Decision::kRegular, arbitrator::Decision::kAutomation,
        arbitrator::Decision::kHuman, arbitrator::Decision::kHold,
        arbitrator::Decision::kMinimalRisk}) {
    EXPECT_GT(taken[decision], 50) << static_cast<int>(decision);
  }
}

}  // namespace
}  // namespace fogline
