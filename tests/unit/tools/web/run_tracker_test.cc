#include "tools/web/run_tracker.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fogline::web {
namespace {

/// Sends the messages of a runner and its world to a tracker.
class Speaker {
 public:
  Speaker(RunTracker& tracker, std::int64_t run_id, std::size_t length = 2500)
      : Speaker(tracker, run_id, "{\"title\": \"" + std::string(length, 'a') + "\"}") {}
  Speaker(RunTracker& tracker, std::int64_t run_id, std::string text)
      : tracker_(tracker), run_id_(run_id), text_(std::move(text)) {}

  /// Sends one part of the scenario. @return the number of parts
  std::size_t Part(std::size_t part, TimePoint now, std::int8_t phase = run_t::GO,
                   bool realtime = false) {
    const auto parts = runtime::SplitScenario(text_);
    run_t run = runtime::MakeRunPart(run_id_, phase, 2.0, runtime::HashOf(text_), parts, part);
    run.realtime = realtime ? 1 : 0;
    Send(run, now);
    return parts.size();
  }
  void AllParts(TimePoint now) {
    const std::size_t parts = Part(0, now);
    for (std::size_t part = 1; part < parts; ++part) Part(part, now);
  }
  void Truth(std::int64_t step, bool fog, TimePoint now) {
    truth_t truth{};
    truth.header = {.run_id = run_id_, .step = step, .utime = 100'000 * step};
    truth.fog_present = fog ? 1 : 0;
    Send(truth, now);
  }
  template <class Message>
  void Send(const Message& message, TimePoint now) {
    std::vector<std::uint8_t> bytes;
    runtime::Encode(message, bytes);
    tracker_.Hear(IndexOf<Message>(), bytes, now);
  }
  const std::string& text() const { return text_; }

 private:
  RunTracker& tracker_;
  std::int64_t run_id_;
  std::string text_;
};

constexpr TimePoint kBegin{};

TEST(RunTrackerTest, ShowsARunWhenAllPartsOfItsScenarioAreThere) {
  RunTracker tracker;
  Speaker runner(tracker, 5);
  // The parts come in any order, and some parts come twice.
  runner.Part(2, kBegin);
  runner.Part(0, kBegin);
  runner.Part(0, kBegin);
  EXPECT_FALSE(tracker.run());
  runner.Part(1, kBegin);
  ASSERT_TRUE(tracker.run());
  EXPECT_EQ(tracker.run()->run_id, 5);
  EXPECT_EQ(tracker.run()->scenario_text, runner.text());
  EXPECT_EQ(tracker.run()->pace, 2);
  EXPECT_EQ(tracker.runs(), 1);
  runner.AllParts(kBegin);
  EXPECT_EQ(tracker.runs(), 1);
}

TEST(RunTrackerTest, StaysWithARunUntilItStops) {
  RunTracker tracker;
  Speaker first(tracker, 5), second(tracker, 6);
  first.AllParts(kBegin);
  second.AllParts(kBegin);
  EXPECT_EQ(tracker.run()->run_id, 5);
  first.Part(0, kBegin, run_t::STOP);
  second.AllParts(kBegin);
  EXPECT_EQ(tracker.run()->run_id, 6);
  EXPECT_EQ(tracker.runs(), 2);
}

TEST(RunTrackerTest, ShowsOnlyTheRunThatItWasMadeFor) {
  RunTracker tracker(6);
  EXPECT_EQ(tracker.followed(), 6);
  Speaker first(tracker, 5), second(tracker, 6);
  first.AllParts(kBegin);
  EXPECT_FALSE(tracker.run());
  second.AllParts(kBegin);
  EXPECT_EQ(tracker.run()->run_id, 6);
  second.Part(0, kBegin, run_t::STOP);
  first.AllParts(kBegin + 2 * RunTracker::kSilent);
  EXPECT_EQ(tracker.run()->run_id, 6);
  EXPECT_EQ(tracker.runs(), 1);
}

TEST(RunTrackerTest, LeavesARunThatIsSilent) {
  RunTracker tracker;
  Speaker first(tracker, 5), second(tracker, 6);
  first.AllParts(kBegin);
  TimePoint now = kBegin + RunTracker::kSilent;
  first.Truth(1, false, now);  // a sign of life
  now += RunTracker::kSilent;
  second.AllParts(now);
  EXPECT_EQ(tracker.run()->run_id, 5);
  now += milliseconds(1);
  second.AllParts(now);
  EXPECT_EQ(tracker.run()->run_id, 6);
}

TEST(RunTrackerTest, LeavesARunWhoseNetworkIsHeardNoMore) {
  RunTracker tracker;
  Speaker first(tracker, 5), second(tracker, 6);
  first.AllParts(kBegin);
  tracker.LeaveNetwork();
  EXPECT_EQ(tracker.run()->run_id, 5) << "shown until the next run comes";
  second.AllParts(kBegin);
  EXPECT_EQ(tracker.run()->run_id, 6);
  first.AllParts(kBegin);
  EXPECT_EQ(tracker.run()->run_id, 6);
}

TEST(RunTrackerTest, StaysWithARunThatIsHeardOnItsNextNetwork) {
  RunTracker tracker;
  Speaker first(tracker, 5), second(tracker, 6);
  first.AllParts(kBegin);
  tracker.LeaveNetwork();
  first.Part(0, kBegin);
  second.AllParts(kBegin);
  EXPECT_EQ(tracker.run()->run_id, 5);
}

TEST(RunTrackerTest, FindsEventsOfItsRunOnly) {
  RunTracker tracker;
  Speaker own(tracker, 5), other(tracker, 6);
  own.AllParts(kBegin);
  other.Truth(3, true, kBegin);
  EXPECT_TRUE(tracker.events().empty());
  own.Truth(0, false, kBegin);
  own.Truth(3, true, kBegin);
  own.Truth(3, true, kBegin);
  own.Truth(2, false, kBegin);  // late
  ASSERT_EQ(tracker.events().size(), 1U);
  EXPECT_EQ(tracker.events()[0].kind, "fog");
  EXPECT_EQ(tracker.events()[0].step, 3);
}

TEST(RunTrackerTest, NamesAPersonInTheEventsOfARunThatAPersonDrives) {
  RunTracker tracker;
  Speaker person(tracker, 5, R"({"version": 1, "person": {"drives": true}})"), model(tracker, 6);
  const auto stop = [&](Speaker& run, std::int64_t run_id) {
    arbitration_t command{};
    command.header = {.run_id = run_id, .step = 0, .utime = 0};
    command.mode = arbitration_t::HUMAN;
    command.lambda_human = 1;
    run.Send(command, kBegin);
    command.header.step = 1;
    command.mode = arbitration_t::MINIMAL_RISK;
    command.lambda_human = 0;
    run.Send(command, kBegin);
    return tracker.events().empty() ? "" : tracker.events().back().text;
  };
  person.AllParts(kBegin);
  EXPECT_EQ(stop(person, 5), "manoeuvre begins: inputs or person gone");
  person.Part(0, kBegin, run_t::STOP);
  person.Truth(0, false, kBegin);  // it is played again
  EXPECT_EQ(stop(person, 5), "manoeuvre begins: inputs or person gone");
  person.Part(0, kBegin, run_t::STOP);
  // The scenario comes after the events. Then the tracker reports the events again, and names the
  // person in them.
  Speaker late(tracker, 7, person.text() + std::string(2500, ' '));  // several parts
  late.Part(0, kBegin);
  EXPECT_EQ(stop(late, 7), "manoeuvre begins: inputs have failed");
  late.AllParts(kBegin);
  EXPECT_EQ(tracker.TakeEvents().back().text, "manoeuvre begins: inputs or person gone");
  late.Part(0, kBegin, run_t::STOP);
  model.AllParts(kBegin);
  EXPECT_EQ(stop(model, 6), "manoeuvre begins: inputs have failed");
}

TEST(RunTrackerTest, BeginsAgainWhenARunIsPlayedAgain) {
  RunTracker tracker;
  Speaker run(tracker, 5);
  run.AllParts(kBegin);
  run.Truth(0, false, kBegin);
  run.Truth(40, true, kBegin);
  EXPECT_EQ(tracker.events().size(), 1U);
  run.Part(0, kBegin, run_t::STOP);
  run.Truth(0, false, kBegin);
  EXPECT_TRUE(tracker.events().empty());
  run.Truth(40, true, kBegin);
  EXPECT_EQ(tracker.events().size(), 1U);
  // After a pause, step 0 means that the log is played again, although it was not played to its
  // end.
  run.Truth(0, false, kBegin + 2 * RunTracker::kSilent);
  EXPECT_TRUE(tracker.events().empty());
}

// A role that was started again asks for all steps from the first one on. So the tracker receives
// old steps, although the run is not played again.
TEST(RunTrackerTest, DoesNotTakeARepairForARunThatIsPlayedAgain) {
  RunTracker tracker;
  Speaker run(tracker, 5);
  run.AllParts(kBegin);
  run.Truth(0, false, kBegin);
  run.Truth(40, true, kBegin);
  run.Truth(2000, true, kBegin);
  // The run stands still until the role has come. The other processes of the run send STATUS, so
  // the run is not silent.
  TimePoint now = kBegin;
  for (int i = 0; i < 20; ++i) {
    now += milliseconds(200);
    status_t status{};
    status.header.run_id = 5;
    run.Send(status, now);
  }
  run.Truth(0, false, now);
  run.Truth(40, true, now);
  run.Truth(2001, true, now);
  EXPECT_EQ(tracker.events().size(), 1U);
}

TEST(RunTrackerTest, TellsEachEventOnceAndAllOfARunThatIsPlayedAgain) {
  RunTracker tracker;
  Speaker run(tracker, 5);
  run.Truth(1, true, kBegin);  // of a run that is not followed
  run.AllParts(kBegin);
  run.Truth(0, false, kBegin);
  run.Truth(40, true, kBegin);
  EXPECT_EQ(tracker.TakeEvents().size(), 1U);
  EXPECT_EQ(tracker.TakeEvents().size(), 0U);
  // The run is played again, and its event is reported again.
  run.Part(0, kBegin, run_t::STOP);
  run.Truth(0, false, kBegin);
  run.Truth(30, true, kBegin);
  const std::vector<RunEvent> again = tracker.TakeEvents();
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].step, 30);
}

