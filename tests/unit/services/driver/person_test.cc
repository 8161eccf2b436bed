// A person who drives in place of the model of a driver.
#include <gtest/gtest.h>

#include "services/driver/driver.h"

namespace fogline {
namespace {

Scenario WithPerson(TakeOverBy by = TakeOverBy::kEither) {
  Scenario scenario;
  scenario.person.drives = true;
  scenario.person.take_over_by = by;
  scenario.driver.readiness = 0.8;
  return scenario;
}

driver_input_t Input(double throttle, double brake, std::int32_t buttons = 0) {
  driver_input_t input{};
  input.instance = 42;
  input.sequence = 7;
  input.present = 1;
  input.throttle = throttle;
  input.brake = brake;
  input.buttons = buttons;
  return input;
}

truth_t Truth(std::int64_t step) {
  truth_t truth{};
  truth.header = {.run_id = 9, .step = step, .utime = step * 20'000};
  truth.host_speed_mps = 20;
  truth.host_gap_m = 30;
  return truth;
}

driver_command_t Answer(const Scenario& scenario, const driver_input_t* input) {
  driver::Driver driver(scenario);
  driver.SetLiveInput(input);
  return driver.Step(Truth(4));
}

TEST(PersonTest, CommandsWhatThePedalsSayAndNamesTheInput) {
  const Scenario scenario = WithPerson();
  const driver_input_t input = Input(0.6, 0);
  const driver_command_t command = Answer(scenario, &input);
  EXPECT_EQ(command.header.step, 4);
  EXPECT_EQ(command.header.run_id, 9);
  EXPECT_EQ(command.acceleration_mps2, models::PedalResponse(scenario.person).Acceleration(0.6, 0));
  EXPECT_EQ(command.readiness, 0.8);
  EXPECT_EQ(command.input_instance, 42);
  EXPECT_EQ(command.input_sequence, 7);
}

TEST(PersonTest, IsNotReadyAndReleasesThePedalsWhenTheSeatIsEmpty) {
  const Scenario scenario = WithPerson();
  constexpr std::int32_t kBoth = 3;
  driver_input_t absent = Input(1, 1, kBoth);
  absent.present = 0;
  for (const driver_input_t* input :
       {static_cast<const driver_input_t*>(nullptr), static_cast<const driver_input_t*>(&absent)}) {
    const driver_command_t command = Answer(scenario, input);
    EXPECT_EQ(command.acceleration_mps2, -scenario.person.coasting_mps2);
    EXPECT_EQ(command.readiness, 0);
    EXPECT_FALSE(command.acknowledged);
    EXPECT_FALSE(command.gives_back);
    EXPECT_EQ(command.input_instance, 0);
    EXPECT_EQ(command.input_sequence, -1);
  }
}

TEST(PersonTest, IsNotThereBeforeTheFirstInput) {
  driver::Driver driver(WithPerson());
  EXPECT_EQ(driver.Step(Truth(0)).readiness, 0);
  EXPECT_EQ(driver.Step(Truth(0)).input_sequence, -1);
}

TEST(PersonTest, AcknowledgesByButtonByPedalOrByEither) {
  const driver_input_t button = Input(0, 0, driver_input_t::TAKE_OVER);
  const driver_input_t pedal = Input(0, 0.5);
  const driver_input_t neither = Input(0.05, 0.05);
  const auto acknowledges = [](TakeOverBy by, const driver_input_t& input) {
    return Answer(WithPerson(by), &input).acknowledged != 0;
  };
  EXPECT_TRUE(acknowledges(TakeOverBy::kButton, button));
  EXPECT_FALSE(acknowledges(TakeOverBy::kButton, pedal));
  EXPECT_FALSE(acknowledges(TakeOverBy::kPedal, button));
  EXPECT_TRUE(acknowledges(TakeOverBy::kPedal, pedal));
  EXPECT_TRUE(acknowledges(TakeOverBy::kEither, button));
  EXPECT_TRUE(acknowledges(TakeOverBy::kEither, pedal));
  EXPECT_FALSE(acknowledges(TakeOverBy::kEither, neither));
}

TEST(PersonTest, GivesBackByItsButton) {
  const driver_input_t input = Input(0, 0, driver_input_t::GIVE_BACK);
  EXPECT_TRUE(Answer(WithPerson(), &input).gives_back);
  EXPECT_FALSE(Answer(WithPerson(), &input).acknowledged);
}

// A command depends on its input alone, so a replay needs no earlier input.
TEST(PersonTest, RemembersNothing) {
  const Scenario scenario = WithPerson();
  driver::Driver driver(scenario);
  const driver_input_t first = Input(0, 1, driver_input_t::TAKE_OVER);
  driver.SetLiveInput(&first);
  driver.Step(Truth(3));
  const driver_input_t second = Input(0.3, 0);
  driver.SetLiveInput(&second);
  const driver_command_t command = driver.Step(Truth(4));
  const driver_command_t alone = Answer(scenario, &second);
  EXPECT_EQ(command.acceleration_mps2, alone.acceleration_mps2);
  EXPECT_EQ(command.acknowledged, alone.acknowledged);
}

TEST(PersonTest, LeavesTheModelledDriverAsHeIs) {
  EXPECT_FALSE(driver::Driver::UsesLiveInput(Scenario()));
  driver::Driver driver{Scenario()};
  const driver_command_t& command = driver.Step(Truth(4));
  EXPECT_FALSE(command.acknowledged);
  EXPECT_FALSE(command.gives_back);
  EXPECT_EQ(command.input_instance, 0);
  EXPECT_EQ(command.input_sequence, -1);
}

}  // namespace
}  // namespace fogline
