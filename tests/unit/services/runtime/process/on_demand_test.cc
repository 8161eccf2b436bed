// Inputs on demand: inputs that a role reads only in some scenarios. The example is a driver that
// reads HOST_COMMAND. In each step, HOST_COMMAND is published after the driver's DRIVER_COMMAND. So
// the driver uses the HOST_COMMAND of the previous step.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "services/runtime/process/step_node.h"
#include "tests/unit/services/runtime/script.h"

namespace fogline {
namespace {

using test::Script;
using testing::Contains;
using testing::ElementsAre;
using testing::Not;

/// In each step this driver's offer is the acceleration of the last HOST_COMMAND. The driver's
/// readiness is the number of calls of SetOnDemandInput() so far.
class Echo {
 public:
  explicit Echo(const Scenario& /*scenario*/) { out_.acceleration_mps2 = kNothing; }

  static bool UsesOnDemandInput(const Scenario& scenario) { return scenario.human.loses_awareness; }
  void SetOnDemandInput(const arbitration_t& host) {
    out_.acceleration_mps2 = host.acceleration_mps2;
    ++out_.readiness;
  }
  const driver_command_t& Step(const truth_t& truth) {
    out_.header = truth.header;
    return out_;
  }

  static constexpr double kNothing = -1;

 private:
  driver_command_t out_{};
};

static_assert(AlgorithmTraits<Echo>::kHasOnDemand);

Scenario Demanding() {
  Scenario scenario;
  scenario.human.loses_awareness = true;
  return scenario;
}

constexpr double AccelerationOf(std::int64_t step) { return 10 + static_cast<double>(step); }

class OnDemandTest : public testing::Test {
 protected:
  explicit OnDemandTest(const Scenario& scenario = Demanding()) : script_(scenario) {}

  void SayTruth(std::int64_t step) { script_.Say(Script::Of<truth_t>(step)); }
  void SayHost(std::int64_t step) {
    auto host = Script::Of<arbitration_t>(step);
    host.acceleration_mps2 = AccelerationOf(step);
    script_.Say(host);
  }
  /// The steps that the node has published, in order.
  std::vector<std::int64_t> Steps() const {
    std::vector<std::int64_t> steps;
    for (const driver_command_t& command : commands_) steps.push_back(command.header.step);
    return steps;
  }
  std::vector<double> Accelerations() const {
    std::vector<double> accelerations;
    for (const driver_command_t& command : commands_) {
      accelerations.push_back(command.acceleration_mps2);
    }
    return accelerations;
  }
  std::vector<std::string> ChannelsAskedFor() const {
    std::vector<std::string> channels;
    for (const resend_t& request : requests_) channels.push_back(request.channel);
    return channels;
  }

  Script script_;
  std::vector<resend_t>& requests_ = script_.Listen<resend_t>();
  std::vector<driver_command_t>& commands_ = script_.Listen<driver_command_t>();
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  runtime::StepNode<Echo> node_{script_.bus(), Script::kRunId};
};

TEST_F(OnDemandTest, IsOfTheStepBeforeWhereItsProducerComesLaterAndAllZeroBeforeTheFirst) {
  script_.SayRun(run_t::GO, -1);
  SayTruth(0);
  EXPECT_THAT(Accelerations(), ElementsAre(0));
  SayHost(0);
  SayTruth(1);
  SayTruth(2);
  SayHost(1);
  EXPECT_THAT(Steps(), ElementsAre(0, 1, 2));
  EXPECT_THAT(Accelerations(), ElementsAre(0, AccelerationOf(0), AccelerationOf(1)));
  EXPECT_EQ(commands_.back().readiness, 3) << "once before each step";
}

TEST_F(OnDemandTest, IsWaitedForAndAskedForLikeAnyOther) {
  script_.SayRun(run_t::GO, -1);
  SayTruth(0);
  SayTruth(1);
  EXPECT_THAT(Steps(), ElementsAre(0));
  script_.Poll(node_);
  EXPECT_TRUE(requests_.empty()) << "it may be on its way";
  script_.Poll(node_, Clock::now() + milliseconds(60));
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].channel, "HOST_COMMAND");
  EXPECT_EQ(requests_[0].header.step, 0);
  EXPECT_EQ(requests_[0].count, 1);
  // AND the driver's STATUS names the input for which the driver waits
  script_.Poll(node_, Clock::now() + milliseconds(500));
  EXPECT_EQ(status_.back().waiting_for, "HOST_COMMAND");
  EXPECT_EQ(status_.back().last_heard_step, -1);
  SayHost(0);
  EXPECT_THAT(Steps(), ElementsAre(0, 1));
}

TEST_F(OnDemandTest, IsNoSignOfAStepToCome) {
  script_.SayRun(run_t::GO, -1);
  SayTruth(0);
  SayHost(0);
  script_.Poll(node_, Clock::now() + milliseconds(60));
  EXPECT_TRUE(requests_.empty()) << "step 0 may be the last";
}

