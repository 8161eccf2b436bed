// Tests in real processes. In some runs a person overrides the automation by the brake. In another
// run the person leaves the seat and comes back. The driver of each run is computed again from the
// logged inputs.
#include <string>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/drive/driven_run.h"

namespace fogline::test {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::Not;
using Words = std::vector<std::string>;

/// The JSON that a verb prints. The verb must succeed.
nlohmann::json VerbOf(const Words& words) {
  Words command{Program("fogline")};
  command.insert(command.end(), words.begin(), words.end());
  const Outcome outcome = RunCommand(command);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

Words TextsOf(const nlohmann::json& events) {
  Words texts;
  for (const auto& event : events["events"]) texts.push_back(event["event"]);
  return texts;
}

/// Runs a scenario that a person drives by a script. @return what `fogline events` prints
nlohmann::json EventsOf(const std::string& script, Words settings) {
  settings.emplace_back(kLateRolesAreNotLost);
  settings.emplace_back(kALatePersonIsThere);
  RealtimeRun run(kDriveScenario, 600, 1, settings);
  const Background seat(SeatCommand(run.url(), script));
  run.Finish();
  const auto replay = VerbOf({"replay", run.log(), "--role", "driver", "--json"});
  EXPECT_EQ(replay["roles"][0]["same"], true) << replay;
  return VerbOf({"events", run.log(), "--json"})[0];
}

// The person brakes from 2 s to 3 s, and gives authority back at 4.5 s (scripted_seat.cc). The fog
// begins after 15 s, so the arbitrator sends no request in these runs of 12 s.
constexpr const char* kBrakes = "0 0 0 0 1; 2 0 0.6 0 1; 3 0 0 0 1; 4.5 0 0 2 1";

TEST(OverrideInRealtimeTest, ABrakeTakesOverWithoutARequestUntilThePersonGivesBack) {
  const auto events = EventsOf(kBrakes, {"/person/drives=true", "/person/override_by=brake",
                                         "/arbitrator/take_over/recovery_s=1"});
  EXPECT_EQ(TextsOf(events), (Words{"activation of the automation", "override by the person",
                                    "first effective input of the human", "human recovered",
                                    "transfer to the automation"}))
      << events;
  EXPECT_THAT(events["requests"], IsEmpty());
}

TEST(OverrideInRealtimeTest, WithoutTheChoiceABrakeHasNoEffectBeforeARequest) {
  const auto events = EventsOf(kBrakes, {"/person/drives=true"});
  EXPECT_EQ(TextsOf(events), Words{"activation of the automation"});
}

TEST(ReturnInRealtimeTest, APersonWhoComesBackEndsTheManoeuvreByAnAnswer) {
  Words settings = AlwaysAsked();
  settings.emplace_back("/person/when_gone=until_back");
  const Words texts =
      TextsOf(EventsOf("0 0 0 1 1; 1 0.2 0 0 1; 2.5 0 0 0 0; 3.5 0 0 0 1; 4.5 0 0 1 1", settings));
  EXPECT_THAT(texts, Contains("manoeuvre begins: person gone"));
  EXPECT_THAT(texts, Contains("human ends manoeuvre"));
  EXPECT_THAT(texts, Not(Contains("manoeuvre begins: inputs or person gone")));
}

TEST(ChoicesOfAPersonInRealtimeTest, AreRefusedForADriverWhoNeedNotBeAsked) {
  const Outcome outcome = RunCommand({Program("fogline"), "drive", "scenario/paper.json", "--evdev",
                                      "/dev/null", "--set", "/person/override_by=brake"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::HasSubstr("needs /arbitrator/take_over/mode \"requested\""));
}

}  // namespace
}  // namespace fogline::test