TEST(RunTrackerTest, TellsTheEventsAgainWhenTheScenarioIsKnown) {
  RunTracker tracker;
  Speaker run(tracker, 5);
  run.Part(0, kBegin);
  run.Truth(0, false, kBegin);
  run.Truth(3, true, kBegin);
  EXPECT_EQ(tracker.TakeEvents().size(), 1U);
  run.AllParts(kBegin);
  EXPECT_EQ(tracker.TakeEvents().size(), 1U);
}

TEST(RunTrackerTest, NamesTheStepsOfAnEventAfterMissingCommandsExceptInRealTime) {
  for (const bool realtime : {false, true}) {
    RunTracker tracker;
    Speaker runner(tracker, 5);
    runner.Part(0, kBegin, run_t::GO, realtime);
    arbitration_t command{};
    command.header.run_id = 5;
    command.threshold = 0.5;
    runner.Send(command, kBegin);
    command.header.step = 4;
    command.doc = 0.8;
    runner.Send(command, kBegin);
    ASSERT_EQ(tracker.events().size(), 1U);
    const std::string text = "DoC 0.80 reaches the threshold 0.50";
    EXPECT_EQ(tracker.events()[0].text, text + (realtime ? "" : ", in one of the steps 1 to 4"));
  }
}

TEST(RunTrackerTest, ShowsNoScenarioThatIsNoObject) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "[";
  for (const std::string& text :
       {std::string("[1]"), std::string("no JSON"), std::string("5"), "{\"a\": " + deep}) {
    RunTracker tracker;
    Speaker(tracker, 5, text).AllParts(kBegin);
    EXPECT_FALSE(tracker.run()) << text.substr(0, 10);
    EXPECT_EQ(tracker.run_text(), "");
    EXPECT_EQ(tracker.refused_scenarios(), 1);
  }
}

TEST(RunTrackerTest, SurvivesWhateverComes) {
  RunTracker tracker;
  for (std::size_t size = 0; size < 200; ++size) {
    const std::vector<std::uint8_t> bytes(size, 0xff);
    for (std::size_t channel = 0; channel <= kNumChannels; ++channel) {
      tracker.Hear(channel, bytes, kBegin);
    }
  }
  run_t huge{};
  huge.num_parts = RunTracker::kMostParts + 1;
  huge.text = "x";
  Speaker(tracker, 1).Send(huge, kBegin);
  EXPECT_FALSE(tracker.run());
}

}  // namespace
}  // namespace fogline::web
