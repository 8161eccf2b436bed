// Runs in real time: the tests kill or stop roles while the automation drives, and judge what the
// cars do. They judge everything from the log.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "tests/integration/realtime_log.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

constexpr double kSpeed = 5;
constexpr double kPeriodS = kStepS / kSpeed;
// From a role's last message until a reader calls it lost. kInForce: from then until the fallback
// acts.
constexpr std::int64_t kDetection = 3;  // periods
constexpr std::int64_t kInForce = 1;
// A role hears the runner's news within 100 ms: 5 periods.
constexpr std::int64_t kNews = 5;
// The length of a manoeuvre from 20 m/s, steps.
constexpr int kManoeuvre = 230;

/// A run in real time. This test can stop its processes.
class RealtimeRun {
 public:
  RealtimeRun(const std::string& scenario, int steps, double speed = kSpeed,
              const std::vector<std::string>& settings = {})
      : bus_(runtime::FreshMulticastUrl()),
        log_(folder_.File("run.lcm")),
        run_(Command(scenario, steps, speed, settings)) {
    bus_.Subscribe(ChannelOf<truth_t>().name, [this](runtime::Arrival& arrival) {
      const auto* truth = arrival.As<truth_t>();
      if (truth == nullptr || truth->header.step <= step_) return;
      step_ = truth->header.step;
      truth_at_ = arrival.time();
    });
    bus_.Subscribe(ChannelOf<status_t>().name, [this](runtime::Arrival& arrival) {
      if (const auto* status = arrival.As<status_t>()) Heard(*status, arrival.time());
    });
  }

  void WaitForStep(std::int64_t step) {
    const TimePoint end = Clock::now() + std::chrono::seconds(30);
    while (step_ < step) {
      bus_.Wait(milliseconds(20));
      if (Clock::now() > end || !IsAlive(run_.pid())) {
        throw std::runtime_error("waited in vain for a step\n" + run_.Err());
      }
    }
  }
  /// @return the step that was under way
  std::int64_t Signal(const std::string& role, int signal) {
    kill(pids_.at(role), signal);
    return step_;
  }
  /// The time between the world's last TRUTH and the first STATUS that calls the world lost, on
  /// this process's clock. Nothing if the world is back before that.
  std::optional<Duration> WaitForTheWorldToBeMissed() {
    const std::int64_t silent_since = step_;
    const TimePoint end = Clock::now() + std::chrono::seconds(5);
    while (!missed_after_ && step_ <= silent_since + 1 && Clock::now() < end) {
      bus_.Wait(milliseconds(5));
    }
    return missed_after_;
  }

  /// Waits for the end. @return the result
  nlohmann::json Finish() {
    EXPECT_EQ(run_.Wait(), 0) << run_.Err();
    return nlohmann::json::parse(run_.Out(), nullptr, false);
  }
  const std::string& log() const { return log_; }
  const std::string& url() const { return bus_.url(); }
  Background& run() { return run_; }

 private:
  std::vector<std::string> Command(const std::string& scenario, int steps, double speed,
                                   const std::vector<std::string>& settings) const {
    std::vector<std::string> command{Program("fogline"),
                                     "run",
                                     scenario,
                                     "--json",
                                     "--realtime",
                                     "--speed",
                                     std::to_string(speed),
                                     "--set",
                                     "/steps=" + std::to_string(steps),
                                     "--lcm-url",
                                     bus_.url(),
                                     "--log",
                                     log_};
    for (const std::string& setting : settings) {
      command.insert(command.end(), {"--set", setting});
    }
    return command;
  }
  void Heard(const status_t& status, TimePoint now) {
    pids_[status.role] = status.pid;
    if (missed_after_ || status.role == NameOf(Role::kRecorder)) return;
    for (std::size_t i = 0; i < status.input.size(); ++i) {
      const bool world = status.input[i] == ChannelOf<truth_t>().name ||
                         status.input[i] == ChannelOf<ego_t>().name;
      if (world && status.input_state[i] == status_t::INPUT_LOST) missed_after_ = now - truth_at_;
    }
  }

  ScratchFolder folder_;
  runtime::Bus bus_;
  std::string log_;
  Background run_;
  std::int64_t step_ = -1;
  TimePoint truth_at_{};
  std::optional<Duration> missed_after_;
  std::map<std::string, pid_t> pids_;
};

