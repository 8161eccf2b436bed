// Real time on a network that loses many messages. The tests examine when the recorder ends, which
// steps its log has, and what the run reports about messages that the log lacks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "services/log/event_log.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/wire.h"
#include "tests/integration/realtime/not_whole.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

constexpr int kLossyRunRate_hz = 50;

/// Receives, on the machine of a run, the newest step of the world and the STOP of the runner.
class Listener {
 public:
  explicit Listener(const Machine& machine) {
    machine.Enter([this] { bus_.emplace(kUrl); });
    bus_->Subscribe(ChannelOf<truth_t>().name, [this](runtime::Arrival& arrival) {
      step_ = std::max(step_, runtime::ReadInt64(arrival.bytes(), runtime::kStepOffset));
    });
    bus_->Subscribe(ChannelOf<run_t>().name, [this](runtime::Arrival& arrival) {
      const auto* run = arrival.As<run_t>();
      stopped_ = stopped_ || (run != nullptr && run->phase == run_t::STOP);
    });
  }
  bool WaitForStep(std::int64_t step) {
    const TimePoint end = Clock::now() + kPatience;
    while (step_ < step && Clock::now() < end) bus_->Wait(milliseconds(20));
    return step_ >= step;
  }
  /// Whether a process still exists when the runner sends STOP.
  bool LivesUntilStop(pid_t process) {
    const TimePoint end = Clock::now() + kPatience;
    while (!stopped_ && IsAlive(process) && Clock::now() < end) bus_->Wait(milliseconds(5));
    // The process may have received STOP a moment before this listener.
    const TimePoint grace = Clock::now() + milliseconds(200);
    while (!stopped_ && Clock::now() < end) {
      if (!bus_->Wait(milliseconds(5)) && Clock::now() > grace) break;
    }
    return stopped_;
  }

 private:
  std::optional<runtime::Bus> bus_;
  std::int64_t step_ = -1;
  bool stopped_ = false;
};

class LossyNetworkInRealtimeTest : public NetworkTest {
 protected:
  void SetUp() override {
    NetworkTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    machine_.emplace("lossy");
    machine_->RouteMulticastToItself();
  }
  /// The command line of a run in real time, with 50 steps per second.
  std::vector<std::string> RealtimeRun(int steps) {
    return machine_->On(
        Run({"--realtime", "--set", "/step_s=" + std::to_string(1.0 / kLossyRunRate_hz), "--set",
             "/steps=" + std::to_string(steps), "--lcm-url", kUrl}));
  }
  /// Makes the network lose everything for this time. The time is fixed, because some tests need a
  /// loss of a certain length.
  void LoseEverythingFor(Duration time) const {
    machine_->LoseUdp(100);
    std::this_thread::sleep_for(time);
    machine_->LoseNothing();
  }
  /// The newest steps in the log of the last run, by channel.
  std::array<std::int64_t, kNumChannels> NewestSteps() const {
    std::array<std::int64_t, kNumChannels> newest{};
    newest.fill(-1);
    log::EventLogReader reader(Log());
    while (const auto event = reader.Next()) {
      for (std::size_t i = 0; i < kNumChannels; ++i) {
        if (kChannels[i].pace != Pace::kStep || kChannels[i].name != event->channel) continue;
        newest[i] = std::max(newest[i], runtime::ReadInt64(event->data, runtime::kStepOffset));
      }
    }
    return newest;
  }

  std::optional<Machine> machine_;
};

TEST_F(LossyNetworkInRealtimeTest, ThatLosesAThirdAllTheTimeLeavesNoRoleDeaf) {
  constexpr int kSteps = 300;
  const Outcome outcome =
      RunCommand(machine_->On(Run({"--realtime", "--speed", "4", "--faults", "loss=0.3", "--set",
                                   "/steps=" + std::to_string(kSteps), "--lcm-url", kUrl})));
  const auto result = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(result.is_object()) << outcome.err;
  EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
  if (outcome.code != 0) {
    EXPECT_EQ(outcome.code, kFailed);
    EXPECT_THAT(outcome.err, HasSubstr(kNotWhole));
  }
  // Every role and the recorder receive and send until the end. So each channel must have a message
  // near the end: in the last 50 steps, or in the last 150 steps for ACC_COMMAND. An ACC_COMMAND
  // comes only if six messages of its step arrive, one after another. So the log has an ACC_COMMAND
  // for about one step in eight. In one of a thousand runs the log has no ACC_COMMAND for the last
  // 50 steps. In one of a hundred million runs it has none for the last 150 steps.
  const auto newest = NewestSteps();
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (kChannels[i].pace != Pace::kStep) continue;
    const int last = kChannels[i].name == "ACC_COMMAND" ? 150 : 50;
    EXPECT_GE(newest[i], kSteps - last) << kChannels[i].name;
  }
}

TEST_F(LossyNetworkInRealtimeTest, NearTheEndOfTheRunSendsNoRecorderAwayBeforeStop) {
  constexpr int kSteps = 3 * kLossyRunRate_hz;
  Listener listener(*machine_);
  Background run(RealtimeRun(kSteps));
  ASSERT_TRUE(run.WaitForErr("processes: "));
  const pid_t recorder = PidOf(run.Err(), "recorder");
  ASSERT_NE(recorder, 0) << run.Err();
  // WHEN the network loses everything for half of the last second
  ASSERT_TRUE(listener.WaitForStep(kSteps - kLossyRunRate_hz)) << run.Err();
  LoseEverythingFor(milliseconds(500));
  // THEN the recorder exists until the runner sends STOP, and the log has the last step
  EXPECT_TRUE(listener.LivesUntilStop(recorder)) << run.Err();
  const int code = run.Wait();
  EXPECT_EQ(NewestSteps()[IndexOf<truth_t>()], kSteps - 1) << run.Err();
  if (code != 0) {
    EXPECT_EQ(code, kFailed);
    EXPECT_THAT(run.Err(), HasSubstr(kNotWhole));
  }
}

TEST_F(LossyNetworkInRealtimeTest, ForLongerThanMessagesAreKeptFailsTheRun) {
  Listener listener(*machine_);
  Background run(RealtimeRun(8 * kLossyRunRate_hz));
  ASSERT_TRUE(listener.WaitForStep(kLossyRunRate_hz)) << run.Err();
  // In this second the world begins 50 steps. The recorder asks again only for the last 32 steps,
  // so the log lacks steps.
  LoseEverythingFor(milliseconds(1000));
  EXPECT_EQ(run.Wait(), kFailed);
  EXPECT_THAT(run.Err(), HasSubstr(kNotWhole));
}

}  // namespace
}  // namespace fogline::test
