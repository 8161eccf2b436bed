// How a role joins a run and leaves it.
#include "services/runtime/node/membership.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>

#include <csignal>

#include "tests/unit/services/runtime/driver_in_run.h"
#include "tests/unit/services/runtime/node/fake_role.h"

namespace fogline {
namespace {

using test::FakeRole;
using test::Script;

class MembershipTest : public test::FakeRoleInRun {
 protected:
  /// A RUN with the first part of the scenario.
  run_t Run(std::int8_t phase) const {
    return runtime::MakeRunPart(Script::kRunId, phase, 0, runtime::HashOf(script_.text()),
                                runtime::SplitScenario(script_.text()), 0);
  }
  runtime::OwnStatus& own_ = parts_.own;
};

TEST_F(MembershipTest, JoinsOnceWhenTheWholeScenarioIsThere) {
  EXPECT_TRUE(own_.Waits());
  Join(17);
  EXPECT_TRUE(own_.Running());
  EXPECT_EQ(role_.joins, 1);
  EXPECT_EQ(parts_.run.id, Script::kRunId);
  EXPECT_EQ(parts_.run.progress, 17);
  EXPECT_EQ(parts_.run.steps, Scenario().steps);
  EXPECT_FALSE(parts_.run.realtime);
  Join(18);
  EXPECT_EQ(role_.joins, 1);
  EXPECT_EQ(parts_.run.progress, 18);
}

TEST_F(MembershipTest, KnowsThatARunIsInRealtimeAndHowFastItIs) {
  Join(-1, 0.5);
  EXPECT_TRUE(parts_.run.realtime);
  EXPECT_EQ(parts_.run.pace, 0.5);
}

TEST_F(MembershipTest, CallsBeforeItReportsThatItIsReady) {
  int calls = 0;
  role_.node().membership().BeforeReady([&] {
    ++calls;
    EXPECT_EQ(role_.joins, 1);
    EXPECT_EQ(own_.message().state, status_t::WAITING);
  });
  Join();
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(own_.Running());
}

TEST_F(MembershipTest, SaysWhyItCannotTakePart) {
  role_.join_error = "no such car";
  Join();
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(own_.message().error, "cannot take part: no such car");
}

TEST_F(MembershipTest, TakesNoScenarioWithAnotherHash) {
  const std::vector<std::string> parts{"{}"};
  script_.Say(runtime::MakeRunPart(Script::kRunId, run_t::PREPARE, 0, "hash", parts, 0));
  EXPECT_EQ(own_.message().error, "the scenario that arrived does not match its hash");
  EXPECT_EQ(role_.joins, 0);
}

TEST_F(MembershipTest, TellsTheRuleHowFarTheRunIsAndOfGo) {
  Join();  // with GO
  const int news = role_.rule->news;
  const int gos = role_.rule->gos;
  EXPECT_GE(gos, 1);
  run_t prepare = Run(run_t::PREPARE);
  prepare.progress = 5;
  script_.Say(prepare);
  EXPECT_EQ(role_.rule->news, news + 1);
  EXPECT_EQ(role_.rule->gos, gos);
  EXPECT_EQ(parts_.run.progress, 5);
  script_.Say(Run(run_t::GO));
  EXPECT_EQ(role_.rule->gos, gos + 1);
  EXPECT_EQ(parts_.run.progress, 5) << "a run does not go back";
}

TEST_F(MembershipTest, AnswersARepeatedAnnouncementWithAStatus) {
  Join();
  const std::size_t before = status_.size();
  script_.Say(Run(run_t::PREPARE));
  EXPECT_EQ(status_.size(), before + 1);
}

TEST_F(MembershipTest, LeavesWhenTheRunnerSaysStopAndHearsNothingMore) {
  Join();
  script_.Say(Run(run_t::STOP));
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(own_.message().error, "");
  EXPECT_EQ(role_.leaves, 1);
  run_t further = Run(run_t::GO);
  further.progress = 5;
  script_.Say(further);
  EXPECT_EQ(parts_.run.progress, -1);
}

TEST_F(MembershipTest, KnowsWhetherItsRunnerIsSilent) {
  Join();
  script_.Poll(role_);
  const TimePoint now = Clock::now();
  script_.PollUpTo(role_, now + milliseconds(1500));
  EXPECT_FALSE(role_.node().membership().RunnerSilent(now + milliseconds(1500)));
  script_.PollUpTo(role_, now + milliseconds(2100));
  EXPECT_TRUE(role_.node().membership().RunnerSilent(now + milliseconds(2100)));
}

// ---- the driver --------------------------------------------------------------------------------

using MembershipOfADriverTest = test::DriverInRun;

TEST_F(MembershipOfADriverTest, AsksForTheScenarioOfItsRunUnasked) {
  script_.Poll(node_);
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].channel, "RUN");
}

