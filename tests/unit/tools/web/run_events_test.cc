#include "tools/web/run_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline::web {
namespace {

TEST(RunEventsTest, NeedsBoundedMemoryForAnEndlessRun) {
  RunEvents events;
  for (std::int64_t step = 0; step < 50'000; ++step) {
    arbitration_t command{};
    command.header.step = step;
    command.mode = step % 2 == 0 ? arbitration_t::AUTOMATION : arbitration_t::REQUEST;
    events.Add(command, std::nullopt);
    ASSERT_TRUE(events.take_over().entries().empty());
    ASSERT_LE(events.take_over().requests().size(), 1U);
  }
  EXPECT_EQ(events.events().size(), RunEvents::kMost);
  EXPECT_GT(events.left_out(), 40'000U);
}

TEST(RunEventsTest, DoNotBeginWithWhatBeganBeforeTheyWereJoined) {
  truth_t truth{};
  truth.fog_present = 1;
  truth.collision = truth_t::COLLISION_HOST;
  arbitration_t command{};
  command.doc = 0.8;
  command.threshold = 0.5;
  for (const std::int64_t first : {0, 300}) {
    RunEvents events;
    truth.header.step = command.header.step = first;
    events.Add(truth);
    events.Add(command, std::nullopt);
    EXPECT_EQ(events.events().size(), first == 0 ? 3U : 0U);
    // The end of the fog is an event, no matter whether the first message was of step 0 or 300.
    truth_t clear = truth;
    clear.fog_present = 0;
    clear.header.step = first + 1;
    events.Add(clear);
    ASSERT_FALSE(events.events().empty());
    EXPECT_EQ(events.events().back().text, "fog ends");
  }
}

TEST(RunEventsTest, BeginWithTheRequestInWhichTheyWereJoined) {
  RunEvents events;
  arbitration_t command{};
  command.threshold = 0.5;
  command.header.step = 300;
  command.mode = arbitration_t::REQUEST;
  events.Add(command, std::nullopt);
  ASSERT_EQ(events.events().size(), 1U);
  EXPECT_EQ(events.events()[0].text, "state DEMAND");
  EXPECT_EQ(events.events()[0].kind, "request");
}

TEST(RunEventsTest, NameTheStepsInWhichAnEventAfterAGapMayHaveHappened) {
  for (const bool may_lack_commands : {false, true}) {
    RunEvents events;
    events.set_may_lack_commands(may_lack_commands);
    truth_t truth{};
    arbitration_t command{};
    command.threshold = 0.5;
    events.Add(truth);
    events.Add(command, std::nullopt);
    truth.header.step = command.header.step = 3;
    truth.fog_present = 1;
    command.doc = 0.8;
    command.mode = arbitration_t::REQUEST;
    events.Add(truth);
    events.Add(command, std::nullopt);
    const std::string steps = ", in one of the steps 1 to 3";
    ASSERT_EQ(events.events().size(), 3U);
    EXPECT_EQ(events.events()[0].text, "fog begins" + steps);
    const std::string of_command = may_lack_commands ? "" : steps;
    EXPECT_EQ(events.events()[1].text, "DoC 0.80 reaches the threshold 0.50" + of_command);
    EXPECT_EQ(events.events()[2].text, "request to take over" + of_command);
    truth.header.step = 4;
    truth.fog_present = 0;
    events.Add(truth);
    EXPECT_EQ(events.events().back().text, "fog ends");
  }
}

TEST(RunEventsTest, NameAPersonWhoMayHaveGone) {
  for (const bool drives : {false, true}) {
    RunEvents events;
    PersonSection person;
    person.drives = drives;
    events.set_person(person);
    arbitration_t command{};
    command.mode = arbitration_t::HUMAN;
    command.lambda_human = 1;
    events.Add(command, std::nullopt);
    command.header.step = 1;
    command.mode = arbitration_t::MINIMAL_RISK;
    command.lambda_human = 0;
    events.Add(command, std::nullopt);
    EXPECT_EQ(events.events().back().text, drives ? "manoeuvre begins: inputs or person gone"
                                                  : "manoeuvre begins: inputs have failed");
  }
}

TEST(RunEventsTest, TellAnInputFromARequestAndAManoeuvre) {
  RunEvents events;
  arbitration_t command{};
  command.threshold = 0.5;
  events.Add(command, 0.0);
  command.header.step = 1;
  command.mode = arbitration_t::HUMAN;
  command.lambda_human = 1;
  events.Add(command, -2.0);
  ASSERT_FALSE(events.events().empty());
  EXPECT_EQ(events.events().back().kind, "input");
  EXPECT_EQ(events.events().back().text, "first effective input of the human");
  // The first message is of step 300, and shows emergency braking. So it is not known who drove
  // before the manoeuvre, and the events contain no input of the human.
  RunEvents late;
  command.header.step = 300;
  command.mode = arbitration_t::EMERGENCY_BRAKING;
  late.Add(command, std::nullopt);
  command.header.step = 301;
  command.mode = arbitration_t::MRM_COMFORT;
  command.lambda_human = 0;
  late.Add(command, std::nullopt);
  ASSERT_FALSE(late.events().empty());
  for (const RunEvent& event : late.events()) EXPECT_NE(event.kind, "input") << event.text;
  EXPECT_THAT(late.events(), testing::Contains(testing::Field(&RunEvent::kind, "manoeuvre")));
}

TEST(RunEventsTest, NameAPersonAlsoInEventsThatCameBeforeTheScenario) {
  RunEvents events;
  arbitration_t command{};
  command.mode = arbitration_t::HUMAN;
  command.lambda_human = 1;
  command.threshold = 0.5;
  events.Add(command, std::nullopt);
  command.header.step = 3;
  command.doc = 0.8;
  command.mode = arbitration_t::MINIMAL_RISK;
  command.lambda_human = 0;
  events.Add(command, std::nullopt);
  const auto texts = [&events] {
    std::vector<std::string> all;
    for (const RunEvent& event : events.events()) all.push_back(event.text);
    return all;
  };
  const std::vector<std::string> unknown = texts();
  ASSERT_EQ(unknown.size(), 3U);
  EXPECT_EQ(unknown[2], "manoeuvre begins: inputs have failed, in one of the steps 1 to 3");
  events.set_person({.drives = true});
  EXPECT_EQ(texts(), (std::vector<std::string>{
                         unknown[0], unknown[1],
                         "manoeuvre begins: inputs or person gone, in one of the steps 1 to 3"}));
  events.set_person({});
  EXPECT_EQ(texts(), unknown);
}

}  // namespace
}  // namespace fogline::web
