// A person who drives, in real processes: which seat may drive, how the person takes over and gives
// authority back, and the replay of the person's inputs.
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/driver_inputs.h"
#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/driver_input.h"
#include "tests/integration/drive/driven_run.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

TEST(PersonTest, DrivesOnlyInRealTime) {
  const ScratchFolder folder;
  for (const Words& how :
       {Words{"run", "--transport", "direct"}, Words{"run", "--transport", "memq"}, Words{"run"},
        Words{"table", "--seeds", "1:2"},
        Words{"sweep", "--seeds", "1:2", "--out", folder.File("rows.csv")}}) {
    Words command{Program("fogline"), how[0], "scenario/paper.json", "--set",
                  "/person/drives=true"};
    command.insert(command.end(), how.begin() + 1, how.end());
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, 2) << how[0] << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("/person/drives: a person drives only in real time"));
  }
}

/// A run in which the person is asked in the first step, takes over by the button, drives, and
/// varies both pedals.
class DrivenRunInRealtimeTest : public testing::Test {
 protected:
  static constexpr const char* kScript =
      "0 0 0 1 1; 0.5 0.3 0 0 1; 1.5 0.6 0 0 1; 2 0 0.4 0 1; 2.5 0.1 0 0 1";

  void Drive(const std::string& script = kScript) {
    Background seat(SeatCommand(run_.url(), script));
    result_ = run_.Finish();
    EXPECT_EQ(seat.Wait(std::chrono::seconds(0)), -1) << "the seat outlives the run";
  }
  nlohmann::json Verb(const Words& words, int code) const {
    Words command{Program("fogline")};
    command.insert(command.end(), words.begin(), words.end());
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
  /// A copy of the log with changed inputs. `change` returns false to leave an input out.
  template <class Change>
  std::string Altered(const Change& change) {
    const std::string altered = folder_.File("altered.lcm");
    log::EventLogReader reader(run_.log());
    log::EventLogWriter writer(altered);
    while (const auto event = reader.Next()) {
      std::vector<std::uint8_t> data(event->data.begin(), event->data.end());
      driver_input_t input{};
      if (event->channel == ChannelOf<driver_input_t>().name && runtime::Decode(data, input)) {
        if (!change(input)) continue;
        runtime::Encode(input, data);
      }
      writer.Write(event->channel, event->utime, data);
    }
    return altered;
  }
  nlohmann::json ReplayOf(const std::string& log, int code) {
    return Verb({"replay", log, "--role", "driver", "--json"}, code)["roles"][0];
  }

  ScratchFolder folder_;
  RealtimeRun run_{kDriveScenario, 400, 1, AlwaysAsked()};
  nlohmann::json result_;
};

TEST_F(DrivenRunInRealtimeTest, LogsWhatThePersonDoesAndReplaysItBitByBit) {
  Drive();
  const auto inputs = log::ReadDriverInputs(run_.log(), [&] {
    log::RunLogReader reader(run_.log());
    while (reader.Next() != nullptr) {
    }
    return reader.run().run_id;
  }());
  ASSERT_GT(inputs.size(), 80U) << "at least 20 in each of the last 4 s of 8 s";
  std::set<double> throttles;
  for (const driver_input_t& input : inputs) throttles.insert(input.throttle);
  EXPECT_EQ(throttles, (std::set<double>{0, 0.1, 0.3, 0.6}));
  // THEN the replay computes the same commands again, from the inputs that the commands name
  const nlohmann::json same = ReplayOf(run_.log(), 0);
  EXPECT_EQ(same["same"], true) << same;
  // THEN the replay reports a changed pedal, and an input that the log lacks
  const auto changed = ReplayOf(Altered([](driver_input_t& input) {
                                  if (input.throttle == 0.6) input.throttle = 0.61;
                                  return true;
                                }),
                                1);
  EXPECT_EQ(changed["same"], false);
  EXPECT_EQ(changed["first"]["field"], "acceleration_mps2");
  const auto lacking =
      ReplayOf(Altered([](const driver_input_t& input) { return input.brake != 0.4; }), 1);
  EXPECT_EQ(lacking["first"]["field"], "input_sequence");
  EXPECT_EQ(lacking["first"]["replay"], "not in the log");
  const auto absent = ReplayOf(Altered([](driver_input_t& input) {
                                 if (input.throttle == 0.6) input.present = 0;
                                 return true;
                               }),
                               1);
  EXPECT_EQ(absent["first"]["channel"], "DRIVER_COMMAND");
  // In a run in real time, only the steps of the driver can be computed again.
  const Outcome other = RunCommand({Program("fogline"), "replay", run_.log(), "--role", "acc"});
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("a run in real time"));
}

TEST_F(DrivenRunInRealtimeTest, SaysThatThePersonHasAcknowledged) {
  Drive();
  const auto events = Verb({"events", run_.log(), "--json"}, 0)[0];
  std::vector<std::string> texts;
  for (const auto& event : events["events"]) texts.push_back(event["event"]);
  EXPECT_THAT(texts, testing::Contains("acknowledgement by the person"));
  EXPECT_THAT(texts, testing::Contains("transfer to the human"));
  ASSERT_EQ(events["requests"].size(), 1U);
  // The seat's script begins at the first TRUTH that the seat receives. From then on the button is
  // pressed. On a busy machine the seat may receive this TRUTH late, so the limit is 5 s.
  EXPECT_LT(events["requests"][0]["acknowledged_s"], 5);
  const Outcome drawn =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--quiet", "--set",
                  "/arbitrator/take_over/mode=requested", "--log", folder_.File("drawn.lcm")});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  const Outcome text = RunCommand({Program("fogline"), "events", folder_.File("drawn.lcm")});
  EXPECT_THAT(text.out, HasSubstr("acknowledgement (driver model)"));
}

TEST_F(DrivenRunInRealtimeTest, RefusesCountsAndNamesInputsThatAreWrong) {
  Background seat(SeatCommand(run_.url(), "0 0.2 0 1 1"));
  Commands commands(run_.url());
  ASSERT_GE(commands.WaitFor([&] { return commands.driver.input_instance != 0; }), 0);
  const std::int64_t instance = commands.driver.input_instance;
  runtime::Bus bus(run_.url());
  const auto send = [&](const auto& change) {
    driver_input_t input{};
    input.header = commands.driver.header;
    input.header.step = -1;
    input.instance = 4711;
    input.latency_us = -1;
    input.present = 1;
    change(input);
    std::vector<std::uint8_t> bytes;
    runtime::Encode(input, bytes);
    bus.Publish(ChannelOf<driver_input_t>().name, bytes);
  };
  for (int i = 0; i < 3; ++i) {
    send([](driver_input_t&) {});  // a second seat
    send([](driver_input_t& input) { input.brake = 1.5; });
    send([](driver_input_t& input) { input.throttle = std::nan(""); });
    send([](driver_input_t& input) { input.header.run_id += 1; });
  }
  const nlohmann::json result = run_.Finish();
  EXPECT_GE(result["refused"]["second_seat"], 3);
  EXPECT_GE(result["refused"]["out_of_range"], 3);
  EXPECT_GE(result["refused"]["not_finite"], 3);
  EXPECT_GE(result["refused"]["foreign"], 3);
  commands.WaitFor([] { return false; }, milliseconds(50));
  EXPECT_EQ(commands.driver.input_instance, instance) << "the first seat has driven to the end";
}

}  // namespace
}  // namespace fogline::test