TEST(RealtimeTest, RefusesASpeedThatIsNoneOrThatNothingKeeps) {
  const auto refused = [](std::vector<std::string> more) {
    more.insert(more.begin(), {Program("fogline"), "run", "scenario/paper.json"});
    const Outcome run = RunCommand(more);
    EXPECT_EQ(run.code, 2);
    return run.err;
  };
  EXPECT_THAT(refused({"--speed", "5"}), testing::HasSubstr("--speed requires --realtime"));
  EXPECT_THAT(refused({"--realtime", "--speed", "nan"}),
              testing::HasSubstr("Value nan not in range"));
  EXPECT_THAT(refused({"--realtime", "--transport", "memq"}),
              testing::HasSubstr("error: --realtime: "));
}

TEST(RealtimeTest, UndisturbedItIsTheRunInLockstep) {
  const Outcome lockstep = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--json",
                                       "--set", "/steps=60", "--transport", "direct"});
  std::int64_t misses = 0;
  // If the machine stands still for half a period, it disturbs a run, and that run proves nothing.
  // This does not happen in every run. A period of 50 ms outlasts most such moments.
  constexpr int kTries = 5;
  constexpr double kSlowly = 2;
  for (int i = 0; i < kTries; ++i) {
    RealtimeRun run("scenario/paper.json", 60, kSlowly);
    const auto result = run.Finish();
    const auto& realtime = result["realtime"];
    EXPECT_EQ(realtime["missed_messages"], 0) << realtime.dump(2);
    EXPECT_EQ(realtime["ticks"], 60);
    EXPECT_GT(realtime["latency_p50_us"], 0);
    misses = realtime["deadline_misses"];
    if (misses > 0) continue;
    EXPECT_EQ(result["digest"], nlohmann::json::parse(lockstep.out)["digest"]);
    return;
  }
  FAIL() << "no run of " << kTries << " was undisturbed: in the last one " << misses
         << " steps had to do without an input";
}

// A column of ACCs and people follows the driver. None of them may miss a step.
TEST(RealtimeTest, ADriverWhoIsLateEndsTheManoeuvreAndTheLogTellsHisTimes) {
  constexpr int kSteps = 140;
  constexpr int kColumn = 5;
  // Times are compared to the step here, so a period is longer than a moment in which a busy
  // machine stands still.
  RealtimeRun run(
      "scenario/dense_fog.json", kSteps, kSpeed / 2,
      {"/fog/start_s=1", "/fog/duration_s=4", "/arbitrator/take_over/mode=requested",
       "/arbitrator/take_over/time/mean_s=10.55", "/arbitrator/take_over/time/std_s=0.01",
       "/followers/count=5", "/followers/driver=drawn", "/followers/style=drawn"});
  const auto result = run.Finish();
  EXPECT_EQ(result["steps"], kSteps);
  EXPECT_EQ(result["realtime"]["missed_messages"], 0) << result["realtime"].dump(2);

  const Outcome events = RunCommand({Program("fogline"), "events", run.log(), "--json"});
  ASSERT_EQ(events.code, 0) << events.err;
  const auto requests = nlohmann::json::parse(events.out).at(0)["requests"];
  ASSERT_EQ(requests.size(), 1U) << events.out;
  const auto after_s = [&](const char* what) {
    return requests.at(0)[what].get<double>() - requests.at(0)["requested_s"].get<double>();
  };
  // A decision is a step late if its inputs are.
  EXPECT_NEAR(after_s("manoeuvre_s"), 10, kStepS + kRounding);
  EXPECT_GE(after_s("manoeuvre_s"), 10 - kRounding);
  EXPECT_NEAR(after_s("acknowledged_s"), 10.6, kStepS + kRounding);
  EXPECT_EQ(after_s("transferred_s"), after_s("acknowledged_s"));
  EXPECT_GE(after_s("effective_s"), after_s("transferred_s"));
  EXPECT_LE(after_s("effective_s"), after_s("transferred_s") + 2 * kStepS);

  const Log log(run.log());
  ExpectNoCollision(log);
  ExpectCommandsAreCarriedOut(log, 1, log.last());
  for (std::int64_t step = 0; step < kSteps; ++step) {
    ASSERT_TRUE(log.follower.contains(step)) << step;
    EXPECT_EQ(log.follower.at(step).num_followers, kColumn) << step;
    EXPECT_EQ(log.truth.at(step).num_followers, kColumn) << step;
  }
}