TEST_F(MembershipOfADriverTest, LetsAnOlderWordOfTheRunnerCountForNothing) {
  script_.SayRun(run_t::GO, -1);
  run_t older = runtime::MakeRunPart(Script::kRunId, run_t::STOP, 0, "", {"x"}, 0);
  older.sequence = 1;
  script_.Say(older);
  EXPECT_FALSE(own_.left());
  EXPECT_EQ(Status().duplicates, 1);
  older.sequence = 1000;
  script_.Say(older);
  EXPECT_TRUE(own_.left());
}

TEST_F(MembershipOfADriverTest,
       LooksForAnotherRunWhenARunnerFallsSilentBeforeAllOfTheScenarioIsThere) {
  Script other;
  runtime::StepNode<driver::Driver> node(other.bus(), std::nullopt);
  const std::vector<std::string> parts{"{", "}"};
  other.Say(Script::WithDriver(
      runtime::MakeRunPart(Script::kRunId + 1, run_t::PREPARE, 0, runtime::HashOf("{}"), parts, 0),
      0));
  other.SayRun(run_t::PREPARE, -1);
  EXPECT_TRUE(node.node().parts().own.Waits());
  other.Poll(node);
  other.PollUpTo(node, Clock::now() + milliseconds(6000));
  other.SayRun(run_t::PREPARE, -1);
  EXPECT_FALSE(node.node().parts().own.Waits());
}

TEST_F(MembershipOfADriverTest, LeavesARunThatHasAnotherDriverWhenItsRunnerSaysSo) {
  // GIVEN a driver with --run-id, and a RUN that names another driver. This RUN may come from a log
  // that is played, and the driver cannot know this. So it does not leave immediately.
  script_.SayRun(run_t::GO, -1);
  const std::vector<std::string> parts = runtime::SplitScenario(script_.text());
  run_t taken = Script::WithDriver(
      runtime::MakeRunPart(Script::kRunId, run_t::GO, 0, runtime::HashOf(script_.text()), parts, 0),
      4711);
  script_.Say(taken);
  EXPECT_FALSE(own_.released());
  // THEN the driver asks the runner, and leaves when a runner answers
  ASSERT_FALSE(requests_.empty());
  EXPECT_EQ(requests_.back().channel, "RUN");
  EXPECT_EQ(requests_.back().instance, own_.message().instance);
  taken.answer_to = own_.message().instance;
  script_.Say(taken);
  EXPECT_TRUE(own_.released());
  EXPECT_EQ(own_.message().error, "another process is the driver of run 7");
}

/// Publishes RUN messages as a log has them: `sequence` is 0, and no process has the role of the
/// driver.
void SayLogged(Script& script, std::int64_t run_id) {
  const std::vector<std::string> parts = runtime::SplitScenario(script.text());
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    runtime::Encode(
        Script::WithDriver(runtime::MakeRunPart(run_id, run_t::PREPARE, 0,
                                                runtime::HashOf(script.text()), parts, i),
                           0),
        bytes);
    script.bus().Publish("RUN", bytes);
    script.bus().Drain();
  }
}

TEST_F(MembershipOfADriverTest, IsInvitedByNoLogThatIsPlayed) {
  Script other;
  runtime::StepNode<driver::Driver> node(other.bus(), std::nullopt);
  SayLogged(other, Script::kRunId);
  EXPECT_FALSE(node.node().parts().run.id);
  other.SayRun(run_t::PREPARE, -1);
  EXPECT_FALSE(node.node().parts().own.Waits());
}

