#include "tools/trials/desk/page_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fogline::trials {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

Next NextRun() {
  return {.trial = {.participant = 3, .practice = false, .number = 2, .index = 0},
          .of = 3,
          .not_before_s = 0,
          .for_experimenter = "secret-condition, seed 4711"};
}

QuestionnaireSection Questions() {
  QuestionnaireSection questionnaire;
  questionnaire.name = "secret-name";
  questionnaire.kind = QuestionnaireKind::kKss;
  return WithItems(questionnaire);
}

TEST(PageStateTest, APageThatIsOpenedInABreakGetsTheTimeThatIsLeft) {
  PageState state(1);
  const TimePoint before = Clock::now();
  state.Wait(NextRun(), 30);
  const TimePoint after = Clock::now();
  const auto wait_s = [&state](TimePoint now) {
    const double of_participant = json::parse(state.ForParticipant(now))["wait_s"].get<double>();
    EXPECT_EQ(json::parse(state.ForExperimenter(now))["wait_s"].get<double>(), of_participant);
    return of_participant;
  };
  EXPECT_GE(wait_s(before + milliseconds(10'000)), 20);
  EXPECT_LE(wait_s(after + milliseconds(10'000)), 20);
  EXPECT_GT(wait_s(after + milliseconds(40'000)), 0);  // until the session ends the break
  state.Wait(NextRun(), 0);
  EXPECT_EQ(wait_s(after), 0);
}

TEST(PageStateTest, TheParticipantSeesNothingOfConditionSeedOrView) {
  PageState state(1);
  const auto expect_silence = [&state] {
    for (const char* secret : {"secret", "4711", "7690", "marker"}) {
      EXPECT_THAT(state.ForParticipant(), Not(HasSubstr(secret)));
    }
  };
  state.Wait(NextRun(), 30);
  expect_silence();
  EXPECT_THAT(state.ForExperimenter(), HasSubstr("secret-condition, seed 4711"));
  EXPECT_EQ(json::parse(state.ForExperimenter())["drives"],
            json::parse(state.ForParticipant())["drives"]);
  EXPECT_TRUE(json::parse(state.ForExperimenter())["drives"].is_boolean());
  state.OpenRun("http://127.0.0.1:7690/", "");
  state.Drive();
  state.Tell("marker: yawns");
  expect_silence();
  EXPECT_THAT(state.ForExperimenter(), HasSubstr("7690"));
  state.Ask(NextRun(), Questions());
  expect_silence();
  EXPECT_THAT(json::parse(state.ForParticipant())["items"], SizeIs(1));
  state.Finish();
  expect_silence();
}

TEST(PageStateTest, TheExperimenterSeesWhenEachThingHappened) {
  using namespace std::chrono_literals;
  PageState state(1);
  const std::chrono::system_clock::time_point start{1'700'000'000s};
  state.Tell("the run begins", start);
  state.Tell("marker: yawns", start + 1500ms);
  const json lines = json::parse(state.ForExperimenter())["lines"];
  EXPECT_EQ(lines, json::parse(R"([{"at_ms": 1700000000000, "text": "the run begins"},
                                   {"at_ms": 1700000001500, "text": "marker: yawns"}])"));
}

TEST(PageStateTest, TheParticipantWhoDrivesSeesTheSeatWhileItIsOpen) {
  PageState state(1);
  Next next = NextRun();
  next.seat = true;
  const auto seen = [&state] { return json::parse(state.ForParticipant()); };
  state.Wait(next, 0);
  EXPECT_EQ(seen()["drives"], true);
  EXPECT_FALSE(seen().contains("seat"));
  state.OpenRun("http://127.0.0.1:7690/#token=secret", "http://127.0.0.1:7690/drive#token=a");
  EXPECT_EQ(seen()["stage"], "seating");
  EXPECT_EQ(seen()["seat"], "http://127.0.0.1:7690/drive#token=a");
  EXPECT_THAT(state.ForExperimenter(), HasSubstr("7690/#token=secret"));
  state.Drive();
  EXPECT_EQ(seen()["stage"], "driving");
  EXPECT_EQ(seen()["seat"], "http://127.0.0.1:7690/drive#token=a");
  EXPECT_THAT(state.ForParticipant(), Not(HasSubstr("secret")));
  // Each change gets a new number, so the page notices the change.
  const std::int64_t before = seen()["state"];
  state.MoveRun("http://127.0.0.1:7690/#token=secret", "");
  EXPECT_EQ(seen()["seat"], "");
  EXPECT_EQ(seen()["state"], before + 1);
  state.Ask(NextRun(), Questions());
  EXPECT_FALSE(seen().contains("seat"));
}

TEST(PageStateTest, ARunThatTheModelDrivesHasNoSeat) {
  PageState state(1);
  state.Wait(NextRun(), 0);
  state.OpenRun("http://127.0.0.1:7690/", "");
  const json seen = json::parse(state.ForParticipant());
  EXPECT_EQ(seen["stage"], "waiting");
  EXPECT_EQ(seen["drives"], false);
  // The participant does not get the seat of another run either.
  state.OpenRun("http://127.0.0.1:7690/", "http://127.0.0.1:7690/drive#token=a");
  state.Drive();
  EXPECT_FALSE(json::parse(state.ForParticipant()).contains("seat"));
}

TEST(PageStateTest, QuestionsAreAboutTheirRunAlsoInASessionThatGoesOn) {
  PageState state(1);
  state.Ask(NextRun(), Questions());
  for (const std::string& page : {state.ForParticipant(), state.ForExperimenter()}) {
    EXPECT_EQ(json::parse(page)["run"], 2);
    EXPECT_EQ(json::parse(page)["of"], 3);
  }
  EXPECT_EQ(json::parse(state.ForExperimenter())["participant"], 3);
  EXPECT_THAT(state.ForExperimenter(), HasSubstr("secret-condition, seed 4711"));
}

TEST(PageStateTest, AnAnswerFitsItsState) {
  PageState state(10);
  std::string why;
  state.Wait(NextRun(), 0);
  EXPECT_TRUE(state.FromParticipant(R"({"op":"begin","state":11})", why));
  EXPECT_FALSE(state.FromParticipant(R"({"op":"begin","state":10})", why));
  EXPECT_FALSE(state.FromParticipant(R"({"op":"answers","state":11,"values":[]})", why));
  state.Ask(NextRun(), Questions());
  EXPECT_FALSE(state.FromParticipant(R"({"op":"begin","state":12})", why));
  const auto message = state.FromParticipant(R"({"op":"answers","state":12,"values":["7"]})", why);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->answers[0].value, 7);
  EXPECT_FALSE(state.FromParticipant(R"({"op":"answers","state":12,"values":["10"]})", why));
  EXPECT_EQ(why, "sleepiness needs a number from 1 to 9 in steps of 1");
}

TEST(PageStateTest, NoRunBeginsInABreak) {
  PageState state(1);
  std::string why;
  state.Wait(NextRun(), 30);
  EXPECT_FALSE(state.FromParticipant(R"({"op":"begin","state":2})", why));
  EXPECT_EQ(why, "the break is not over");
  EXPECT_FALSE(state.FromExperimenter(R"({"op":"begin","state":2})", why));
  state.Wait(NextRun(), 0);
  EXPECT_TRUE(state.FromParticipant(R"({"op":"begin","state":3})", why));
  EXPECT_TRUE(state.FromExperimenter(R"({"op":"begin","state":3})", why));
}

TEST(PageStateTest, FramesThatAreNoAnswersAreRefused) {
  PageState state(10);
  state.Ask(NextRun(), Questions());
  for (const char* frame :
       {"", "x", "[]", "null", "7", R"({"op":"answers"})", R"({"op":7,"state":11})",
        R"({"op":"answers","state":"11","values":["7"]})",
        R"({"op":"answers","state":11,"values":[7]})",
        R"({"op":"answers","state":11,"values":["7","7"]})",
        R"({"op":"answers","state":11,"values":{"a":"7"}})"}) {
    std::string why;
    EXPECT_FALSE(state.FromParticipant(frame, why)) << frame;
    EXPECT_NE(why, "") << frame;
    EXPECT_FALSE(state.FromExperimenter(frame, why)) << frame;
  }
}

TEST(PageStateTest, MarkersAreTakenDuringARunOnly) {
  PageState state(1);
  std::string why;
  constexpr const char* kMarker = R"({"op":"marker","text":"yawns"})";
  EXPECT_FALSE(state.FromExperimenter(kMarker, why));
  state.Drive();
  EXPECT_EQ(state.FromExperimenter(kMarker, why)->text, "yawns");
  EXPECT_FALSE(state.FromParticipant(kMarker, why));
  EXPECT_FALSE(state.FromExperimenter(R"({"op":"marker","text":""})", why));
  EXPECT_FALSE(state.FromExperimenter(R"({"op":"marker","text":"a\nb"})", why));
  const std::string longest(500, 'x');
  EXPECT_TRUE(state.FromExperimenter(R"({"op":"marker","text":")" + longest + "\"}", why));
  EXPECT_FALSE(state.FromExperimenter(R"({"op":"marker","text":")" + longest + "x\"}", why));
  std::string letters;
  for (int i = 0; i < 250; ++i) letters += "\u00e4";  // two bytes each
  EXPECT_EQ(state.FromExperimenter(R"({"op":"marker","text":")" + letters + "\"}", why)->text,
            letters);
  EXPECT_FALSE(state.FromExperimenter(R"({"op":"marker","text":")" + letters + "x\"}", why));
  EXPECT_THAT(why, HasSubstr("1 to 500 bytes"));
  state.EndRun();
  EXPECT_FALSE(state.FromExperimenter(kMarker, why));
  EXPECT_EQ(why, "no run is under way");
}

TEST(PageStateTest, AfterARunItsPagesAreGone) {
  PageState state(1);
  Next next = NextRun();
  next.seat = true;
  state.Wait(next, 0);
  state.OpenRun("http://127.0.0.1:7690/#token=v", "http://127.0.0.1:7690/drive#token=a");
  state.Drive();
  state.EndRun();
  EXPECT_EQ(json::parse(state.ForParticipant())["stage"], "ended");
  EXPECT_THAT(state.ForParticipant(), Not(HasSubstr("7690")));
  EXPECT_EQ(json::parse(state.ForExperimenter())["view"], "");
}

}  // namespace
}  // namespace fogline::trials
