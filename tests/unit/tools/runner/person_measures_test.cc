#include "tools/runner/person_measures.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "services/log/event_log.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/copied_log.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

using testing::SizeIs;

constexpr std::int64_t kSeat = 42;

/// The message that a seat sends after a step.
using SeatAct = std::function<driver_input_t(std::int64_t step)>;

/// The log of a run whose driver is asked to take over, and takes over 2 s later. The tests add the
/// messages of a seat, as if a person had driven.
class PersonMeasuresTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    runner::RunScenario(
        LoadScenario(SourceDirectory() / "scenario/dense_fog.json",
                     {"/steps=120", "/fog/start_s=1", "/fog/duration_s=4",
                      "/arbitrator/take_over/mode=requested", "/arbitrator/take_over/time/mean_s=2",
                      "/arbitrator/take_over/time/std_s=0.01", "/person/take_over_pedal=0.2"}),
        Direct(folder_->File("run.lcm")));
  }
  static void TearDownTestSuite() { delete folder_; }

  /// The run with these inputs. @param named whether the driver's commands name the seat
  static runner::LoggedRun With(const SeatAct& act, bool named = true) {
    const std::string log = folder_->File("person.lcm");
    std::vector<std::uint8_t> bytes;
    std::int64_t sequence = 0;
    Copy(
        folder_->File("run.lcm"), log,
        [&](log::EventLogWriter& writer, const log::Event& event, std::vector<std::uint8_t>& data) {
          if (event.channel == ChannelOf<driver_command_t>().name && named) {
            driver_command_t command{};
            EXPECT_TRUE(runtime::Decode(data, command));
            command.input_instance = kSeat;
            command.input_sequence = sequence;
            runtime::Encode(command, data);
          }
          if (event.channel != ChannelOf<truth_t>().name) return true;
          truth_t truth{};
          EXPECT_TRUE(runtime::Decode(data, truth));
          driver_input_t input = act(truth.header.step);
          input.header = truth.header;
          input.instance = kSeat;
          input.sequence = ++sequence;
          input.present = 1;
          runtime::Encode(input, bytes);
          writer.Write(ChannelOf<driver_input_t>().name, event.utime, bytes);
          return true;
        });
    return runner::ReadLoggedRun(log);
  }

  /// The step of the request in this run.
  static std::int64_t RequestStep() {
    const runner::LoggedRun run = runner::ReadLoggedRun(folder_->File("run.lcm"));
    EXPECT_THAT(run.result.take_overs, SizeIs(1));
    return std::llround(run.result.take_overs.at(0).requested_s / run.scenario.step_s);
  }

  static ScratchFolder* folder_;
};
ScratchFolder* PersonMeasuresTest::folder_ = nullptr;

driver_input_t Brake(double travel) {
  driver_input_t input{};
  input.brake = travel;
  input.latency_us = -1;
  return input;
}

TEST_F(PersonMeasuresTest, HaveTheTimesOfThePedalAfterTheRequest) {
  const std::int64_t requested = RequestStep();
  const runner::LoggedRun run = With([&](std::int64_t step) {
    return Brake(step < requested + 5 ? 0 : step < requested + 8 ? 0.15 : 0.5);
  });
  ASSERT_THAT(run.result.take_overs, SizeIs(1));
  const metrics::TakeOverMeasures& request = run.result.take_overs[0];
  EXPECT_NEAR(request.first_movement_time_s.value_or(-1), 0.5, 1e-9);
  EXPECT_NEAR(request.pedal_on_time_s.value_or(-1), 0.8, 1e-9) << "/person/take_over_pedal is 0.2";
  EXPECT_EQ(request.outcome, metrics::TakeOverEnd::kTakenOver);
}

TEST_F(PersonMeasuresTest, HaveTheLatencyOfTheInputs) {
  const runner::LoggedRun run = With([](std::int64_t step) {
    driver_input_t input = Brake(0);
    input.time_us = 1000 * step;
    input.latency_us = step;
    return input;
  });
  ASSERT_TRUE(run.result.input_latency);
  EXPECT_EQ(run.result.input_latency->inputs, 120);
  EXPECT_EQ(run.result.input_latency->max_us, 119);
}

TEST_F(PersonMeasuresTest, AreThoseOfTheMeasuringWithoutSamples) {
  const SeatAct act = [](std::int64_t step) { return Brake(step < 40 ? 0 : 0.5); };
  const runner::LoggedRun read = With(act);
  const runner::LoggedRun measured = runner::MeasureLoggedRun(read.result.log, read.scenario);
  EXPECT_EQ(measured.result.take_overs, read.result.take_overs);
}

TEST_F(PersonMeasuresTest, AreMissingForASeatFromWhichNoCommandWasMade) {
  const runner::LoggedRun run = With([](std::int64_t) { return Brake(1); }, false);
  ASSERT_THAT(run.result.take_overs, SizeIs(1));
  EXPECT_EQ(run.result.take_overs[0].pedal_on_time_s, std::nullopt);
  EXPECT_FALSE(run.result.input_latency);
}

TEST_F(PersonMeasuresTest, HasNoLatencyIfNoInputHasAMeasurement) {
  const auto act = [](std::int64_t latency_us) {
    return [latency_us](std::int64_t /*step*/) {
      driver_input_t input{};
      input.latency_us = latency_us;
      return input;
    };
  };
  EXPECT_FALSE(With(act(-1)).result.input_latency);
  EXPECT_TRUE(With(act(5'000)).result.input_latency);
}

}  // namespace
}  // namespace fogline::test