TEST_F(MembershipOfADriverTest, LeavesALogThatItWasToldToFollowWhenTheLogIsOver) {
  SayLogged(script_, Script::kRunId);
  EXPECT_TRUE(own_.Running());
  script_.Say(Truth(0));
  EXPECT_EQ(commands_.size(), 1U);
  script_.Poll(node_);
  const TimePoint now = Clock::now();
  script_.PollUpTo(node_, now + milliseconds(18'000));
  EXPECT_FALSE(own_.left());
  script_.PollUpTo(node_, now + milliseconds(20'000));
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(own_.message().error, "");
}

TEST(MembershipOfASignedRunTest, BelievesInARunThatAnswersARequestOfItsOwn) {
  Script script;
  runtime::SigningKey::Secret secret{};
  secret.fill(1);
  script.bus().Secure(runtime::MessageSigner(runtime::SigningKey(secret), std::nullopt));
  const std::vector<resend_t>& requests = script.Listen<resend_t>();
  runtime::StepNode<driver::Driver> node(script.bus(), Script::kRunId);
  const runtime::OwnStatus& own = node.node().parts().own;
  // GIVEN signed messages of a runner, which may be repetitions from an old run
  script.SayRun(run_t::GO, -1);
  EXPECT_TRUE(own.Waits());
  ASSERT_FALSE(requests.empty());
  EXPECT_EQ(requests.back().channel, "RUN");
  const std::int64_t instance = requests.back().instance;
  // WHEN a runner answers another process THEN the role still waits
  const std::vector<std::string> parts = runtime::SplitScenario(script.text());
  for (const std::int64_t asker : {instance + 1, instance}) {
    EXPECT_TRUE(own.Waits());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      run_t run = Script::WithDriver(runtime::MakeRunPart(Script::kRunId, run_t::GO, 0,
                                                          runtime::HashOf(script.text()), parts, i),
                                     0);
      run.answer_to = asker;
      script.Say(run);
    }
  }
  // AND the role joins the run when the runner has answered the role's own request
  EXPECT_TRUE(own.Running());
}

/// A driver that a person has started, in a run that waited for a driver.
class ExternalRoleTest : public testing::Test {
 protected:
  ExternalRoleTest() {
    script_.SayRun(run_t::PREPARE, -1);
    script_.Poll(node_);
    EXPECT_FALSE(own_.Waits());
  }

  /// The runner announces which process is the driver.
  void SayHolder(std::int64_t run_id, std::int64_t holder) {
    const std::vector<std::string> parts = runtime::SplitScenario(script_.text());
    script_.Say(Script::WithDriver(
        runtime::MakeRunPart(run_id, run_t::PREPARE, 0, runtime::HashOf(script_.text()), parts, 0),
        holder));
  }
  std::int64_t instance() const { return status_.back().instance; }

  Script script_;
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  runtime::StepNode<driver::Driver> node_{script_.bus(), std::nullopt};
  runtime::OwnStatus& own_ = node_.node().parts().own;
};

TEST_F(ExternalRoleTest, JoinsNoRunThatHasItsRoleOrStartsItItself) {
  Script other;
  const std::vector<status_t>& said = other.Listen<status_t>();
  runtime::StepNode<driver::Driver> node(other.bus(), std::nullopt);
  const std::vector<std::string> parts = runtime::SplitScenario(other.text());
  const run_t run = runtime::MakeRunPart(Script::kRunId, run_t::PREPARE, 0,
                                         runtime::HashOf(other.text()), parts, 0);
  for (int i = 0; i < 2; ++i) {
    other.Say(i == 0 ? run : Script::WithDriver(run, 4711));
    other.Poll(node, Clock::now() + milliseconds(300));
    EXPECT_TRUE(said.empty());
  }
  other.SayRun(run_t::PREPARE, -1);
  EXPECT_FALSE(node.node().parts().own.Waits());
}

TEST_F(ExternalRoleTest, GoesWhenAnotherProcessHasItsPlace) {
  SayHolder(Script::kRunId, 0);
  SayHolder(Script::kRunId, instance());
  EXPECT_FALSE(own_.released());
  SayHolder(Script::kRunId, instance() + 1);
  EXPECT_TRUE(own_.released());
  EXPECT_EQ(status_.back().state, status_t::LEFT);
  EXPECT_EQ(own_.message().error, "another process is the driver of run 7");
  // AND the role publishes no further message
  const std::size_t said = status_.size();
  script_.PollUpTo(node_, Clock::now() + milliseconds(1000));
  EXPECT_EQ(status_.size(), said);
}

TEST_F(ExternalRoleTest, GoesToARunThatWaitsForItOnlyWhenItsOwnRunnerIsSilent) {
  const std::int64_t another = Script::kRunId + 1;
  script_.PollUpTo(node_, Clock::now() + milliseconds(1000));
  SayHolder(another, 0);
  EXPECT_FALSE(own_.released()) << "the runner may be there";
  script_.PollUpTo(node_, Clock::now() + milliseconds(2100));
  SayHolder(another, 4711);
  EXPECT_FALSE(own_.released()) << "that run has a driver";
  SayHolder(another, 0);
  EXPECT_TRUE(own_.released());
  EXPECT_THAT(own_.message().error, testing::MatchesRegex("the runner of run 7 has been silent for "
                                                          "[0-9.]+ s; run 8 waits for the driver"));
}

TEST_F(ExternalRoleTest, HoldsItsOwnPauseAgainstNoRunner) {
  const TimePoint now = Clock::now();
  script_.Poll(node_, now + milliseconds(20'000));
  EXPECT_FALSE(own_.left()) << own_.message().error;
  script_.PollUpTo(node_, now + milliseconds(38'000));
  EXPECT_FALSE(own_.left()) << own_.message().error;
  script_.PollUpTo(node_, now + milliseconds(39'500));
  EXPECT_TRUE(own_.left());
  EXPECT_EQ(own_.message().error, "the runner has been silent for 19 s");
}

TEST_F(ExternalRoleTest, WaitsAsLongAsTheRunOfARunnerThatHasStartedIt) {
  // GIVEN a process that the kernel ends when its parent ends. The runner starts its processes in
  // this way.
  int before = 0;
  ASSERT_EQ(prctl(PR_GET_PDEATHSIG, &before), 0);
  ASSERT_EQ(prctl(PR_SET_PDEATHSIG, SIGKILL), 0);
  Script other;
  runtime::StepNode<driver::Driver> started(other.bus(), Script::kRunId);
  ASSERT_EQ(prctl(PR_SET_PDEATHSIG, before), 0);
  other.SayRun(run_t::GO, -1);
  other.Poll(started);
  other.PollUpTo(started, Clock::now() + milliseconds(25'000));
  EXPECT_FALSE(started.node().parts().own.left()) << started.node().parts().own.message().error;
}

}  // namespace
}  // namespace fogline
