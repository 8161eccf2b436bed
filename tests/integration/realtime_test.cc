// Runs in real time: roles are killed or stopped while the automation drives, and what counts is
// what the cars do. Everything is judged from the log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <map>
#include <optional>
#include <tuple>

#include "services/recorder/event_log.h"
#include "services/runtime/bus.h"
#include "services/runtime/input_state.h"
#include "services/runtime/wire.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

constexpr double kStepS = 0.1;
constexpr double kSpeed = 5;
constexpr double kPeriodS = kStepS / kSpeed;
// A step at which the automation drives in both scenarios, and in which nothing else goes on.
constexpr int kFaultStep = 60;
// Defaults of section minimal_risk.
constexpr double kDecelerationMps2 = 1;
constexpr double kJerkMps3 = 1;
// Rounding of numbers near 100 m.
constexpr double kRounding = 1e-9;

/// A run in real time whose processes this test can stop.
class RealtimeRun {
 public:
  RealtimeRun(const std::string& scenario, int steps, double speed = kSpeed)
      : bus_(FreshMulticastUrl()),
        log_(folder_.File("run.lcm")),
        run_(Command(scenario, steps, speed)) {
    bus_.Subscribe(ChannelOf<truth_t>().name, [this](Arrival& arrival) {
      if (const auto* truth = arrival.As<truth_t>()) step_ = std::max(step_, truth->header.step);
    });
    bus_.Subscribe(ChannelOf<status_t>().name, [this](Arrival& arrival) {
      if (const auto* status = arrival.As<status_t>()) pids_[status->role] = status->pid;
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
  void Signal(const std::string& role, int signal) { kill(pids_.at(role), signal); }

  /// Waits for the end. @return the result
  nlohmann::json Finish() {
    EXPECT_EQ(run_.Wait(), 0) << run_.Err();
    return nlohmann::json::parse(run_.Out(), nullptr, false);
  }
  const std::string& log() const { return log_; }
  const std::string& url() const { return bus_.url(); }
  Background& run() { return run_; }

 private:
  std::vector<std::string> Command(const std::string& scenario, int steps, double speed) const {
    return {Program("fogline"),
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
  }

  ScratchFolder folder_;
  Bus bus_;
  std::string log_;
  Background run_;
  std::int64_t step_ = -1;
  std::map<std::string, pid_t> pids_;
};

/// A log in real time, by step.
struct Log {
  explicit Log(const std::string& file) {
    EventLogReader reader(file);
    while (const auto event = reader.Next()) {
      Take(event->channel, event->data, truth);
      Take(event->channel, event->data, command);
      Take(event->channel, event->data, driver);
      Take(event->channel, event->data, automation);
      status_t heard{};
      if (event->channel == ChannelOf<status_t>().name && Decode(event->data, heard)) {
        status.push_back(heard);
      }
    }
  }

  template <class M>
  static void Take(std::string_view channel, Bytes data, std::map<std::int64_t, M>& messages) {
    M message{};
    if (channel == ChannelOf<M>().name && Decode(data, message)) {
      messages[message.header.step] = message;
    }
  }

  /// The first STATUS in which somebody has lost a channel, and how long it had been silent then.
  struct Loss {
    std::int64_t step;
    double age_s;
    std::string reporter;
    std::string culprit_channel;
  };
  std::optional<Loss> FirstLossOf(const std::string& channel) const {
    for (const status_t& said : status) {
      if (said.role == NameOf(Role::kRecorder)) continue;
      for (std::size_t i = 0; i < said.input.size(); ++i) {
        if (said.input[i] != channel || said.input_state[i] != status_t::INPUT_LOST) continue;
        return Loss{.step = said.header.utime / 100'000,
                    .age_s = static_cast<double>(said.input_age_us[i]) * 1e-6,
                    .reporter = said.role,
                    .culprit_channel = said.waiting_for};
      }
    }
    return std::nullopt;
  }

  std::map<std::int64_t, truth_t> truth;
  std::map<std::int64_t, arbitration_t> command;
  std::map<std::int64_t, driver_command_t> driver;
  std::map<std::int64_t, accel_command_t> automation;
  std::vector<status_t> status;
};

/// What the host's acceleration in the step after `step` may be, given what the log says of it.
void ExpectCommandsAreCarriedOut(const Log& log, std::int64_t from, std::int64_t to) {
  for (std::int64_t step = from; step < to; ++step) {
    ASSERT_TRUE(log.truth.contains(step + 1)) << step;
    const double applied = log.truth.at(step + 1).host_acceleration_mps2;
    if (!log.command.contains(step)) {
      EXPECT_NEAR(applied, log.truth.at(step).host_acceleration_mps2, kRounding)
          << "held at step " << step;
      continue;
    }
    const arbitration_t& command = log.command.at(step);
    EXPECT_NEAR(applied, command.acceleration_mps2, kRounding) << "at step " << step;
    if (command.mode == arbitration_t::HUMAN && log.driver.contains(step)) {
      EXPECT_NEAR(command.acceleration_mps2, log.driver.at(step).acceleration_mps2, kRounding);
    }
  }
}

/// From `step` on the host brakes to standstill within the limits, and stays there.
void ExpectStandstillWithinLimits(const Log& log, std::int64_t step) {
  const truth_t& last = log.truth.rbegin()->second;
  EXPECT_EQ(last.host_speed_mps, 0) << "does not stand at the end";
  bool stood = false;
  for (std::int64_t k = step; k < last.header.step; ++k) {
    const truth_t& before = log.truth.at(k);
    const truth_t& after = log.truth.at(k + 1);
    const double jerk = (after.host_acceleration_mps2 - before.host_acceleration_mps2) / kStepS;
    EXPECT_LE(std::abs(jerk), kJerkMps3 + kRounding) << "step " << k;
    EXPECT_GE(after.host_acceleration_mps2, -kDecelerationMps2 - kRounding) << "step " << k;
    EXPECT_TRUE(!stood || after.host_speed_mps == 0) << "drives off at step " << k;
    stood = stood || after.host_speed_mps == 0;
  }
}

void ExpectNoCollision(const Log& log) {
  for (const auto& [step, truth] : log.truth) {
    ASSERT_EQ(truth.collision, truth_t::COLLISION_NONE) << "step " << step;
  }
}

TEST(RealtimeTest, UndisturbedItIsTheRunInLockstep) {
  RealtimeRun run("scenario/paper.json", 60);
  const auto result = run.Finish();
  const auto& realtime = result["realtime"];
  EXPECT_EQ(realtime["missed_messages"], 0) << realtime.dump(2);
  EXPECT_EQ(realtime["ticks"], 60);
  EXPECT_GT(realtime["latency_p50_us"], 0);
  if (realtime["deadline_misses"] == 0) {
    const Outcome lockstep = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--json",
                                         "--set", "/steps=60", "--transport", "direct"});
    EXPECT_EQ(result["digest"], nlohmann::json::parse(lockstep.out)["digest"]);
  }
}

/// How a role fails, in which scenario.
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

/// The channel by which a role's silence shows.
std::string ChannelOfRole(const std::string& role) {
  std::string name;
  for (const ChannelInfo& channel : kChannels) {
    if (NameOf(channel.from) == role && channel.pace == Pace::kStep) name = channel.name;
  }
  return name;
}

void Judge(const Log& log, const Fault& fault, const nlohmann::json& result) {
  SCOPED_TRACE(result["realtime"].dump());
  ExpectNoCollision(log);
  const std::int64_t last = log.truth.rbegin()->first;
  EXPECT_EQ(log.truth.size(), static_cast<std::size_t>(last + 1)) << "steps are left out";
  if (fault.role == "recorder") return ExpectCommandsAreCarriedOut(log, 1, last);
  const auto loss = log.FirstLossOf(ChannelOfRole(fault.role));
  // Who is killed may be back before anybody misses it.
  if (!loss && fault.signal == SIGKILL) return ExpectCommandsAreCarriedOut(log, 1, last);
  ASSERT_TRUE(loss);
  EXPECT_LE(loss->age_s, 3 * kPeriodS);
  EXPECT_EQ(loss->culprit_channel, ChannelOfRole(fault.role)) << loss->reporter;
  const std::int64_t begin = loss->step;
  if (fault.role == "arbitrator") {
    // The vehicle stops by itself, from the next step on, whatever the next arbitrator says.
    EXPECT_LT(log.truth.at(begin + 2).host_acceleration_mps2,
              log.truth.at(begin).host_acceleration_mps2);
    ExpectStandstillWithinLimits(log, begin);
  } else if (fault.role == "world" || fault.role == "follower" || fault.role == "driver") {
    // The host is none the worse for it.
    ExpectCommandsAreCarriedOut(log, 1, last);
  } else {
    ASSERT_TRUE(log.command.contains(begin + 1));
    EXPECT_EQ(log.command.at(begin + 1).mode, arbitration_t::HUMAN);
    ExpectCommandsAreCarriedOut(log, 1, last);
  }
}

class FaultInRealtimeTest : public testing::TestWithParam<Fault> {};

TEST_P(FaultInRealtimeTest, LeavesNoCarUndecided) {
  const Fault& fault = GetParam();
  // From 20 m/s the manoeuvre takes 21 s.
  const int steps = fault.role == "arbitrator" ? kFaultStep + 230 : kFaultStep + 80;
  // Until the recorder's silence counts as a hang a second passes: not more periods than the others
  // keep their messages for it.
  const double speed = fault.role == "recorder" ? 2 : kSpeed;
  RealtimeRun run("scenario/" + fault.scenario + ".json", steps, speed);
  run.WaitForStep(kFaultStep);
  run.Signal(fault.role, fault.signal);
  const auto result = run.Finish();
  Judge(Log(run.log()), fault, result);
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

// Some faults always; every role, killed and stopped, in the campaign.
INSTANTIATE_TEST_SUITE_P(Some, FaultInRealtimeTest,
                         testing::Values(Fault{"paper", "fusion", SIGSTOP},
                                         Fault{"paper", "arbitrator", SIGSTOP},
                                         Fault{"dense_fog", "world", SIGKILL}),
                         NameOfFault);
INSTANTIATE_TEST_SUITE_P(Campaign, FaultInRealtimeTest, testing::ValuesIn(EveryFault()),
                         NameOfFault);

}  // namespace
}  // namespace fogline::test
