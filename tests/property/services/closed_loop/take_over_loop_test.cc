// Requests to take over in the closed loop of the shipped scenarios. Some drivers take over, and
// other drivers do not.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "services/decision/take_over/take_over_log.h"
#include "tests/property/services/closed_loop/shipped.h"

namespace fogline::test {
namespace {

constexpr double kRounding = 1e-9;

struct Driven {
  std::vector<arbitration_t> commands;
  std::vector<double> automation_mps2;
  std::vector<double> human_mps2;
  take_over::TakeOverLog log;
};

Driven Drive(const Scenario& scenario) {
  Driven driven;
  closed_loop::ClosedLoop loop(scenario);
  loop.Run(0, [&](const closed_loop::StepView& step) {
    driven.commands.push_back(step.host);
    driven.automation_mps2.push_back(step.acc.acceleration_mps2);
    driven.human_mps2.push_back(step.driver.acceleration_mps2);
    driven.log.Add(step.host, step.driver.acceleration_mps2);
  });
  return driven;
}

take_over::TakeOverState StateOf(std::int8_t mode) {
  return std::ranges::find(take_over::kTakeOverStates, mode, &take_over::TakeOverStateInfo::mode)
      ->state;
}

bool IsInTable(take_over::TakeOverState from, take_over::TakeOverState to) {
  return std::ranges::any_of(take_over::kTakeOverTable, [&](const take_over::TakeOverRow& row) {
    return row.state == from && row.next == to;
  });
}

// Checks the rules of take-overs in all commands of a run: the state changes only as the table
// allows, each command comes from the side that has authority, and the minimal risk manoeuvre keeps
// its limits.
void ExpectTheRules(const Scenario& scenario, const Driven& driven) {
  const TakeOverSection& section = scenario.arbitrator.take_over;
  take_over::TakeOverState before = take_over::TakeOverState::kAutomated;
  double last_mps2 = 0;
  for (std::size_t k = 0; k < driven.commands.size(); ++k) {
    const arbitration_t& command = driven.commands[k];
    const take_over::TakeOverState state = StateOf(command.mode);
    ASSERT_TRUE(state == before || IsInTable(before, state)) << "step " << k;
    const take_over::Authority authority = take_over::AuthorityOf(state);
    const double change = section.jerk_mps3 * scenario.step_s + kRounding;
    switch (authority) {
      case take_over::Authority::kAutomation:
        ASSERT_EQ(command.acceleration_mps2, driven.automation_mps2[k]) << k;
        break;
      case take_over::Authority::kEasing:
        ASSERT_LE(command.acceleration_mps2, driven.automation_mps2[k]) << k;
        ASSERT_LE(command.acceleration_mps2, std::max(0.0, last_mps2 - change) + kRounding) << k;
        break;
      case take_over::Authority::kHuman:
        ASSERT_EQ(command.acceleration_mps2, driven.human_mps2[k]) << k;
        break;
      default:
        ASSERT_EQ(command.lambda_automation + command.lambda_human, 0) << k;
        ASSERT_LE(std::abs(command.acceleration_mps2 - last_mps2), change) << k;
        ASSERT_GE(command.acceleration_mps2,
                  std::min(-section.emergency_deceleration_mps2, last_mps2) - kRounding);
    }
    before = state;
    last_mps2 = command.acceleration_mps2;
  }
}

class TakeOverLoopTest : public testing::Test {
 protected:
  Scenario Paper() {
    Scenario scenario = LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json", {});
    scenario.arbitrator.take_over.mode = TakeOverMode::kRequested;
    return scenario;
  }
};

TEST_F(TakeOverLoopTest, KeepsTheRulesForEveryDriver) {
  int requests = 0;
  int manoeuvres = 0;
  for (std::int64_t seed = 1; seed <= 10; ++seed) {
    for (const double absent : {0.0, 0.5}) {
      Scenario scenario = Paper();
      scenario.seed = seed;
      scenario.arbitrator.take_over.absent_probability = absent;
      const Driven driven = Drive(scenario);
      ExpectTheRules(scenario, driven);
      ASSERT_FALSE(HasFatalFailure()) << "seed " << seed;
      for (const take_over::TakeOverRequest& request : driven.log.requests()) {
        ++requests;
        if (request.manoeuvre) ++manoeuvres;
      }
    }
  }
  EXPECT_GE(requests, 20);
  EXPECT_GT(manoeuvres, 3);
}

/// The share of control, in [0, 1], that the old side still has in the first step of a transfer.
/// The old side is the side that gives up control.
double LeftInTheFirstStep(const Scenario& scenario) {
  const TransferSection& section = scenario.arbitrator.transfer;
  const double progress = scenario.step_s / section.duration_s;
  const auto logistic = [](double x) { return 1 / (1 + std::exp(-x)); };
  switch (section.profile) {
    case TransferProfile::kLinear:
      return 1 - progress;
    case TransferProfile::kSigmoid:
      return 1 - (logistic(10 * progress - 5) - logistic(-5.0)) / (logistic(5.0) - logistic(-5.0));
    default:
      return 0;
  }
}

// In the first step of a transfer the new side has a share s of the control. If the profile is a
// ramp (linear or sigmoid), s is the first value of the ramp, otherwise s = 1. The command is (1 -
// s) times the old side's offer plus s times the new side's offer. Profile jerk_limited also limits
// the change of the command from the step before. A driver who ends a manoeuvre has full authority
// immediately, without this limit.
TEST_F(TakeOverLoopTest, ATransferIsFeltInItsStepWhateverTheProfile) {
  for (const TransferProfile profile : {TransferProfile::kStep, TransferProfile::kLinear,
                                        TransferProfile::kSigmoid, TransferProfile::kJerkLimited}) {
    // The numbers of transfers to the driver, from a manoeuvre to the driver, and to the
    // automation.
    std::array<int, 3> felt{};
    for (std::int64_t seed = 1; seed <= 40; ++seed) {
      Scenario scenario = Paper();
      scenario.seed = seed;
      scenario.steps = 700;
      scenario.arbitrator.transfer.profile = profile;
      scenario.arbitrator.transfer.duration_s = 1.3;
      scenario.arbitrator.take_over.time = {.mean_s = 8, .std_s = 3};
      const Driven driven = Drive(scenario);
      const double easing = scenario.arbitrator.take_over.jerk_mps3 * scenario.step_s;
      const double jerk = scenario.arbitrator.transfer.jerk_mps3 * scenario.step_s;
      for (std::size_t k = 1; k < driven.commands.size(); ++k) {
        const take_over::Authority from =
            take_over::AuthorityOf(StateOf(driven.commands[k - 1].mode));
        const take_over::Authority to = take_over::AuthorityOf(StateOf(driven.commands[k].mode));
        const bool to_human =
            to == take_over::Authority::kHuman && from != take_over::Authority::kHuman;
        const bool to_automation =
            to == take_over::Authority::kAutomation && from == take_over::Authority::kHuman;
        if (!to_human && !to_automation) continue;
        SCOPED_TRACE(testing::Message() << "profile " << static_cast<int>(profile) << ", seed "
                                        << seed << ", step " << k);
        const bool ends_manoeuvre = to_human && from >= take_over::Authority::kComfort;
        const double before = driven.commands[k - 1].acceleration_mps2;
        const double eased = std::min(driven.automation_mps2[k], std::max(0.0, before - easing));
        const double old_offer = to_human ? eased : driven.human_mps2[k];
        const double new_offer = to_human ? driven.human_mps2[k] : driven.automation_mps2[k];
        const double left = ends_manoeuvre ? 0 : LeftInTheFirstStep(scenario);
        double expected = left * old_offer + (1 - left) * new_offer;
        if (profile == TransferProfile::kJerkLimited && !ends_manoeuvre) {
          expected = std::clamp(expected, before - jerk, before + jerk);
        }
        const arbitration_t& command = driven.commands[k];
        EXPECT_NEAR(to_human ? command.lambda_automation : command.lambda_human, left, kRounding);
        EXPECT_NEAR(command.acceleration_mps2, expected, kRounding);
        ASSERT_GT(std::abs(new_offer - old_offer), 1e-6) << "they want the same";
        EXPECT_NE(command.acceleration_mps2, old_offer);
        ++felt[ends_manoeuvre ? 1 : to_human ? 0 : 2];
      }
    }
    for (const int count : felt) EXPECT_GE(count, 3);
  }
}

TEST_F(TakeOverLoopTest, StandsAtTheEndIfTheDriverDoesNotCome) {
  Scenario scenario = Paper();
  scenario.arbitrator.take_over.absent_probability = 1;
  const Driven driven = Drive(scenario);
  ExpectTheRules(scenario, driven);
  ASSERT_EQ(driven.log.requests().size(), 1U);
  const take_over::TakeOverRequest& request = driven.log.requests().front();
  ASSERT_TRUE(request.manoeuvre && request.standstill);
  EXPECT_EQ(*request.manoeuvre - request.requested, 100) << "10 s, and nothing severe before";
  EXPECT_EQ(driven.commands.back().mode, arbitration_t::MRM_DONE);
  EXPECT_EQ(driven.commands.back().acceleration_mps2, 0);
}

TEST_F(TakeOverLoopTest, ChangesNothingWhereTheDriverIsAlwaysAtIt) {
  Scenario scenario = Paper();
  closed_loop::ClosedLoop asked(scenario);
  scenario.arbitrator.take_over.mode = TakeOverMode::kInstant;
  closed_loop::ClosedLoop plain(scenario);
  const std::string digest = DigestOf(plain);
  scenario.arbitrator.take_over.lead_s = 20;
  scenario.arbitrator.take_over.absent_probability = 1;
  plain.Restart(scenario);
  EXPECT_EQ(DigestOf(plain), digest);
  EXPECT_NE(DigestOf(asked), digest);
}

}  // namespace
}  // namespace fogline::test
