// The role driver receives arbitrary messages of seats while a person drives. Input: messages. Each
// message has the time since the previous message (one byte, in units of 2 ms) and a datagram.
#include <cmath>

#include "services/driver/driver.h"
#include "services/runtime/seat/seat_gate.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

constexpr Duration kDeadman = milliseconds(300);
constexpr Duration kUnit = milliseconds(2);

Scenario WithPerson() {
  Scenario scenario;
  scenario.person.drives = true;
  return scenario;
}

void DemandWithinLimits(const driver_command_t& command, const PersonSection& person) {
  Demand(std::isfinite(command.acceleration_mps2), "an acceleration is a number");
  Demand(command.acceleration_mps2 <= person.full_throttle_mps2 &&
             command.acceleration_mps2 >= -person.full_brake_mps2,
         "no pedal does more than a full pedal");
  Demand(command.readiness >= 0 && command.readiness <= 1, "readiness is in [0, 1]");
  if (command.input_instance != 0) return;
  Demand(command.readiness == 0 && command.input_sequence == -1 && !command.acknowledged &&
             !command.gives_back && command.acceleration_mps2 == -person.coasting_mps2,
         "an empty seat does nothing");
}

void Play(Cutter& cutter) {
  const Scenario scenario = WithPerson();
  driver::Driver driver(scenario);
  runtime::SeatGate gate(kDeadman);
  TimePoint now = TimePoint() + std::chrono::hours(1);
  TimePoint accepted = now;
  std::int64_t holder = 0;
  while (!cutter.empty()) {
    now += kUnit * cutter.Byte();
    const bool held = gate.Newest(now) != nullptr;
    Demand(!held || now - accepted < kDeadman, "silence is noticed");
    driver_input_t input{};
    const bool sound = runtime::Examine(cutter.Datagram(), input) == nullptr;
    if (sound && gate.Take(input, now) == nullptr && runtime::WrongIn(input) == nullptr) {
      Took();
      const driver_input_t* newest = gate.Newest(now);
      Demand(!held || newest == nullptr || newest->instance == holder, "one seat has the driver");
      if (newest != nullptr) {
        if (newest->instance != holder || newest->sequence == input.sequence) accepted = now;
        holder = newest->instance;
      }
    }
    driver.SetLiveInput(gate.Newest(now));
    DemandWithinLimits(driver.Step(Sample<truth_t>(1)), scenario.person);
  }
}

void Add(std::uint8_t wait, const driver_input_t& message, Input& input) {
  input.push_back(wait);
  AddDatagram(Encoded(message), input);
}

}  // namespace

std::vector<Input> Seeds() {
  Input one;
  Input two;
  for (std::int64_t step = 0; step < kSteps; ++step) {
    driver_input_t message = Sample<driver_input_t>(step);
    Add(20, message, one);
    Add(20, message, two);
    message.instance = 4712;
    Add(0, message, two);
    message.present = 0;
    Add(200, message, two);
  }
  return {one, two};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::Cutter cutter({data, size});
  fogline::fuzz::Play(cutter);
  return 0;
}