TEST_F(OnDemandTest, IsAskedForFromTheFirstStepOnByALateRole) {
  constexpr std::int64_t kProgress = 150;
  script_.SayRun(run_t::GO, kProgress);
  std::size_t served = 0;
  script_.Poll(node_);
  while (served < requests_.size()) {
    // All open requests are served before the driver looks at the time again. Otherwise the driver
    // asks again for a message that it has awaited for too long.
    while (served < requests_.size()) {
      const resend_t request = requests_[served++];
      for (std::int64_t k = request.header.step; k < request.header.step + request.count; ++k) {
        request.channel == "TRUTH" ? SayTruth(k) : SayHost(k);
      }
    }
    script_.Poll(node_);
  }
  // THEN the driver asks for each step once
  std::int64_t truths = 0;
  std::int64_t hosts = 0;
  for (const resend_t& request : requests_) {
    std::int64_t& next = request.channel == "TRUTH" ? truths : hosts;
    EXPECT_EQ(request.header.step, next) << request.channel;
    next += request.count;
  }
  EXPECT_EQ(truths, kProgress + 1);
  EXPECT_EQ(hosts, kProgress);
  // AND the driver's commands equal those of a driver that takes part from the first step
  ASSERT_FALSE(commands_.empty());
  EXPECT_EQ(commands_.back().header.step, kProgress);
  EXPECT_EQ(commands_.back().readiness, kProgress + 1);
  EXPECT_EQ(commands_.back().acceleration_mps2, AccelerationOf(kProgress - 1));
}

TEST_F(OnDemandTest, OfTwoProducersEndsTheRun) {
  script_.SayRun(run_t::GO, -1);
  SayHost(0);
  script_.Say(Script::Of<arbitration_t>(0));
  EXPECT_EQ(node_.node().parts().own.message().error,
            "step 0: HOST_COMMAND came twice with different contents: is there a second "
            "arbitrator?");
}

// ---- a scenario in which the driver does not read HOST_COMMAND ---------------------------------

class NotOnDemandTest : public OnDemandTest {
 protected:
  NotOnDemandTest() : OnDemandTest(Scenario()) {}
};

TEST_F(NotOnDemandTest, IsNeitherReadNorWaitedForNorHeard) {
  script_.SayRun(run_t::GO, -1);
  script_.bus().Publish("HOST_COMMAND", std::vector<std::uint8_t>(100));
  SayHost(0);
  script_.Say(Script::Of<arbitration_t>(0));
  for (std::int64_t k = 0; k < 3; ++k) SayTruth(k);
  EXPECT_THAT(Steps(), ElementsAre(0, 1, 2));
  EXPECT_THAT(Accelerations(), testing::Each(Echo::kNothing));
  script_.Poll(node_, Clock::now() + milliseconds(500));
  EXPECT_THAT(ChannelsAskedFor(), Not(Contains("HOST_COMMAND")));
  EXPECT_EQ(status_.back().wrong_type, 0) << "nothing of it has arrived";
}

// ---- real time ---------------------------------------------------------------------------------

constexpr double kSpeed = 0.1;  // so a period lasts a second

class OnDemandInRealtimeTest : public OnDemandTest {
 protected:
  OnDemandInRealtimeTest() { script_.SayRun(run_t::GO, -1, kSpeed); }

  void Compute(std::int64_t step) {
    script_.SayRun(run_t::GO, step, kSpeed);  // the progress of the run
    SayTruth(step);
    script_.Poll(node_);
  }
};

TEST_F(OnDemandInRealtimeTest, IsNotWaitedForAndNotHeardBeforeItComes) {
  Compute(0);
  Compute(1);
  EXPECT_THAT(Steps(), ElementsAre(0, 1));
  EXPECT_THAT(Accelerations(), ElementsAre(Echo::kNothing, Echo::kNothing));
}

TEST_F(OnDemandInRealtimeTest, IsTheNewestThatHasComeHoweverOldItIs) {
  Compute(0);
  SayHost(0);
  for (std::int64_t k = 1; k < 100; ++k) Compute(k);
  SayHost(50);
  SayHost(49);
  Compute(100);
  EXPECT_EQ(Accelerations()[1], AccelerationOf(0));
  EXPECT_EQ(Accelerations()[99], AccelerationOf(0));
  EXPECT_EQ(Accelerations()[100], AccelerationOf(50));
}

TEST_F(OnDemandInRealtimeTest, IsNeverLostAndNoInputOfStatus) {
  Compute(0);
  SayHost(0);
  script_.PollUpTo(node_, Clock::now() + milliseconds(4000));
  EXPECT_THAT(status_.back().input, ElementsAre("TRUTH"));
  EXPECT_EQ(status_.back().waiting_for, "TRUTH");
  EXPECT_THAT(ChannelsAskedFor(), Not(Contains("HOST_COMMAND")));
}

}  // namespace
}  // namespace fogline