/// Which role fails, how (by a signal), and in which scenario.
struct Fault {
  std::string scenario;
  std::string role;
  int signal;
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.role << " in " << fault.scenario;
}

std::string NameOfFault(const testing::TestParamInfo<Fault>& info) {
  return info.param.scenario + "_" + info.param.role +
         (info.param.signal == SIGKILL ? "_killed" : "_stopped");
}

/// The channel on which a role falls silent.
std::string ChannelOfRole(const std::string& role) {
  std::string name;
  for (const ChannelInfo& channel : kChannels) {
    if (NameOf(channel.from) == role && channel.pace == Pace::kStep) name = channel.name;
  }
  return name;
}

/// The step of a fault, and the settings of its run.
struct Plan {
  int fault_step = 60;  // the automation drives, and nothing else happens
  int steps = 140;
  double speed = kSpeed;
  std::vector<std::string> settings;
};

Plan PlanOf(const Fault& fault) {
  Plan plan;
  if (fault.role == "arbitrator" || fault.role == "follower") {
    plan.steps = plan.fault_step + kManoeuvre;
  } else if (fault.role == "driver") {
    // The human is needed some 20 steps after the fault: 13 steps into the fog of the paper, 120
    // into the dense one. A stopped process is missing for 50 steps.
    const bool dense = fault.scenario == "dense_fog";
    plan.fault_step = dense ? 100 : 60;
    plan.settings = {dense ? "/fog/start_s=0" : "/fog/start_s=6.7"};
    plan.steps = plan.fault_step + 40 + kManoeuvre;
  } else if (fault.role == "recorder") {
    // A second passes until the recorder's silence counts as a hang. At this speed it has no more
    // periods than the other roles keep their messages for the recorder.
    plan.speed = 2;
  }
  return plan;
}

// The vehicle stops by itself. The next arbitrator lets it finish the stop.
void JudgeWithoutArbitrator(const Log& log, std::int64_t lost) {
  EXPECT_LT(log.truth.at(lost + 1 + kInForce).host_acceleration_mps2,
            log.truth.at(lost).host_acceleration_mps2);
  ExpectStandstillWithinLimits(log, lost, Host);
  const auto of_next = log.command.upper_bound(lost + kNews);
  EXPECT_NE(of_next, log.command.end()) << "no arbitrator came back";
  ExpectMode(
      log, lost + kNews, log.last(),
      [](std::int8_t mode) { return mode == arbitration_t::MINIMAL_RISK; }, "the vehicle stops");
}

// The host goes on as it did; the following car stops.
void JudgeWithoutFollower(const Log& log, std::int64_t lost) {
  ExpectCommandsAreCarriedOut(log, 1, log.last());
  ExpectFollowerObeys(log, 1, lost);
  EXPECT_LT(Follower(log.truth.at(lost + 1 + kInForce)).acceleration_mps2,
            Follower(log.truth.at(lost)).acceleration_mps2);
  ExpectStandstillWithinLimits(log, lost, Follower);
}

// The automation drives alone until the human is needed and does not answer.
void JudgeWithoutDriver(const Log& log, const Fault& fault, const Log::Silence& silence,
                        std::int64_t lost) {
  ExpectCommandsAreCarriedOut(log, 1, log.last());
  const std::int64_t trusted = silence.back + kRecoverSteps - 1;
  ExpectMode(
      log, lost + kInForce, trusted, [](std::int8_t mode) { return mode != arbitration_t::HUMAN; },
      "only the automation can drive");
  const auto wanted =
      std::find_if(log.command.lower_bound(lost + kInForce), log.command.end(),
                   [](const auto& at) { return at.second.doc >= at.second.threshold; });
  const bool in_vain = wanted != log.command.end() && wanted->first < trusted;
  if (fault.signal == SIGSTOP) {
    ASSERT_TRUE(in_vain) << "he was not wanted in his absence";
  }
  if (!in_vain) return;
  ExpectMode(
      log, wanted->first, log.last(),
      [](std::int8_t mode) { return mode == arbitration_t::MINIMAL_RISK; },
      "the human was wanted in vain");
  ExpectStandstillWithinLimits(log, wanted->first, Host);
}

// The human drives until the automation has been back for some steps.
void JudgeWithoutAutomation(const Log& log, const Log::Silence& silence, std::int64_t lost) {
  ExpectCommandsAreCarriedOut(log, 1, log.last());
  ASSERT_TRUE(log.command.contains(lost + kInForce));
  ExpectMode(
      log, lost + kInForce, silence.back + kRecoverSteps - 1,
      [](std::int8_t mode) { return mode == arbitration_t::HUMAN; }, "the automation is lost");
  EXPECT_EQ(log.command.rbegin()->second.mode, arbitration_t::AUTOMATION) << "never again";
}

void Judge(const Log& log, const Fault& fault, std::int64_t fault_step) {
  ExpectNoCollision(log);
  EXPECT_EQ(log.truth.size(), static_cast<std::size_t>(log.last() + 1)) << "steps are left out";
  ASSERT_EQ(log.command.at(fault_step - 1).mode, arbitration_t::AUTOMATION);
  const std::string channel = ChannelOfRole(fault.role);
  if (fault.role == "recorder") return ExpectCommandsAreCarriedOut(log, 1, log.last());
  const auto loss = log.FirstLossOf(channel, fault_step);
  if (!loss) {
    // A killed role may be back before another role misses it.
    ASSERT_EQ(fault.signal, SIGKILL) << "no role missed it";
    EXPECT_LT(log.LongestSilence(channel, fault_step), kDetection) << "no role missed it";
    ExpectFollowerObeys(log, 1, log.last());
    return ExpectCommandsAreCarriedOut(log, 1, log.last());
  }
  const Log::Silence silence = log.SilenceAt(channel, loss->step);
  EXPECT_LE(loss->step - silence.before, kDetection);
  EXPECT_EQ(loss->culprit_channel, channel) << loss->reporter;
  if (fault.role == "arbitrator") return JudgeWithoutArbitrator(log, loss->step);
  if (fault.role == "follower") return JudgeWithoutFollower(log, loss->step);
  if (fault.role == "driver") return JudgeWithoutDriver(log, fault, silence, loss->step);
  // Time stands still without the world. Nothing else changes.
  if (fault.role == "world") return ExpectCommandsAreCarriedOut(log, 1, log.last());
  JudgeWithoutAutomation(log, silence, loss->step);
}

class FaultInRealtimeTest : public testing::TestWithParam<Fault> {};

TEST_P(FaultInRealtimeTest, LeavesNoCarUndecided) {
  const Fault& fault = GetParam();
  const Plan plan = PlanOf(fault);
  RealtimeRun run("scenario/" + fault.scenario + ".json", plan.steps, plan.speed, plan.settings);
  run.WaitForStep(plan.fault_step);
  const std::int64_t step = run.Signal(fault.role, fault.signal);
  if (fault.role == "world") {
    // Steps cannot tell how long the world was silent. This process may hear of it one period
    // later.
    const auto missed = run.WaitForTheWorldToBeMissed();
    EXPECT_TRUE(missed || fault.signal == SIGKILL) << "no role missed it";
    if (missed) {
      EXPECT_LE(std::chrono::duration<double>(*missed).count(), (kDetection + 1) * kPeriodS);
    }
  }
  const auto result = run.Finish();
  SCOPED_TRACE(result["realtime"].dump());
  Judge(Log(run.log()), fault, step);
}

std::vector<Fault> EveryFault() {
  std::vector<Fault> faults;
  for (const char* scenario : {"paper", "dense_fog"}) {
    for (const RoleInfo& role : kRoles) {
      for (const int signal : {SIGKILL, SIGSTOP}) {
        faults.push_back({scenario, std::string(role.name), signal});
      }
    }
  }
  return faults;
}

// The plain tests have some faults. The campaign kills and stops every role.
INSTANTIATE_TEST_SUITE_P(Some, FaultInRealtimeTest,
                         testing::Values(Fault{"paper", "fusion", SIGSTOP},
                                         Fault{"paper", "arbitrator", SIGSTOP},
                                         Fault{"dense_fog", "world", SIGKILL}),
                         NameOfFault);
INSTANTIATE_TEST_SUITE_P(Campaign, FaultInRealtimeTest, testing::ValuesIn(EveryFault()),
                         NameOfFault);

}  // namespace
}  // namespace fogline::test
